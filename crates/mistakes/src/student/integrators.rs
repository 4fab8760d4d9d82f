//! The time integrators (simulation.md 4).
use std::hint::black_box;

use fosssim_model::scene::Integrator;
use fosssim_num::linear;

use super::{Area, Mistake, StepMistake, forces, hessians, objects::State, step_failure::StepFailure, world::World};

/// Newton's method is given up after this many iterations; the course's program would go on for ever.
const NEWTON_LIMIT: u32 = 100_000;

/// And after this many with a mistake: such a program is tried in passing, and converges soon or hardly at all.
const NEWTON_LIMIT_OF_MISTAKES: u32 = 150;

/// Advances the state by one step, without any regard for collisions. `solves` counts the systems that are solved.
pub fn advance(world: &World, state: &mut State, solves: &mut u32) -> Result<(), StepFailure> {
    let mistake = world.student.mistake_in(&[Area::Integrator]);
    let before = mistake.map(|_| state.clone());
    match world.scene.integrator {
        _ if mistake == Some(Mistake::Step(StepMistake::IntegratorEmpty)) => {}
        Integrator::ExplicitEuler => explicit(world, state),
        Integrator::ForwardBackwardEuler | Integrator::SymplecticEuler => symplectic(world, state),
        Integrator::LinearizedImplicitEuler if world.student.makes(StepMistake::LinearIterates) => {
            implicit(world, state, solves)?;
        }
        Integrator::LinearizedImplicitEuler => {
            *solves = 1;
            linearized_implicit(world, state)?;
        }
        Integrator::ImplicitEuler => implicit(world, state, solves)?,
    }
    if let Some(before) = before {
        amend(world, &before, state);
    }
    Ok(())
}

/// Mistakes that are the same with all integrators: which velocities move the positions, and fixed particles.
fn amend(world: &World, before: &State, state: &mut State) {
    let (student, h) = (world.student, world.scene.time_step);
    let makes = |mistake: StepMistake| student.makes(mistake);
    let is_explicit = world.scene.integrator == Integrator::ExplicitEuler;
    if makes(StepMistake::IntegratorVelocitiesEmpty) {
        state.v.clone_from(&before.v);
        state.x = student.sum(&before.x, h, &before.v);
    }
    if makes(StepMistake::IntegratorVelocityFirst) {
        state.x = student.sum(&before.x, h, &state.v);
    }
    if makes(StepMistake::IntegratorPositionFirst) || makes(StepMistake::ImplicitPositionWithoutChange) {
        state.x = student.sum(&before.x, h, &before.v);
    }
    if makes(StepMistake::IntegratorNoStepForPositions) {
        state.x = student.sum(&before.x, 1.0, if is_explicit { &before.v } else { &state.v });
    }
    if makes(StepMistake::IntegratorMeanVelocity) {
        let mean: Vec<f64> = before.v.iter().zip(&state.v).map(|(old, new)| (old + new) / 2.0).collect();
        state.x = student.sum(&before.x, h, &mean);
    }
    if makes(StepMistake::IntegratorPositionsEmpty) {
        state.x.clone_from(&before.x);
    }
    let stops = makes(StepMistake::IntegratorFixedStopped);
    for k in (0..state.x.len()).filter(|k| world.fixed(k / 2)) {
        if stops {
            state.v[k] = 0.0;
        }
        if makes(StepMistake::IntegratorFixedStand) || (stops && !is_explicit) {
            state.x[k] = before.x[k];
        }
    }
}

fn accelerations(world: &World, state: &State) -> Vec<f64> {
    let makes = |mistake: StepMistake| world.student.makes(mistake);
    // The factor must stay a factor: as a change of sign it would turn the sign of a NaN.
    let minus_one = black_box(if makes(StepMistake::IntegratorForceSign) { 1.0 } else { -1.0 });
    let mut force = if makes(StepMistake::IntegratorForceBehindPositions) {
        forces::gradient(world, &world.student.sum(&state.x, world.scene.time_step, &state.v), &state.v)
    } else {
        forces::gradient(world, &state.x, &state.v)
    };
    for (k, entry) in force.iter_mut().enumerate() {
        let is_fixed = world.fixed(k / 2) && !makes(StepMistake::IntegratorFixedForgotten);
        *entry = if is_fixed { 0.0 } else { minus_one * *entry };
        match () {
            () if makes(StepMistake::IntegratorNoMass) => {}
            () if makes(StepMistake::IntegratorMassMultiplied) => *entry *= world.masses[k],
            () => *entry /= world.masses[k],
        }
    }
    force
}

/// The step size by which forces change velocities.
fn step_of_velocities(world: &World) -> f64 {
    let is_missing = world.student.makes(StepMistake::IntegratorNoStepForVelocities);
    if is_missing { 1.0 } else { world.scene.time_step }
}

fn explicit(world: &World, state: &mut State) {
    let accelerations = accelerations(world, state);
    state.x = world.student.sum(&state.x, world.scene.time_step, &state.v);
    state.v = world.student.sum(&state.v, step_of_velocities(world), &accelerations);
}

fn symplectic(world: &World, state: &mut State) {
    let accelerations = accelerations(world, state);
    state.v = world.student.sum(&state.v, step_of_velocities(world), &accelerations);
    state.x = world.student.sum(&state.x, world.scene.time_step, &state.v);
}

/// Clears the entries of fixed particles in a right-hand side.
fn clear_fixed(world: &World, vector: &mut [f64]) {
    let student = world.student;
    if student.makes(StepMistake::RightSideOfFixed) || student.makes(StepMistake::IntegratorFixedForgotten) {
        return;
    }
    for (k, entry) in vector.iter_mut().enumerate() {
        if world.fixed(k / 2) {
            *entry = 0.0;
        }
    }
}

/// The factor of the gradient in a right-hand side: -1 and the step size.
fn factors(world: &World) -> (f64, f64) {
    let makes = |mistake: StepMistake| world.student.makes(mistake);
    let h = if makes(StepMistake::RightSideNoStep) { 1.0 } else { world.scene.time_step };
    (black_box(if makes(StepMistake::RightSideSign) { 1.0 } else { -1.0 }), h)
}

fn linearized_implicit(world: &World, state: &mut State) -> Result<(), StepFailure> {
    let makes = |mistake: StepMistake| world.student.makes(mistake);
    let (minus_one, step) = factors(world);
    let h = world.scene.time_step;
    let predicted = world.student.sum(&state.x, h, &state.v);
    let v: Vec<f64> = state.v.iter().map(|v| v + 0.0).collect();
    let at_start = makes(StepMistake::LinearAllAtStart);
    let of_forces = if at_start || makes(StepMistake::LinearForcesAtStart) { &state.x } else { &predicted };
    let mut rhs = forces::gradient(world, of_forces, &v);
    rhs.iter_mut().for_each(|entry| *entry = *entry * minus_one * step);
    clear_fixed(world, &mut rhs);
    let of_matrix = if at_start || makes(StepMistake::LinearMatrixAtStart) { &state.x } else { &predicted };
    let mut matrix = hessians::system_matrix(world, of_matrix, &v)?;
    linear::solve(&mut matrix, &mut rhs, &mut linear::Workspace::default());
    if makes(StepMistake::LinearOverwrites) {
        state.v = rhs;
    } else {
        state.v.iter_mut().zip(&rhs).for_each(|(v, change)| *v += change);
    }
    state.x = world.student.sum(&state.x, h, &state.v);
    Ok(())
}

fn implicit(world: &World, state: &mut State, solves: &mut u32) -> Result<(), StepFailure> {
    let makes = |mistake: StepMistake| world.student.makes(mistake);
    let (minus_one, step) = factors(world);
    let h = world.scene.time_step;
    let most = if world.student.makes_none() { NEWTON_LIMIT } else { NEWTON_LIMIT_OF_MISTAKES };
    let enough = if makes(StepMistake::ImplicitLoose) { 1e-3 } else { 1e-9 };
    let mut dx: Vec<f64> = state.v.iter().map(|v| h * v).collect();
    let mut dv = vec![0.0; state.v.len()];
    let mut update = f64::INFINITY;
    let mut workspace = linear::Workspace::default();
    *solves = 0;
    while update >= enough && !(*solves > 0 && makes(StepMistake::ImplicitOneIteration)) {
        *solves += 1;
        if *solves > most {
            return Err(StepFailure::Newton);
        }
        let x: Vec<f64> = state.x.iter().zip(&dx).map(|(x, dx)| x + dx).collect();
        let v: Vec<f64> = if makes(StepMistake::ImplicitVelocitiesKept) {
            state.v.clone()
        } else {
            state.v.iter().zip(&dv).map(|(v, dv)| v + dv).collect()
        };
        let mut rhs = forces::gradient(world, &x, &v);
        let minus_h = black_box(minus_one * step);
        for (k, entry) in rhs.iter_mut().enumerate() {
            *entry = *entry * minus_h + black_box(-(world.masses[k] * dv[k]));
        }
        clear_fixed(world, &mut rhs);
        let mut matrix = hessians::system_matrix(world, &x, &v)?;
        linear::solve(&mut matrix, &mut rhs, &mut workspace);
        dv.iter_mut().zip(&rhs).for_each(|(dv, change)| *dv += change);
        if !makes(StepMistake::ImplicitPositionsKept) {
            dx = state.v.iter().zip(&dv).map(|(v, dv)| h * (v + dv)).collect();
        }
        update = norm(&rhs);
    }
    state.x.iter_mut().zip(&dx).for_each(|(x, dx)| *x += dx);
    state.v.iter_mut().zip(&dv).for_each(|(v, dv)| *v += dv);
    Ok(())
}

/// The length of a vector of even size, its squares summed over even and odd entries apart.
fn norm(vector: &[f64]) -> f64 {
    let squares = |start: usize| {
        let squares = vector.iter().skip(start).step_by(2).map(|entry| entry * entry);
        squares.reduce(|sum, square| sum + square).unwrap_or(0.0)
    };
    (squares(0) + squares(1)).sqrt()
}
