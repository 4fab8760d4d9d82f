//! One step of the integrators, without collisions.
use super::{
    Arithmetic, Solver,
    forces::{ForceTerms, mass},
};
use fosssim_model::scene::{Integrator, Scene};
use fosssim_num::tolerances::NEWTON_UPDATE_NORM;
use fosssim_oracle::student::State;
use nalgebra::{DMatrix, DVector};

/// The maximum number of iterations of Newton's method.
const NEWTON_LIMIT: u32 = 200;

/// The maximum number of unknowns for singular values; larger systems take too long.
const SVD_LIMIT: usize = 40;

/// Advances the state; `None` if the step has no result.
pub(super) fn advance(
    scene: &Scene,
    arithmetic: Arithmetic,
    forces: &mut ForceTerms<'_>,
    state: &mut State,
) -> Option<()> {
    let h = scene.time_step;
    let add = |values: &mut [f64], changes: &[f64]| {
        values.iter_mut().zip(changes).for_each(|(value, change)| *value = arithmetic.add_product(*value, h, *change));
    };
    match scene.integrator {
        Integrator::ExplicitEuler => {
            let changes = accelerations(scene, forces, state);
            add(&mut state.x, &state.v);
            add(&mut state.v, &changes);
        }
        Integrator::ForwardBackwardEuler | Integrator::SymplecticEuler => {
            let changes = accelerations(scene, forces, state);
            add(&mut state.v, &changes);
            add(&mut state.x, &state.v);
        }
        Integrator::LinearizedImplicitEuler => {
            let mut x = state.x.clone();
            add(&mut x, &state.v);
            let force = forces.evaluate_at(&x, &state.v);
            let right = clear_fixed(scene, force.iter().map(|force| h * force).collect());
            let change = solve(arithmetic.solver, forces.system(&x, &state.v)?, right)?;
            state.v.iter_mut().zip(&change).for_each(|(v, change)| *v += change);
            add(&mut state.x, &state.v);
        }
        Integrator::ImplicitEuler => {
            // The unknowns are the velocities at the end.
            let mut v = state.v.clone();
            let mut converged = false;
            for _ in 0..NEWTON_LIMIT {
                let mut x = state.x.clone();
                add(&mut x, &v);
                let force = forces.evaluate_at(&x, &v);
                let right = (0..v.len()).map(|k| h * force[k] - mass(scene, k / 2) * (v[k] - state.v[k])).collect();
                let change = solve(arithmetic.solver, forces.system(&x, &v)?, clear_fixed(scene, right))?;
                v.iter_mut().zip(&change).for_each(|(v, change)| *v += change);
                let squares: f64 = change.iter().map(|change| change * change).sum();
                if !(squares.sqrt() >= NEWTON_UPDATE_NORM) {
                    converged = true;
                    break;
                }
            }
            if !converged {
                return None;
            }
            state.v = v;
            add(&mut state.x, &state.v);
        }
    }
    Some(())
}

fn accelerations(scene: &Scene, forces: &mut ForceTerms<'_>, state: &State) -> Vec<f64> {
    let force = forces.evaluate_at(&state.x, &state.v);
    clear_fixed(scene, (0..force.len()).map(|k| force[k] / mass(scene, k / 2)).collect())
}

/// Returns the entries with zeros for fixed particles.
fn clear_fixed(scene: &Scene, mut values: Vec<f64>) -> Vec<f64> {
    values.iter_mut().enumerate().filter(|(k, _)| scene.particles[k / 2].fixed).for_each(|(_, value)| *value = 0.0);
    values
}

fn solve(solver: Solver, matrix: DMatrix<f64>, right: Vec<f64>) -> Option<Vec<f64>> {
    let right = DVector::from_vec(right);
    let solution = match solver {
        Solver::Partial => matrix.lu().solve(&right),
        Solver::Qr => matrix.qr().solve(&right),
        Solver::Cholesky => {
            let is_symmetric = matrix == matrix.transpose();
            match matrix.clone().cholesky().filter(|_| is_symmetric) {
                Some(factors) => Some(factors.solve(&right)),
                None => matrix.lu().solve(&right),
            }
        }
        Solver::Svd if right.len() > SVD_LIMIT => matrix.lu().solve(&right),
        Solver::Svd => matrix.svd(true, true).solve(&right, 0.0).ok(),
    };
    solution.map(|solution| solution.as_slice().to_vec())
}
