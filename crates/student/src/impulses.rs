//! The first part of `hybrid`: rounds of detection and impulses, at most `maxiters` of them (collisions.md 5.2).
use fosssim_num::vector::{length, set_vector, vector_at};

use super::{
    Area, Mistake, detection,
    objects::{Contact, State},
    response::respond,
    step_failure::StepFailure,
    world::{StepLog, World},
};

/// The maximum change of velocity by the impulses of one round, in programs that limit it (length per time).
const MAX_IMPULSE: f64 = 0.5;

/// The number of rounds after which a step with a guard is stopped. A scene may allow billions of rounds, and some
/// mistakes repeat them without a polynomial that the guard would see.
const MAX_GUARDED_ROUNDS: i32 = 10_000;

/// Applies impulses until a pass finds no contact, or until `max_iterations` rounds are over. Returns whether a pass
/// found no contact. `state` is the prediction at the beginning, and the result at the end.
pub fn apply_rounds(
    world: &World,
    q_start: &[f64],
    max_iterations: i32,
    state: &mut State,
    log: &mut StepLog,
) -> Result<bool, StepFailure> {
    let student = world.student;
    let prediction = state.clone();
    log.prediction = Some(prediction.x.clone());
    let mut start = q_start.to_vec();
    if let Some(ending) = end_before_rounds(world, q_start, max_iterations, state, log)? {
        return Ok(ending);
    }
    let is_once = max_iterations <= 0 && student.makes(Mistake::ImpulsesOnceWhenZero);
    let mut rounds = if is_once { max_iterations.saturating_sub(1) } else { 0 };
    let limit = round_limit(world, max_iterations);
    let mut list: Vec<Contact> = Vec::new();
    while rounds < limit {
        stop_endless_rounds(rounds, log)?;
        let is_old = student.makes(Mistake::ImpulsesDetectPrediction);
        let q_end = if is_old { &prediction.x } else { &state.x };
        let is_repeated = rounds > 0 && student.makes(Mistake::ImpulsesDetectOnce);
        let found = if is_repeated {
            std::mem::take(&mut list)
        } else {
            detection::detect_contacts(world, &start, q_end, log)?
        };
        let is_as_before = rounds > 0 && found.len() == list.len();
        if !student.makes(Mistake::ImpulsesListKept) {
            list.clear();
        }
        list.extend(found);
        let contacts = &list;
        if contacts.is_empty() {
            if student.makes(Mistake::ImpulsesVelocityRestored) {
                state.v.clone_from(&prediction.v);
            }
            let mistake = student.mistake_in(&[Area::ImpulseLoop]);
            return Ok(!matches!(mistake, Some(Mistake::ImpulsesAlwaysFail | Mistake::ImpulsesInverted)));
        }
        if is_as_before && student.makes(Mistake::ImpulsesSameCountFails) {
            return Ok(false);
        }
        if rounds + 1 == limit && student.makes(Mistake::ImpulsesLastNotApplied) {
            return Ok(false);
        }
        let follows = student.makes(Mistake::ImpulsesStartFollows);
        let detected_to = follows.then(|| state.x.clone());
        apply_impulses(world, if follows { q_start } else { &start }, contacts, &prediction, state, log);
        if student.makes(Mistake::ImpulsesStartAdvances) {
            start.clone_from(&state.x);
        }
        if let Some(end) = detected_to {
            start = end;
        }
        if student.makes(Mistake::ImpulsesSucceedAfterOne) {
            return Ok(true);
        }
        rounds += if student.makes(Mistake::ImpulsesCountContacts) {
            i32::try_from(contacts.len()).unwrap_or(i32::MAX)
        } else {
            1 + i32::from(student.makes(Mistake::ImpulsesCountTwice))
        };
    }
    if student.makes(Mistake::ImpulsesOneLeftSucceeds) && list.len() == 1 {
        return Ok(true);
    }
    // All rounds found contacts, so a correct program changes nothing more.
    match student.mistake_in(&[Area::ImpulseLoop]) {
        Some(Mistake::ImpulsesDetectAfterLast) => {
            return Ok(detection::detect_contacts(world, q_start, &state.x, log)?.is_empty());
        }
        Some(Mistake::ImpulsesReset) => state.clone_from(&prediction),
        Some(Mistake::ImpulsesVelocityRestored) => state.v.clone_from(&prediction.v),
        Some(Mistake::ImpulsesAlwaysSucceed | Mistake::ImpulsesInverted) => return Ok(true),
        _ => {}
    }
    Ok(false)
}

/// Fails if a step with a guard has had too many rounds.
fn stop_endless_rounds(rounds: i32, log: &StepLog) -> Result<(), StepFailure> {
    let is_over = log.guard.is_some() && rounds > MAX_GUARDED_ROUNDS;
    if is_over { Err(StepFailure::Stopped) } else { Ok(()) }
}

/// Returns the result of a program that ends before its first round, or `None` if it continues.
fn end_before_rounds(
    world: &World,
    q_start: &[f64],
    max_iterations: i32,
    state: &State,
    log: &mut StepLog,
) -> Result<Option<bool>, StepFailure> {
    let ending = match world.student.mistake_in(&[Area::ImpulseLoop]) {
        Some(Mistake::ImpulsesEmpty) => Some(false),
        Some(Mistake::ImpulsesEmptySuccess) => Some(true),
        Some(Mistake::ImpulsesTestBefore) => {
            detection::detect_contacts(world, q_start, &state.x, log)?.is_empty().then_some(true)
        }
        Some(Mistake::ImpulsesDetectBefore) => {
            detection::detect_contacts(world, q_start, &state.x, log)?;
            None
        }
        Some(Mistake::ImpulsesPassWhenZero) if max_iterations <= 0 => {
            detection::detect_contacts(world, q_start, &state.x, log)?;
            Some(false)
        }
        Some(Mistake::ImpulsesTestWhenZero) if max_iterations <= 0 => {
            Some(detection::detect_contacts(world, q_start, &state.x, log)?.is_empty())
        }
        Some(Mistake::ImpulsesSuccessWhenZero) if max_iterations <= 0 => Some(true),
        _ => None,
    };
    Ok(ending)
}

/// Returns the number of rounds that this program allows.
fn round_limit(world: &World, max_iterations: i32) -> i32 {
    match world.student.mistake_in(&[Area::ImpulseLoop]) {
        Some(Mistake::ImpulsesOneFewer) => max_iterations.saturating_sub(1),
        Some(Mistake::ImpulsesOneMore) => max_iterations.saturating_add(1),
        Some(Mistake::ImpulsesOnlyOne) => max_iterations.min(1),
        Some(Mistake::ImpulsesAlwaysTen) => 10,
        Some(Mistake::ImpulsesDouble) => max_iterations.saturating_mul(2),
        _ => max_iterations,
    }
}

/// Applies one round's impulses, all computed from the positions at its beginning.
fn apply_impulses(
    world: &World,
    start: &[f64],
    contacts: &[Contact],
    prediction: &State,
    state: &mut State,
    log: &mut StepLog,
) {
    let student = world.student;
    let anew = student.makes(Mistake::ImpulsesAnew);
    let uses_prediction = anew || student.makes(Mistake::ImpulsesFromPrediction);
    let before = if uses_prediction { prediction.clone() } else { state.clone() };
    let chosen = match student.mistake_in(&[Area::ImpulseLoop]) {
        Some(Mistake::ImpulsesFirstOnly) => &contacts[..1],
        Some(Mistake::ImpulsesLastOnly) => &contacts[contacts.len() - 1..],
        Some(Mistake::ImpulsesFirstSkipped) => &contacts[1..],
        Some(Mistake::ImpulsesLastSkipped) => &contacts[..contacts.len() - 1],
        _ => contacts,
    };
    if anew || student.makes(Mistake::ImpulsesResultNotAccumulated) {
        state.clone_from(prediction);
    }
    if student.makes(Mistake::ImpulsesPredictedVelocities) {
        state.v.clone_from(&prediction.v);
    }
    let start = if student.makes(Mistake::ImpulsesFromEnd) { &before.x } else { start };
    for contact in chosen {
        if student.makes(Mistake::ImpulsesOneByOne) {
            let current = state.clone();
            respond(world, contact, start, &current, state);
        } else if student.makes(Mistake::ImpulsesLastWins) {
            let mut changed = before.clone();
            respond(world, contact, start, &before, &mut changed);
            *state = changed;
        } else {
            respond(world, contact, start, &before, state);
        }
    }
    match student.mistake_in(&[Area::ImpulseLoop, Area::Trace]) {
        Some(Mistake::ImpulsesCapped) => limit_velocity_changes(world, &before, state),
        Some(Mistake::ImpulsesPositionsRestored) => state.x.clone_from(&prediction.x),
        Some(Mistake::ImpulsesPositionsFromVelocities) => {
            for particle in 0..world.scene.particles.len() {
                set_vector(
                    &mut state.x,
                    particle,
                    vector_at(start, particle) + world.scene.time_step * vector_at(&state.v, particle),
                );
            }
        }
        Some(Mistake::LogHybridImpulses) => log.impulses.extend_from_slice(contacts),
        _ => {}
    }
}

/// Limits every change of velocity to a maximum size, and the change of position in the same way.
fn limit_velocity_changes(world: &World, before: &State, state: &mut State) {
    for particle in 0..world.scene.particles.len() {
        let change = vector_at(&state.v, particle) - vector_at(&before.v, particle);
        if length(change) > MAX_IMPULSE {
            let share = MAX_IMPULSE / length(change);
            set_vector(&mut state.v, particle, vector_at(&before.v, particle) + share * change);
            let displacement = vector_at(&state.x, particle) - vector_at(&before.x, particle);
            set_vector(&mut state.x, particle, vector_at(&before.x, particle) + share * displacement);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Student;

    #[test]
    fn rounds_that_compute_no_polynomial_end_with_a_guard() {
        let text = br#"<scene><duration time="0.1"/><integrator type="symplectic-euler" dt="0.1"/>
            <collision type="hybrid" COR="1" maxiters="2147483647" k="0" thickness="0"/>
            <particle m="1" px="0" py="0" vx="1" vy="0" fixed="0" radius="0.5"/>
            <particle m="1" px="1.05" py="0" vx="-1" vy="0" fixed="0" radius="0.5"/></scene>"#;
        let scene = fosssim_model::scene::read("two balls", text).expect("a scene").scene;
        let world = World::new(scene, Student::new(Some(Mistake::ImpulsesDetectOnce)));
        let guard = |_: usize, _: &[f64]| true;
        let mut log = StepLog { guard: Some(&guard), ..StepLog::default() };
        let result = super::super::step(&world, &mut world.initial_state(), &mut log, &mut |_, _| ());
        assert!(matches!(result, Err(StepFailure::Stopped)), "{result:?}");
    }
}
