//! Where the two rule books differ about a trace: which rule of the original is the cause.
//!
//! It looks at what both have found, no closer: the first divergence of the book that rejects names the rule. What the
//! original's rules are is written in oracle-behaviour.md 4 to 6, why they can't be trusted in numerics.md 1.
use super::{
    judgement::{FairRefusal, FairVerdict, Judgement},
    pending::Form,
};
use crate::{
    finding::{Finding, FindingDetail, Role},
    outcome::Outcome,
    parity::Overall,
};
use fosssim_model::sim::PairKind;

/// The rule of the original that makes the verdicts differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// Parity fails: coefficients are compared at an absolute bound, whatever their size.
    AbsoluteCoefficients,
    /// Parity fails: small leading coefficients are dropped before degrees are compared.
    DroppedCoefficients,
    /// Parity fails: a polynomial of round-off is compared with one that vanishes.
    VanishingPolynomial,
    /// Parity fails: the course's slip in the approach polynomial.
    ApproachForm,
    /// Parity fails: states are compared at an absolute bound, whatever the size of the scene.
    AbsoluteStates,
    /// Parity fails: contact normals are compared at an absolute bound.
    AbsoluteNormals,
    /// Parity fails: round-off of all steps is added up.
    AccumulatedResiduals,
    /// Parity fails: a decision that round-off may flip.
    BorderlineDecision,
    /// Parity passes: it takes over the first record.
    FirstRecord,
    /// Parity passes: it takes over mid records.
    MidRecord,
    /// Parity passes: it does not compare times of impact.
    ContactTime,
    /// Parity passes: a collision that is logged twice counts once.
    RepeatedCollision,
    /// Parity passes: it decides with its own polynomials, not with the trace's.
    OwnPolynomials,
    /// Parity passes: it does not ask whether the course's library can have written a polynomial.
    ImpossibleLog,
    /// Parity passes: values that are not numbers pass.
    NotANumber,
    /// Parity passes: what is below an absolute bound passes, however wrong.
    SmallErrors,
    /// Parity passes: it does not look behind the last record.
    TrailingBytes,
    /// Parity passes: it reads on over damage.
    Damage,
}

impl Cause {
    /// The key in machine-readable reports.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::AbsoluteCoefficients => "absolute_coefficients",
            Self::DroppedCoefficients => "dropped_coefficients",
            Self::VanishingPolynomial => "vanishing_polynomial",
            Self::ApproachForm => "approach_form",
            Self::AbsoluteStates => "absolute_states",
            Self::AbsoluteNormals => "absolute_normals",
            Self::AccumulatedResiduals => "accumulated_residuals",
            Self::BorderlineDecision => "borderline_decision",
            Self::FirstRecord => "first_record",
            Self::MidRecord => "mid_record",
            Self::ContactTime => "contact_time",
            Self::RepeatedCollision => "repeated_collision",
            Self::OwnPolynomials => "own_polynomials",
            Self::ImpossibleLog => "impossible_log",
            Self::NotANumber => "not_a_number",
            Self::SmallErrors => "small_errors",
            Self::TrailingBytes => "trailing_bytes",
            Self::Damage => "damage",
        }
    }

    /// All causes, the original's failures first.
    pub const ALL: [Self; 18] = [
        Self::AbsoluteCoefficients,
        Self::DroppedCoefficients,
        Self::VanishingPolynomial,
        Self::ApproachForm,
        Self::AbsoluteStates,
        Self::AbsoluteNormals,
        Self::AccumulatedResiduals,
        Self::BorderlineDecision,
        Self::FirstRecord,
        Self::MidRecord,
        Self::ContactTime,
        Self::RepeatedCollision,
        Self::OwnPolynomials,
        Self::ImpossibleLog,
        Self::NotANumber,
        Self::SmallErrors,
        Self::TrailingBytes,
        Self::Damage,
    ];

    /// The cause with this key.
    #[must_use]
    pub fn from_key(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|cause| cause.key() == key)
    }

    /// Whether the original fails what the fair rules accept; else it passes what they reject.
    #[must_use]
    pub const fn original_fails(self) -> bool {
        (self as u8) <= (Self::BorderlineDecision as u8)
    }
}

/// One sentence without a full stop, about the original.
impl std::fmt::Display for Cause {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::AbsoluteCoefficients => {
                "the original compares coefficients at an absolute 1e-10, after rescaling by sums of moduli: the \
                 round-off of large ones exceeds it"
            }
            Self::DroppedCoefficients => {
                "the original compares degrees after leading coefficients below an absolute 1e-12 have been dropped: a \
                 factor or a rounding moves them across that bound"
            }
            Self::VanishingPolynomial => {
                "the original takes a polynomial below an absolute 1e-10 for zero, and its round-off elsewhere for wrong"
            }
            Self::ApproachForm => {
                "the original has the course's slip in t^3 of the approach polynomial of a particle and an edge, and \
                 the trace has the right form"
            }
            Self::AbsoluteStates => {
                "the original compares states at an absolute 1e-10: the round-off of large numbers exceeds it"
            }
            Self::AbsoluteNormals => {
                "the original compares contact normals at an absolute 1e-9: the round-off of long ones exceeds it"
            }
            Self::AccumulatedResiduals => {
                "the original adds up the round-off of all steps and particles, and its bound of 1e-6 does not grow with them"
            }
            Self::BorderlineDecision => {
                "the original knows one outcome of a decision that round-off may flip, and the trace has the other"
            }
            Self::FirstRecord => "the original takes over the first record without comparing it with the scene",
            Self::MidRecord => "the original takes over a step's mid record without comparing it",
            Self::ContactTime => "the original does not compare times of impact",
            Self::RepeatedCollision => "the original takes a collision that is logged several times for one",
            Self::OwnPolynomials => {
                "the original decides with its own polynomials, so it does not see what follows from the trace's"
            }
            Self::ImpossibleLog => "the original does not ask whether the course's library can have written the log",
            Self::NotANumber => "the original lets values pass that are not numbers",
            Self::SmallErrors => {
                "the original compares at absolute bounds: what is below them passes, however wrong for its size"
            }
            Self::TrailingBytes => "the original does not look behind the last record",
            Self::Damage => "the original reads on over damage in silence",
        })
    }
}

/// Why the two rule books differ about a trace; `None` where they agree, or one of them has no verdict.
#[must_use]
pub fn cause(outcome: &Outcome) -> Option<Cause> {
    let fair = outcome.fair.as_deref()?;
    match (outcome.parity.overall, fair.verdict) {
        (Overall::Failed, FairVerdict::Accepted) => Some(too_strict(outcome, fair)),
        (Overall::Passed, FairVerdict::Rejected) => Some(too_lax(outcome, fair)),
        _ => None,
    }
}

/// Parity fails what fair accepts.
fn too_strict(outcome: &Outcome, fair: &Judgement) -> Cause {
    let Some(first) = &outcome.parity.findings.first_divergence else { return Cause::AccumulatedResiduals };
    // Not all borderline decisions are kept as examples; one that is not may be the one.
    let is_borderline = fair.borderline > fair.borderline_examples.len() as u64
        || fair.borderline_examples.iter().any(|decision| decision.step == first.step);
    match &first.detail {
        FindingDetail::Coefficient { place, .. } if is_approach_of_edge(place.role, place.pair.kind) => {
            if fair.form == Form::Right { Cause::ApproachForm } else { Cause::AbsoluteCoefficients }
        }
        FindingDetail::PolynomialDegree { place, .. }
            if fair.form == Form::Right && is_approach_of_edge(place.role, place.pair.kind) =>
        {
            Cause::ApproachForm
        }
        FindingDetail::Coefficient { .. } => Cause::AbsoluteCoefficients,
        FindingDetail::PolynomialDegree { .. } => Cause::DroppedCoefficients,
        FindingDetail::VanishingPolynomial { .. } => Cause::VanishingPolynomial,
        FindingDetail::WrongNormal { .. } => Cause::AbsoluteNormals,
        _ if is_borderline => Cause::BorderlineDecision,
        FindingDetail::Position { .. } | FindingDetail::Velocity { .. } => Cause::AbsoluteStates,
        // A certain decision that differs all the same: it follows from the right form.
        _ if fair.form == Form::Right => Cause::ApproachForm,
        _ => Cause::BorderlineDecision,
    }
}

const fn is_approach_of_edge(role: Role, kind: PairKind) -> bool {
    matches!((role, kind), (Role::Approach, PairKind::ParticleEdge))
}

/// Parity passes what fair rejects.
fn too_lax(outcome: &Outcome, fair: &Judgement) -> Cause {
    match fair.refusal {
        Some(FairRefusal::Damaged) => return Cause::Damage,
        Some(FairRefusal::TrailingBytes) if fair.findings.counts.total() == 0 => return Cause::TrailingBytes,
        // The original came to its end: it is the trace's own polynomials that lead nowhere.
        Some(FairRefusal::Stopped) => return Cause::OwnPolynomials,
        _ => {}
    }
    let Some(first) = &fair.findings.first_divergence else { return Cause::SmallErrors };
    if first.step == 0 {
        return Cause::FirstRecord;
    }
    match &first.detail {
        FindingDetail::RecordsDiffer { .. } | FindingDetail::PassCount { .. } => Cause::MidRecord,
        FindingDetail::Position { .. } | FindingDetail::Velocity { .. } if is_mid_record(first, outcome) => {
            Cause::MidRecord
        }
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
        FindingDetail::WrongNormal { .. }
        | FindingDetail::PolynomialDegree { .. }
        | FindingDetail::VanishingPolynomial { .. }
        | FindingDetail::Coefficient { .. }
        | FindingDetail::Position { .. }
        | FindingDetail::BeyondReach { .. }
        | FindingDetail::Velocity { .. }
        | FindingDetail::PassPositions { .. }
        | FindingDetail::MixedForms { .. } => Cause::SmallErrors,
    }
}

/// Whether what was compared is in a step's mid record, of the two that it has.
fn is_mid_record(finding: &Finding, outcome: &Outcome) -> bool {
    outcome.records_per_step == 2 && finding.frame + 1 == 2 * u64::from(finding.step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{self, BOUNCE, relog};
    use fosssim_model::trace::Frame;

    fn judged(trace: &[u8]) -> Outcome {
        samples::judged(&samples::scene(BOUNCE), trace)
    }

    /// The reference trace with changed frames.
    fn changed(change: impl FnOnce(&mut Vec<Frame>)) -> Vec<u8> {
        samples::changed(&samples::scene(BOUNCE), change)
    }

    /// Multiplies every coefficient.
    fn scaled(frames: &mut [Frame], factor: f64) {
        for frame in frames {
            relog(frame, |_, coefficients| coefficients.iter().map(|c| factor * c).collect());
        }
    }

    #[test]
    fn where_the_books_agree_there_is_no_cause() {
        assert_eq!(cause(&judged(&changed(|_| {}))), None);
        assert_eq!(cause(&judged(&changed(|frames| frames[2].impulses.clear()))), None);
        assert_eq!(cause(&judged(&[])), None);
    }

    #[test]
    fn what_parity_never_looks_at_is_named() {
        let both = |change: fn(&mut Frame)| {
            changed(|frames| {
                change(&mut frames[1]);
                change(&mut frames[2]);
            })
        };
        let trailing = [&changed(|_| {})[..], b"more"].concat();
        for (trace, expected) in [
            (trailing, Cause::TrailingBytes),
            (changed(|frames| frames[0].state.positions[0] = 1.0), Cause::FirstRecord),
            (changed(|frames| frames[1].polynomials.clear()), Cause::MidRecord),
            (both(|frame| frame.impulses[0].time = 0.75), Cause::ContactTime),
            (both(|frame| frame.impulses.push(frame.impulses[0])), Cause::RepeatedCollision),
            (both(|frame| frame.impulses[0].normal.x = f64::NAN), Cause::NotANumber),
        ] {
            let outcome = judged(&trace);
            assert_eq!(cause(&outcome), Some(expected), "{:?}", outcome.fair);
        }
    }

    #[test]
    fn large_numbers_are_the_originals_fault() {
        let outcome = judged(&changed(|frames| scaled(frames, 1.0 + 1e-12)));
        assert_eq!(cause(&outcome), None, "a small factor passes both");
        // Whether the rescaling rounds the other way is up to the factor.
        let factors = [3.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0, 29.0].map(|n| 1e12 / n);
        let causes = factors.map(|factor| cause(&judged(&changed(|frames| scaled(frames, factor)))));
        assert!(causes.contains(&Some(Cause::AbsoluteCoefficients)), "{causes:?}");
        assert!(Cause::AbsoluteCoefficients.to_string().contains("1e-10"));
    }

    #[test]
    fn keys_lead_back_and_the_first_half_are_failures_of_the_original() {
        for (number, cause) in Cause::ALL.into_iter().enumerate() {
            assert_eq!(Cause::from_key(cause.key()), Some(cause));
            assert_eq!(cause.original_fails(), number < 8, "{cause:?}");
        }
    }
}
