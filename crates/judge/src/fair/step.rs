//! Judges one step by the fair rules. The step is followed, and its sensitivity is measured if something differs. For
//! borderline decisions that the trace does not show, both alternatives are tried.
use super::{
    contact::{self, Tolerances},
    context::{Context, Records},
    follower::Follower,
    probe::{Sensitivity, probe},
    step_judgment::StepJudgment,
};
use crate::finding::{Finding, FindingDetail, RecordPart};
use fosssim_model::{
    scene::Collision,
    sim::{Simulation, State, StepError},
    trace::LenientFrame,
};
use fosssim_num::{polynomial::MAX_COEFFICIENTS, vector::has_same_bits};

/// The maximum number of borderline decisions of a hybrid step whose alternatives are tried, in all combinations.
const MAX_FLIPS: usize = 4;

/// Judges a step. `identical` states that the states, impulses and polynomials of both records are identical to the
/// reference's; then only the rest of the records is checked. If the step has no result although the reference's own
/// step has one, the cause is an endless root search for logged polynomials.
pub(crate) fn judge_records(
    context: &Context<'_>,
    simulation: &mut Simulation,
    records: Records<'_>,
    identical: bool,
) -> StepJudgment {
    let mut step_judgment = if identical {
        StepJudgment::from_identical_records(context, records.step, records.end.polynomials.len())
    } else {
        follow(context, simulation, records)
            .unwrap_or_else(|error| StepJudgment::default().with_finding(records, FindingDetail::NoResult { error }))
    };
    compare_records(context, records, &mut step_judgment);
    step_judgment
}

/// Compares the first record with the scene.
pub(crate) fn judge_initial_record(context: &Context<'_>, frame: &LenientFrame) -> StepJudgment {
    let mut judged = StepJudgment::default();
    let state = State::for_scene(context.scene);
    contact::compare_states(&mut judged, 0, &state, &frame.state, &Tolerances::from_context(context, &state, None));
    if !frame.impulses.is_empty() || !frame.polynomials.is_empty() {
        let part = if frame.impulses.is_empty() { RecordPart::Polynomials } else { RecordPart::Impulses };
        judged.add_finding(Finding { step: 0, frame: 0, detail: FindingDetail::RecordsDiffer { part } });
    }
    judged
}

fn follow(context: &Context<'_>, simulation: &mut Simulation, records: Records<'_>) -> Result<StepJudgment, StepError> {
    let run = |simulation: &mut Simulation, mut follower: Follower<'_>| {
        simulation.state_mut().clone_from(records.before);
        simulation.set_steps_done(records.step - 1);
        simulation.step(&mut follower)?;
        follower.finish(simulation.state());
        Ok::<_, StepError>((follower.judgment, follower.decisions, follower.borderline_calls, follower.has_disputes))
    };
    let attempt = |simulation: &mut Simulation, sensitivity: Option<&Sensitivity>, flips: &[usize]| {
        run(simulation, Follower::new(context, records, sensitivity, flips))
    };
    let follower = Follower::new(context, records, None, &[]).prefer_own();
    let (mut first, mut decisions, _, has_disputes) = run(simulation, follower)?;
    if has_disputes && first.total() > 0 {
        // The submission might also make the decisions that the root finder makes for right polynomials.
        (first, decisions, ..) = attempt(simulation, None, &[])?;
    }
    if !first.may_be_round_off() {
        return Ok(first);
    }
    let sensitivity = probe(context, simulation, &records, &decisions);
    let (second, _, borderline, _) = attempt(simulation, Some(&sensitivity), &[])?;
    if second.total() == 0 || !second.may_follow_decisions() {
        return Ok(second);
    }
    let borderline = &borderline[..borderline.len().min(MAX_FLIPS)];
    for set in 1_usize..1 << borderline.len() {
        let flips: Vec<usize> =
            borderline.iter().enumerate().filter(|(bit, _)| set >> bit & 1 == 1).map(|(_, call)| *call).collect();
        if let Ok((other, ..)) = attempt(simulation, Some(&sensitivity), &flips)
            && other.total() == 0
        {
            return Ok(other);
        }
    }
    Ok(second)
}

/// Adds findings for differences between the two records of a step that must agree (trace-format.md 2), and for logs
/// that the course's library cannot have written.
fn compare_records(context: &Context<'_>, records: Records<'_>, step_judgment: &mut StepJudgment) {
    let Records { step, frame, mid, end, .. } = records;
    let mut charge = |detail| step_judgment.add_finding(Finding { step, frame, detail });
    if is_impossible(end) || mid.is_some_and(is_impossible) {
        charge(FindingDetail::ImpossibleLog);
    }
    let Some(mid) = mid else { return };
    if mid.impulses.len() != end.impulses.len() || !mid.impulses.iter().zip(&end.impulses).all(|(a, b)| a.is_same(b)) {
        charge(FindingDetail::RecordsDiffer { part: RecordPart::Impulses });
    }
    let count = mid.polynomials.len();
    let is_hybrid = matches!(context.scene.collision, Collision::Hybrid { .. });
    let is_complete = if is_hybrid { count <= end.polynomials.len() } else { count == end.polynomials.len() };
    let is_same =
        is_complete && (0..count).all(|index| has_same_bits(mid.polynomials.get(index), end.polynomials.get(index)));
    if !is_same {
        charge(FindingDetail::RecordsDiffer { part: RecordPart::Polynomials });
    }
}

/// Returns whether the record contains a log that the course's library cannot write: small leading coefficients, or
/// more coefficients than any detection has.
fn is_impossible(frame: &LenientFrame) -> bool {
    let log = &frame.polynomials;
    frame.note.is_none() && !frame.is_unchanged || (0..log.len()).any(|index| log.get(index).len() > MAX_COEFFICIENTS)
}
