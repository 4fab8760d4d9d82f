//! The collision type `continuous-time`: one pass, with each contact resolved immediately (collisions.md 4).
use super::{
    Mistake, detection,
    objects::State,
    response::respond,
    step_failure::StepFailure,
    world::{StepLog, World},
};

/// Detects and resolves the contacts of one pair after the other. The bodies move from `q_start` to the positions in
/// `state`, which the responses change.
pub fn handle_collisions(
    world: &World,
    q_start: &[f64],
    state: &mut State,
    log: &mut StepLog,
) -> Result<(), StepFailure> {
    let student = world.student;
    if student.makes(Mistake::ContinuousDetectAllFirst) {
        return handle_simultaneously(world, q_start, state, log);
    }
    let passes = if student.makes(Mistake::ContinuousTwoPasses) { 2 } else { 1 };
    for _ in 0..passes {
        let predicted = state.x.clone();
        for pair in world.pairs() {
            let is_old = student.makes(Mistake::ContinuousOldPrediction);
            let q_end = if is_old { &predicted } else { &state.x };
            let Some(contact) = detection::detect(world, pair, q_start, q_end, log)? else { continue };
            if student.makes(Mistake::ContinuousFirstOnly) && !log.impulses.is_empty() {
                continue;
            }
            log.impulses.push(contact);
            if student.makes(Mistake::ContinuousNoResponse) {
                continue;
            }
            let before = state.clone();
            respond(world, &contact, q_start, &before, state);
        }
    }
    Ok(())
}

fn handle_simultaneously(
    world: &World,
    q_start: &[f64],
    state: &mut State,
    log: &mut StepLog,
) -> Result<(), StepFailure> {
    let contacts = detection::detect_contacts(world, q_start, &state.x, log)?;
    let predicted = state.clone();
    for contact in contacts {
        respond(world, &contact, q_start, &predicted, state);
        log.impulses.push(contact);
    }
    Ok(())
}
