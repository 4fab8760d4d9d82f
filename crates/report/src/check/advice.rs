//! Advice about where to look in the program. If there is no likely mistake, the advice depends on the kind of the
//! first finding.
use super::{Check, first_finding};
use crate::words::explanation;
use fosssim_judge::{Finding, FindingDetail};
use fosssim_model::assignments::CollisionType;

/// Returns advice about where to look, if there is a first finding. If an explanation names a wrong stage of a step,
/// the advice is where that stage probably is. If it names a known mistake or the fault of a polynomial, no advice is
/// needed, and the list is empty. Otherwise, the advice depends on the kind of the finding.
pub(crate) fn list_advice(check: &Check<'_>) -> Vec<&'static str> {
    let Some(first) = first_finding::find_first(check) else { return Vec::new() };
    match check.explanations.iter().find(|explanation| explanation::is_specific(explanation)) {
        Some(known) if known.names_stage() => explanation::describe_search_area(known).into_iter().collect(),
        Some(_) => Vec::new(),
        None => finding_advice(first, check.outcome.collisions).to_vec(),
    }
}

/// Returns the advice for a finding in a scene without collision handling, or with simple or penalty handling. Returns
/// `None` if there is no advice particular to such scenes.
fn milestone_advice(finding: &Finding, collisions: CollisionType) -> Option<&'static [&'static str]> {
    Some(match (finding.detail, collisions) {
        (FindingDetail::MissedCollision { .. }, CollisionType::Simple) => &[
            "the detection of this pair: at the end of the step the two overlap and approach each other",
            "is the distance compared with the right radii, and are the velocities those at the nearest points?",
        ],
        (FindingDetail::SuperfluousCollision { .. }, CollisionType::Simple) => &[
            "the detection of this pair: at the end of the step the two do not overlap, or do not approach each other",
            "does the test reject pairs that only touch, and pairs whose distance does not shrink?",
        ],
        (FindingDetail::WrongNormal { .. }, CollisionType::Simple) => &[
            "the contact normal: from the first object to the nearest point of the second, at the end of the step, not \
             normalized",
        ],
        (FindingDetail::Position { .. } | FindingDetail::Velocity { .. }, CollisionType::None) if finding.step > 0 => {
            &["the integrator or the forces: the step starts from the trace's own state, so errors of earlier steps \
                are not the cause"]
        }
        (FindingDetail::Position { .. } | FindingDetail::Velocity { .. }, CollisionType::Penalty)
            if finding.step > 0 =>
        {
            &["the integrator or the forces, the penalty force among them: the step starts from the trace's own \
               state, so errors of earlier steps are not the cause"]
        }
        _ => return None,
    })
}

/// Returns the advice for the kind of the first finding, because later findings often follow from it.
fn finding_advice(finding: &Finding, collisions: CollisionType) -> &'static [&'static str] {
    if let Some(advice) = milestone_advice(finding, collisions) {
        return advice;
    }
    match finding.detail {
        _ if finding.step == 0 => &["the first record: the scene's own positions and velocities, before any step"],
        FindingDetail::MissedCollision { .. } => &[
            "the detection of this pair: the trace's own state at the start of the step leads to this impact",
            "if its polynomials agree, the choice of the time of impact or the test of the normal is wrong",
        ],
        FindingDetail::SuperfluousCollision { .. } => &[
            "the detection of this pair: from the trace's own state at the start of the step it does not collide",
            "are the objects approaching, and is the time of impact inside the step?",
        ],
        FindingDetail::WrongNormal { .. } => &[
            "the contact normal: from the first object to the second, at the time of impact, not normalized",
            "it must be computed from the positions at that time, not from those at the end of the step",
        ],
        FindingDetail::PolynomialCount { actual: 0, .. } => &[
            "the detection: in this step it never calls the course's root finder; is it written yet?",
            "it must test every pair in every pass, even pairs that are far apart",
        ],
        FindingDetail::PolynomialCount { expected, actual, .. } | FindingDetail::PassCount { expected, actual, .. }
            if actual > expected =>
        {
            &[
                "the loop over detection passes: it runs too often, or tests pairs that the reference leaves out",
                "a wrong earlier response of this step can also make the loop too long",
            ]
        }
        FindingDetail::PolynomialCount { .. } | FindingDetail::PassCount { .. } => &[
            "the loop over detection passes: it ends too early, or leaves out pairs",
            "a wrong earlier response of this step can also end the loop",
        ],
        FindingDetail::PolynomialDegree { .. } => &[
            "the leading coefficients of this polynomial: those below 1e-12 in size are dropped, others are kept",
            "a factor on all coefficients moves them across that bound",
        ],
        FindingDetail::VanishingPolynomial { .. } => {
            &["the inputs of this polynomial: in the reference, the two objects do not move relative to each other"]
        }
        FindingDetail::Coefficient { .. } => &[
            "the formula of this coefficient; any positive factor of the whole polynomial is right",
            "in a later detection pass of the step, a wrong response before it changes the coefficients, too",
        ],
        FindingDetail::Position { .. } | FindingDetail::Velocity { .. } => {
            &["the integrator, the forces, or the response: the step starts from the trace's own state, so errors of \
                earlier steps are not the cause"]
        }
        FindingDetail::ContactTime { .. } => &[
            "the time of impact that is stored with the contact: the fraction of the step at which the objects touch",
            "is it the time that the root finder returned, and not the step's number or the simulation's time?",
        ],
        FindingDetail::RepeatedCollision { .. } => {
            &["each pair is tested once in a step: is it added to the list twice?"]
        }
        FindingDetail::PassPositions { .. } => &[
            "the response (or the rigid failsafe) before this detection pass: how it changes the end positions",
            "the positions that the pass uses: they must be those after the responses of the preceding round",
        ],
        FindingDetail::RecordsDiffer { .. } => {
            &["the output after the step: the course's code writes both records itself"]
        }
        FindingDetail::ImpossibleLog => &["the trace was not written by the course's unchanged library"],
        FindingDetail::BeyondReach { .. } => {
            &["the step that leads to this state: something divides by zero, or grows from step to step"]
        }
        FindingDetail::TrimmedDecision { .. } | FindingDetail::TrimmedTime { .. } => &[
            "the factor of your polynomials: the course's library drops leading coefficients below 1e-12",
            "polynomials in the units of the assignment's formulas are not affected",
        ],
        FindingDetail::PairForce { is_doubled, .. } => pair_advice(is_doubled),
        FindingDetail::NoResult { .. } => &[
            "the steps before this one: numbers that are not finite or absurdly large, or that grow from step to step",
        ],
        FindingDetail::MixedForms { .. } => {
            &["the approach polynomial: it switches between its two accepted forms within this trace; use one of them"]
        }
    }
}

/// Returns the advice for a pair whose force was left out or applied twice.
const fn pair_advice(is_doubled: bool) -> &'static [&'static str] {
    match is_doubled {
        false => &[
            "the search for nearby pairs: it leaves this pair out",
            "its bounds must include the radii and the thickness, and each body must be in every cell that it reaches",
        ],
        true => &["the search for nearby pairs: it finds this pair twice, and the force is applied each time"],
    }
}
