//! `continuous-time` handling: one pass that responds to each hit immediately (collisions.md 4).
//!
//! Later pairs of the pass use the positions after earlier responses.
use super::{
    super::{
        bodies::Bodies,
        observer::{Impulse, Observer, Pass, Stage, pass_on_synchronization},
        pair::PairKind,
        state::State,
        step_error::StepError,
    },
    particle_edge, particle_half_plane, particle_particle,
    pass::{Detector, Reaction},
    response::{Response, ResponseConstants, ResponseInput},
};

/// Handles the impacts of a step, then reaches the synchronization point.
///
/// # Errors
/// Fails with [`StepError::RootSearch`] if a root search would never end.
pub(super) fn handle<O: Observer>(
    bodies: &Bodies,
    law: &ResponseConstants,
    detector: &mut Detector,
    q_start: &[f64],
    state: &mut State,
    observer: &mut O,
) -> Result<(), StepError> {
    let State { positions, velocities } = state;
    let pass = Pass { stage: Stage::ContinuousTime, index: detector.pass_count() };
    detector.run(bodies, pass, q_start, positions, observer, |observer, impulse, q_end| {
        let response = respond(&ResponseInput { bodies, law, q_start, q_end }, impulse);
        response.apply(q_end, velocities);
        observer.observe_impulse(impulse);
        Reaction::Moved
    })?;
    pass_on_synchronization(observer, state);
    Ok(())
}

/// Returns the response to an impact (collisions.md 3).
pub(super) fn respond(input: &ResponseInput<'_>, impulse: &Impulse) -> Response {
    let Impulse { pair, normal, time } = *impulse;
    let (first, second) = (pair.first as usize, pair.second as usize);
    match pair.kind {
        PairKind::ParticleParticle => particle_particle::response(input, first, second, normal),
        PairKind::ParticleEdge => particle_edge::response(input, first, input.bodies.edges[second], normal, time),
        PairKind::ParticleHalfPlane => particle_half_plane::response(input, first, normal),
    }
}
