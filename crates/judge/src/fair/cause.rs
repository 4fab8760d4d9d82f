//! Finds the rule of the original that makes the two rule books differ about a trace.
//!
//! The first finding of the rule book that rejects the trace names the rule. The original's rules are described in
//! oracle-behavior.md 4 to 6; numerics.md 1 shows why they cannot be trusted.
use fosssim_findings::{
    Cause, Finding, FindingDetail, Outcome, Overall, Role,
    fair::{FairRejection, FairVerdict, Form, Judgment},
};
use fosssim_model::{assignments::CollisionType, sim::PairKind};

/// Returns the reason why the two rule books differ about a trace, or `None` if they agree or one of them has no
/// verdict.
pub fn find_cause(outcome: &Outcome) -> Option<Cause> {
    let fair = outcome.fair.as_deref()?;
    match (outcome.parity.overall, fair.verdict) {
        (Overall::Failed, FairVerdict::Accepted) => Some(explain_parity_rejection(outcome, fair)),
        (Overall::Passed, FairVerdict::Rejected) => Some(explain_parity_acceptance(outcome, fair)),
        _ => None,
    }
}

/// Returns the reason why parity rejects a trace that fair accepts.
fn explain_parity_rejection(outcome: &Outcome, judgment: &Judgment) -> Cause {
    let Some(first) = &outcome.parity.findings.first_divergence else { return Cause::AccumulatedResiduals };
    // Only some borderline decisions are kept as examples, so this one may be missing.
    let is_borderline = judgment.borderline > judgment.borderline_examples.len() as u64
        || judgment.borderline_examples.iter().any(|decision| decision.step == first.step);
    match &first.detail {
        FindingDetail::Coefficient { place, .. } if is_approach_of_edge(place.role, place.pair.kind) => {
            if judgment.form == Form::Right { Cause::ApproachForm } else { Cause::AbsoluteCoefficients }
        }
        FindingDetail::PolynomialDegree { place, .. }
            if judgment.form == Form::Right && is_approach_of_edge(place.role, place.pair.kind) =>
        {
            Cause::ApproachForm
        }
        FindingDetail::Coefficient { .. } => Cause::AbsoluteCoefficients,
        FindingDetail::PolynomialDegree { .. } => Cause::DroppedCoefficients,
        FindingDetail::VanishingPolynomial { .. } => Cause::VanishingPolynomial,
        FindingDetail::WrongNormal { .. } => Cause::AbsoluteNormals,
        _ if is_borderline => Cause::BorderlineDecision,
        FindingDetail::Position { .. } | FindingDetail::Velocity { .. } => Cause::AbsoluteStates,
        // If round-off cannot change the decision, the cause is the right form of the approach polynomial.
        _ if judgment.form == Form::Right => Cause::ApproachForm,
        _ => Cause::BorderlineDecision,
    }
}

const fn is_approach_of_edge(role: Role, kind: PairKind) -> bool {
    matches!((role, kind), (Role::Approach, PairKind::ParticleEdge))
}

/// Returns the reason why parity accepts a trace that fair rejects.
fn explain_parity_acceptance(outcome: &Outcome, judgment: &Judgment) -> Cause {
    match judgment.rejection {
        Some(FairRejection::Damaged) => return Cause::Damage,
        Some(FairRejection::TrailingBytes) if judgment.findings.counts.total() == 0 => return Cause::TrailingBytes,
        _ => {}
    }
    let Some(first) = &judgment.findings.first_divergence else { return Cause::SmallErrors };
    if first.step == 0 {
        return Cause::FirstRecord;
    }
    match &first.detail {
        FindingDetail::RecordsDiffer { .. } | FindingDetail::PassCount { .. } => Cause::MidRecord,
        FindingDetail::Position { .. } | FindingDetail::Velocity { .. } if is_mid_record(first, outcome) => {
            Cause::MidRecord
        }
        // The original judged all steps, so only the root search of the trace's own polynomials has no result.
        FindingDetail::NoResult { .. } => Cause::OwnPolynomials,
        FindingDetail::ContactTime { .. } => Cause::ContactTime,
        FindingDetail::RepeatedCollision { .. } => Cause::RepeatedCollision,
        FindingDetail::ImpossibleLog => Cause::ImpossibleLog,
        FindingDetail::WrongNormal { residual, .. } if residual.is_nan() => Cause::NotANumber,
        FindingDetail::Coefficient { actual_polynomial, .. }
        | FindingDetail::PolynomialDegree { actual: actual_polynomial, .. }
            if actual_polynomial.coefficients().iter().any(|c| !c.is_finite()) =>
        {
            Cause::NotANumber
        }
        FindingDetail::MissedCollision { .. }
        | FindingDetail::SuperfluousCollision { .. }
        | FindingDetail::TrimmedDecision { .. }
        | FindingDetail::TrimmedTime { .. }
        | FindingDetail::PolynomialCount { .. } => Cause::OwnPolynomials,
        _ => Cause::SmallErrors,
    }
}

/// Returns whether the compared value is in the mid record of a step.
fn is_mid_record(finding: &Finding, outcome: &Outcome) -> bool {
    let has_mid_records = matches!(outcome.collisions, CollisionType::ContinuousTime | CollisionType::Hybrid);
    has_mid_records && finding.frame + 1 == 2 * u64::from(finding.step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{self, BOUNCE_SCENE, replace_polynomials};
    use fosssim_model::trace::Frame;

    fn judge_by_both(trace: &[u8]) -> Outcome {
        samples::judge_by_both(&samples::scene(BOUNCE_SCENE), trace)
    }

    /// Returns the reference trace with changed frames.
    fn changed_trace(change: impl FnOnce(&mut Vec<Frame>)) -> Vec<u8> {
        samples::changed_reference_trace(&samples::scene(BOUNCE_SCENE), change)
    }

    /// Multiplies every coefficient by `factor`.
    fn scaled(frames: &mut [Frame], factor: f64) {
        for frame in frames {
            replace_polynomials(frame, |_, coefficients| coefficients.iter().map(|c| factor * c).collect());
        }
    }

    #[test]
    fn there_is_no_cause_if_the_books_agree() {
        assert_eq!(find_cause(&judge_by_both(&changed_trace(|_| {}))), None);
        assert_eq!(find_cause(&judge_by_both(&changed_trace(|frames| frames[2].impulses.clear()))), None);
        assert_eq!(find_cause(&judge_by_both(&[])), None);
    }

    #[test]
    fn values_that_parity_ignores_are_named() {
        let both = |change: fn(&mut Frame)| {
            changed_trace(|frames| {
                change(&mut frames[1]);
                change(&mut frames[2]);
            })
        };
        let trailing = [&changed_trace(|_| {})[..], b"more"].concat();
        for (trace, expected) in [
            (trailing, Cause::TrailingBytes),
            (changed_trace(|frames| frames[0].state.positions[0] = 1.0), Cause::FirstRecord),
            (changed_trace(|frames| frames[1].polynomials.clear()), Cause::MidRecord),
            (both(|frame| frame.impulses[0].time = 0.75), Cause::ContactTime),
            (both(|frame| frame.impulses.push(frame.impulses[0])), Cause::RepeatedCollision),
            (both(|frame| frame.impulses[0].normal.x = f64::NAN), Cause::NotANumber),
        ] {
            let outcome = judge_by_both(&trace);
            assert_eq!(find_cause(&outcome), Some(expected), "{:?}", outcome.fair);
        }
    }

    #[test]
    fn large_numbers_are_the_originals_fault() {
        let outcome = judge_by_both(&changed_trace(|frames| scaled(frames, 1.0 + 1e-12)));
        assert_eq!(find_cause(&outcome), None, "a small factor passes both");
        // It depends on the factor whether the original's rescaling rounds differently.
        let factors = [3.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0, 29.0].map(|n| 1e12 / n);
        let causes = factors.map(|factor| find_cause(&judge_by_both(&changed_trace(|frames| scaled(frames, factor)))));
        assert!(causes.contains(&Some(Cause::AbsoluteCoefficients)), "{causes:?}");
        assert!(Cause::AbsoluteCoefficients.to_string().contains("1e-10"));
    }
}
