//! Simulates one step and writes its records.
use super::{
    Area, Mistake, continuous_time, hybrid, integrators,
    objects::State,
    simple,
    step_failure::StepFailure,
    world::{StepLog, World},
};
use fosssim_model::scene::Collision;

/// The areas of the assignment whose mistakes this module simulates.
const MODULE_AREAS: &[Area] = &[Area::Trace];

/// Advances `state` by one step (simulation.md 1). `log` is the log of the previous step; it is emptied first, unless
/// the student forgets that. `write` is called for each record that the program writes: the mid record if there is one,
/// and the end record (trace-format.md 2).
///
/// # Errors
/// Fails if the course's program would never end or cannot integrate a force, or if the guard of the log stops the
/// step. `state` and `log` are then unspecified, and the end record is not written.
pub fn step(
    world: &World,
    state: &mut State,
    log: &mut StepLog,
    write: &mut dyn FnMut(&State, &StepLog),
) -> Result<(), StepFailure> {
    let student = world.student;
    let q_start = state.x.clone();
    let mut solves = 0;
    let advanced = integrators::advance(world, state, &mut solves);
    log.long_searches += u64::from(solves) * solve_work(world);
    advanced?;
    if !student.makes(Mistake::LogImpulsesKept) {
        log.impulses.clear();
    }
    if !student.makes(Mistake::LogPolynomialsKept) {
        log.polynomials.clear();
    }
    match world.scene.collision {
        Collision::None | Collision::Penalty { .. } => {}
        Collision::Simple { .. } => simple::handle_collisions(world, state, log),
        Collision::ContinuousTime { .. } => {
            continuous_time::handle_collisions(world, &q_start, state, log)?;
            if !student.makes(Mistake::LogNoMid) {
                write(state, log);
            }
        }
        Collision::Hybrid { max_iterations, .. } => {
            hybrid::handle_collisions(world, &q_start, max_iterations, state, log, &mut |state, log| {
                if !matches!(student.mistake_in(MODULE_AREAS), Some(Mistake::LogNoMid | Mistake::LogMidIsEnd)) {
                    write(state, log);
                }
            })?;
            if student.makes(Mistake::LogMidIsEnd) {
                write(state, log);
            }
        }
    }
    write(state, log);
    Ok(())
}

/// Returns the work of solving the linear system of an implicit integrator once. The unit is the work for one
/// polynomial, which is a few thousand operations.
fn solve_work(world: &World) -> u64 {
    10 + (2 * world.scene.particles.len() as u64).pow(3) / 1500
}
