//! The integrator linearized-implicit-euler (simulation.md 4), with one linear solve per step.
use super::{ImplicitScratch, add_scaled, system::System};
use crate::sim::state::State;

/// Solves `A d = -h g` at `(x + h v, v)`, then `v += d`, `x += h v`. `minus_one` is an opaque -1.
pub(super) fn advance(
    system: &mut System<'_>,
    minus_one: f64,
    rhs: &mut [f64],
    scratch: &mut ImplicitScratch,
    state: &mut State,
) {
    let (bodies, h) = (system.bodies, system.h);
    let ImplicitScratch { x, v, .. } = scratch;
    for (k, x) in x.iter_mut().enumerate() {
        *x = state.positions[k] + h * state.velocities[k];
    }
    for (v, velocity) in v.iter_mut().zip(&state.velocities) {
        // Adding zero turns -0 into +0, as in the original.
        *v = velocity + 0.0;
    }
    system.forces.fill_gradient(bodies, x, v, rhs);
    for entry in rhs.iter_mut() {
        *entry *= minus_one;
        *entry *= h;
    }
    bodies.zero_fixed(rhs);
    system.solve(scratch, rhs);
    for (velocity, d) in state.velocities.iter_mut().zip(rhs.iter()) {
        *velocity += d;
    }
    add_scaled(&mut state.positions, h, &state.velocities);
}
