//! The integrator implicit-euler, by Newton's method (simulation.md 4).
//!
//! The original iterates without limit and hangs if Newton's method does not converge; this step returns
//! [`StepError::Newton`] instead.
use super::{ImplicitScratch, NewtonWork, system::System};
use crate::sim::{state::State, step_error::StepError};
use fosssim_num::{
    tolerances::{MAX_NEWTON_ITERATIONS, NEWTON_UPDATE_NORM},
    vector::has_same_bits,
};

/// Iterates until the update of the velocities is small (or NaN), then advances the state by `dx`, `dv`.
///
/// An iteration depends only on `dv`, so a `dv` that recurs exactly proves an endless cycle. One `dv` is stored at each
/// power of two of the count (Brent's method).
pub(super) fn advance(
    step: u32,
    system: &mut System<'_>,
    rhs: &mut [f64],
    scratch: &mut ImplicitScratch,
    effort: &mut NewtonWork,
    state: &mut State,
) -> Result<(), StepError> {
    let (bodies, h) = (system.bodies, system.h);
    let entry_count = rhs.len();
    for (dx, velocity) in scratch.dx.iter_mut().zip(&state.velocities) {
        *dx = h * velocity;
    }
    scratch.dv.fill(0.0);
    // The value is opaque to the compiler, which could otherwise turn the product into a sign flip of the product with
    // `h` (see `Stepper::new`).
    let minus_h = std::hint::black_box(-h);
    let mut update = f64::INFINITY;
    let mut iteration = 0_u32;
    while update >= NEWTON_UPDATE_NORM {
        if iteration == MAX_NEWTON_ITERATIONS {
            return Err(StepError::Newton { step });
        }
        if !effort.iterate() {
            return Err(StepError::Work { step });
        }
        let ImplicitScratch { x, v, dx, dv, previous_update: earlier, .. } = &mut *scratch;
        if iteration.is_power_of_two() {
            earlier.copy_from_slice(dv);
        } else if iteration > 1 && has_same_bits(earlier, dv) {
            return Err(StepError::Newton { step });
        }
        iteration += 1;
        for k in 0..entry_count {
            x[k] = state.positions[k] + dx[k];
            v[k] = state.velocities[k] + dv[k];
        }
        system.forces.fill_gradient(bodies, x, v, rhs);
        for k in 0..entry_count {
            rhs[k] *= minus_h;
            rhs[k] += -(bodies.masses[k / 2] * dv[k]);
        }
        bodies.zero_fixed(rhs);
        system.solve(scratch, rhs);
        let ImplicitScratch { dx, dv, .. } = &mut *scratch;
        for k in 0..entry_count {
            dv[k] += rhs[k];
            dx[k] = h * (state.velocities[k] + dv[k]);
        }
        update = norm_by_halves(rhs);
    }
    for k in 0..entry_count {
        state.positions[k] += scratch.dx[k];
        state.velocities[k] += scratch.dv[k];
    }
    Ok(())
}

/// Returns the Euclidean norm, with the squares of even and odd entries summed separately.
fn norm_by_halves(d: &[f64]) -> f64 {
    let mut pairs = d.chunks_exact(2);
    let Some(first) = pairs.next() else { return 0.0 };
    let (mut even, mut odd) = (first[0] * first[0], first[1] * first[1]);
    for pair in pairs {
        even += pair[0] * pair[0];
        odd += pair[1] * pair[1];
    }
    (even + odd).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        scene::{Collision, CollisionDetection, Force, Integrator},
        sim::{
            RootSearch, Simulation, StepError,
            bodies::Bodies,
            forces::Forces,
            samples::{edge, particle, scene},
        },
    };

    #[test]
    fn the_norm_adds_even_and_odd_squares() {
        assert_eq!(norm_by_halves(&[1.0, 4.0, 2.0, 2.0]), 5.0);
        assert_eq!(norm_by_halves(&[]), 0.0);
    }

    /// The end state satisfies the implicit equations `v' = v - h g(x', v') / m` and `x' = x + h v'`.
    #[test]
    fn a_step_solves_the_implicit_equations() {
        let mut scene =
            scene(vec![particle((0.0, 0.0), (1.0, 0.5), 2.0, 0.1), particle((1.0, 0.25), (-0.5, 0.75), 1.0, 0.1)]);
        scene.integrator = Integrator::ImplicitEuler;
        scene.edges.push(edge(0, 1, 0.01));
        scene.forces.push(Force::Spring { edge: 0, stiffness: 2.0, rest_length: 0.8, damping: 0.3 });
        let mut simulation = Simulation::new(&scene, RootSearch::default());
        let before = simulation.state().clone();
        simulation.step(&mut ()).expect("Newton's method converges");
        let after = simulation.state();
        let mut gradient = vec![0.0; 4];
        let (bodies, mut forces) = (Bodies::new(&scene), Forces::new(&scene));
        forces.fill_gradient(&bodies, &after.positions, &after.velocities, &mut gradient);
        for (k, gradient) in gradient.iter().enumerate() {
            let velocity = before.velocities[k] - 0.5 * gradient / bodies.masses[k / 2];
            assert!((after.velocities[k] - velocity).abs() < 1e-8, "{k}");
            assert!((after.positions[k] - (before.positions[k] + 0.5 * after.velocities[k])).abs() < 1e-12, "{k}");
        }
    }

    /// The penalty force has no Hessian, so the iteration enters and leaves the layer forever.
    #[test]
    fn an_endless_iteration_is_an_error() {
        let mut scene =
            scene(vec![particle((0.0, 0.0), (1.0, 0.0), 1.0, 0.1), particle((1.25, 0.0), (-1.0, 0.0), 1.0, 0.1)]);
        scene.integrator = Integrator::ImplicitEuler;
        scene.collision =
            Collision::Penalty { stiffness: 1000.0, thickness: 0.1, detection: CollisionDetection::AllPairs };
        let mut simulation = Simulation::new(&scene, RootSearch::default());
        assert_eq!(simulation.step(&mut ()), Err(StepError::Newton { step: 1 }));
        assert!(simulation.work() > 2, "{}", simulation.work());

        let mut simulation = Simulation::new(&scene, RootSearch::default());
        simulation.limit_work(2);
        assert_eq!(simulation.step(&mut ()), Err(StepError::Work { step: 1 }));
        assert!(simulation.work() < 10, "{}", simulation.work());
    }
}
