//! The time integrators (simulation.md 4).
use std::hint::black_box;

use fosssim_model::scene::Integrator;
use fosssim_num::linear;

use super::{forces, hessians, objects::State, step_failure::StepFailure, world::World};

/// Newton's method is given up after this many iterations; the course's program would go on for ever.
const NEWTON_LIMIT: u32 = 100_000;

/// Advances the state by one step, without any regard for collisions.
pub fn advance(world: &World, state: &mut State) -> Result<(), StepFailure> {
    match world.scene.integrator {
        Integrator::ExplicitEuler => explicit(world, state),
        Integrator::ForwardBackwardEuler | Integrator::SymplecticEuler => symplectic(world, state),
        Integrator::LinearizedImplicitEuler => return linearized_implicit(world, state),
        Integrator::ImplicitEuler => return implicit(world, state),
    }
    Ok(())
}

fn accelerations(world: &World, state: &State) -> Vec<f64> {
    // The factor must stay a factor: as a change of sign it would turn the sign of a NaN.
    let minus_one = black_box(-1.0);
    let mut force = forces::gradient(world, &state.x, &state.v);
    for (k, entry) in force.iter_mut().enumerate() {
        *entry = if world.fixed(k / 2) { 0.0 } else { minus_one * *entry };
        *entry /= world.masses[k];
    }
    force
}

fn explicit(world: &World, state: &mut State) {
    let h = world.scene.time_step;
    let accelerations = accelerations(world, state);
    state.x = world.student.sum(&state.x, h, &state.v);
    state.v = world.student.sum(&state.v, h, &accelerations);
}

fn symplectic(world: &World, state: &mut State) {
    let h = world.scene.time_step;
    let accelerations = accelerations(world, state);
    state.v = world.student.sum(&state.v, h, &accelerations);
    state.x = world.student.sum(&state.x, h, &state.v);
}

fn clear_fixed(world: &World, vector: &mut [f64]) {
    for (k, entry) in vector.iter_mut().enumerate() {
        if world.fixed(k / 2) {
            *entry = 0.0;
        }
    }
}

fn linearized_implicit(world: &World, state: &mut State) -> Result<(), StepFailure> {
    let h = world.scene.time_step;
    let minus_one = black_box(-1.0);
    let x = world.student.sum(&state.x, h, &state.v);
    let v: Vec<f64> = state.v.iter().map(|v| v + 0.0).collect();
    let mut rhs = forces::gradient(world, &x, &v);
    rhs.iter_mut().for_each(|entry| *entry = *entry * minus_one * h);
    clear_fixed(world, &mut rhs);
    let mut matrix = hessians::system_matrix(world, &x, &v)?;
    linear::solve(&mut matrix, &mut rhs, &mut linear::Workspace::default());
    state.v.iter_mut().zip(&rhs).for_each(|(v, change)| *v += change);
    state.x = world.student.sum(&state.x, h, &state.v);
    Ok(())
}

fn implicit(world: &World, state: &mut State) -> Result<(), StepFailure> {
    let h = world.scene.time_step;
    let mut dx: Vec<f64> = state.v.iter().map(|v| h * v).collect();
    let mut dv = vec![0.0; state.v.len()];
    let mut update = f64::INFINITY;
    let mut workspace = linear::Workspace::default();
    let mut iterations = 0;
    while update >= 1e-9 {
        iterations += 1;
        if iterations > NEWTON_LIMIT {
            return Err(StepFailure::Newton);
        }
        let x: Vec<f64> = state.x.iter().zip(&dx).map(|(x, dx)| x + dx).collect();
        let v: Vec<f64> = state.v.iter().zip(&dv).map(|(v, dv)| v + dv).collect();
        let mut rhs = forces::gradient(world, &x, &v);
        let minus_h = black_box(-h);
        for (k, entry) in rhs.iter_mut().enumerate() {
            *entry = *entry * minus_h + black_box(-(world.masses[k] * dv[k]));
        }
        clear_fixed(world, &mut rhs);
        let mut matrix = hessians::system_matrix(world, &x, &v)?;
        linear::solve(&mut matrix, &mut rhs, &mut workspace);
        dv.iter_mut().zip(&rhs).for_each(|(dv, change)| *dv += change);
        dx = state.v.iter().zip(&dv).map(|(v, dv)| h * (v + dv)).collect();
        update = norm(&rhs);
    }
    state.x.iter_mut().zip(&dx).for_each(|(x, dx)| *x += dx);
    state.v.iter_mut().zip(&dv).for_each(|(v, dv)| *v += dv);
    Ok(())
}

/// The length of a vector of even size, its squares summed over even and odd entries apart.
fn norm(vector: &[f64]) -> f64 {
    let squares = |start: usize| {
        vector
            .iter()
            .skip(start)
            .step_by(2)
            .map(|entry| entry * entry)
            .reduce(|sum, square| sum + square)
            .unwrap_or(0.0)
    };
    (squares(0) + squares(1)).sqrt()
}
