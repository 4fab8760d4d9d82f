//! The time integrators (simulation.md 4).
use std::hint::black_box;

use fosssim_model::scene::Integrator;
use fosssim_num::linear;

use super::{
    Slip, StepMistake, Term, author::Student, forces, hessians, objects::State, step_failure::StepFailure, world::World,
};

/// The maximum number of iterations of Newton's method. The course's program would continue forever.
const MAX_NEWTON_ITERATIONS: u32 = 100_000;

/// The maximum number of iterations of Newton's method in a program with a mistake. With wrong second derivatives the
/// iterations jump about, and then converge by chance or reach values that are not finite.
const MAX_MISTAKEN_NEWTON_ITERATIONS: u32 = 500;

/// Advances the state by one step without collisions. `solves` counts the systems that are solved.
pub fn advance(world: &World, state: &mut State, solves: &mut u32) -> Result<(), StepFailure> {
    let step_term = whole_step_term(world.scene.integrator);
    if step_term.is_some_and(|step_term| world.student.makes_slip(step_term, Slip::Missing)) {
        return Ok(());
    }
    let before = (!world.student.makes_no_mistake()).then(|| state.clone());
    match world.scene.integrator {
        Integrator::ExplicitEuler => {
            step_explicit(world, world, [Term::ExplicitPositions, Term::ExplicitVelocities], true, state);
        }
        // The library supplies the integrator, and the student writes the forces.
        Integrator::ForwardBackwardEuler => {
            step_explicit(&world.for_student(Student::default()), world, SYMPLECTIC_TERMS, false, state)
        }
        Integrator::SymplecticEuler => step_explicit(world, world, SYMPLECTIC_TERMS, false, state),
        Integrator::LinearizedImplicitEuler if world.student.makes(StepMistake::LinearIterates) => {
            step_implicit(world, state, solves)?;
        }
        Integrator::LinearizedImplicitEuler => {
            *solves = 1;
            step_linearized_implicit(world, state)?;
        }
        Integrator::ImplicitEuler => step_implicit(world, state, solves)?,
    }
    if let (Some(before), Some(step_term)) = (before, step_term) {
        mishandle_fixed(world, step_term, &before, state);
    }
    Ok(())
}

const SYMPLECTIC_TERMS: [Term; 2] = [Term::SymplecticPositions, Term::SymplecticVelocities];

/// Returns the term that represents the whole step of an integrator, or `None` if students do not write the integrator.
const fn whole_step_term(integrator: Integrator) -> Option<Term> {
    Some(match integrator {
        Integrator::ExplicitEuler => Term::Explicit,
        Integrator::SymplecticEuler => Term::Symplectic,
        Integrator::LinearizedImplicitEuler => Term::Linear,
        Integrator::ImplicitEuler => Term::Implicit,
        Integrator::ForwardBackwardEuler => return None,
    })
}

/// Applies mistakes with fixed particles, which are the same for all integrators.
fn mishandle_fixed(world: &World, whole: Term, before: &State, state: &mut State) {
    let makes = |slip: Slip| world.student.makes_slip(whole, slip);
    for k in (0..state.x.len()).filter(|k| world.is_fixed(k / 2)) {
        if makes(Slip::FixedVelocityZeroedFirst) || makes(Slip::FixedVelocityZeroedAfter) {
            state.v[k] = 0.0;
        }
        if makes(Slip::FixedVelocityZeroedFirst) || makes(Slip::FixedNotMoved) {
            state.x[k] = before.x[k];
        }
    }
}

/// Returns the velocities with which this student's program moves positions. `right_rate` contains the velocities that
/// the assignment requires, and `other_rate` those that a student may use by mistake.
fn position_rate(world: &World, term: Term, right_rate: &[f64], other_rate: &[f64]) -> Vec<f64> {
    match () {
        () if world.student.makes_slip(term, Slip::OtherVelocity) => other_rate.to_vec(),
        () if world.student.makes_slip(term, Slip::MeanVelocity) => {
            right_rate.iter().zip(other_rate).map(|(one, other)| (one + other) / 2.0).collect()
        }
        () => right_rate.to_vec(),
    }
}

/// Makes one step of the explicit integrators, which move positions with the old or the new velocities. The forces are
/// those of the world `forces`, whose program may have a different author.
fn step_explicit(
    world: &World,
    forces: &World,
    [position_term, velocity_term]: [Term; 2],
    moves_by_old: bool,
    state: &mut State,
) {
    let (student, h) = (world.student, world.scene.time_step);
    // The factor must stay a multiplication, because a change of sign would also change the sign of a NaN.
    let minus_one = black_box(-1.0);
    let x = if student.makes_slip(velocity_term, Slip::ForcesAfterMove) {
        &student.add_scaled_lists(&state.x, h, &state.v)
    } else {
        &state.x
    };
    let mut accelerations = forces::gradient(forces, x, &state.v);
    let forgets =
        whole_step_term(world.scene.integrator).is_some_and(|whole| student.makes_slip(whole, Slip::FixedForgotten));
    for (k, entry) in accelerations.iter_mut().enumerate() {
        *entry = if world.is_fixed(k / 2) && !forgets { 0.0 } else { minus_one * *entry };
        *entry /= world.masses[k];
    }
    let old = state.v.clone();
    world.advance(velocity_term, &mut state.v, h, &accelerations);
    let (right, other) = if moves_by_old { (&old, &state.v) } else { (&state.v, &old) };
    world.advance(position_term, &mut state.x, h, &position_rate(world, position_term, right, other));
}

/// Sets the entries of fixed particles in a right-hand side to zero.
fn clear_fixed(world: &World, whole: Term, vector: &mut [f64]) {
    if [Slip::RightOfFixed, Slip::FixedForgotten].into_iter().any(|slip| world.student.makes_slip(whole, slip)) {
        return;
    }
    for (k, entry) in vector.iter_mut().enumerate() {
        if world.is_fixed(k / 2) {
            *entry = 0.0;
        }
    }
}

fn step_linearized_implicit(world: &World, state: &mut State) -> Result<(), StepFailure> {
    let makes = |mistake: StepMistake| world.student.makes(mistake);
    let h = world.scene.time_step;
    let predicted = world.student.add_scaled_lists(&state.x, h, &state.v);
    let twice = makes(StepMistake::LinearVelocitiesTwice);
    let v: Vec<f64> = state.v.iter().map(|v| v + if twice { *v } else { 0.0 }).collect();
    let uses_start = makes(StepMistake::LinearAllAtStart);
    let force_positions = if uses_start || makes(StepMistake::LinearForcesAtStart) { &state.x } else { &predicted };
    let mut rhs = forces::gradient(world, force_positions, &v);
    for (k, entry) in rhs.iter_mut().enumerate() {
        *entry = *entry * black_box(-1.0) * h * world.whole_weight(Term::LinearRight, k / 2, 1.0);
    }
    clear_fixed(world, Term::Linear, &mut rhs);
    let matrix_positions = if uses_start || makes(StepMistake::LinearMatrixAtStart) { &state.x } else { &predicted };
    let mut matrix = hessians::system_matrix(world, matrix_positions, &v)?;
    linear::solve(&mut matrix, &mut rhs, &mut linear::Workspace::default());
    let old = state.v.clone();
    world.advance(Term::LinearVelocities, &mut state.v, 1.0, &rhs);
    world.advance(Term::LinearPositions, &mut state.x, h, &position_rate(world, Term::LinearPositions, &state.v, &old));
    Ok(())
}

fn step_implicit(world: &World, state: &mut State, solves: &mut u32) -> Result<(), StepFailure> {
    let makes = |mistake: StepMistake| world.student.makes(mistake);
    let h = world.scene.time_step;
    let max_iterations =
        if world.student.makes_no_mistake() { MAX_NEWTON_ITERATIONS } else { MAX_MISTAKEN_NEWTON_ITERATIONS };
    let (mut enough, mut iterations) = (1e-9, u32::MAX);
    for slip in world.student.slips(Term::Newton) {
        match slip {
            Slip::Iterations(count) => iterations = count.into(),
            Slip::Loose(digits) => enough = 1.0 / (0..digits).fold(1.0, |power, _| power * 10.0),
            _ => {}
        }
    }
    let mut dx: Vec<f64> = state.v.iter().map(|v| h * v).collect();
    let mut dv = vec![0.0; state.v.len()];
    let mut update = f64::INFINITY;
    let mut workspace = linear::Workspace::default();
    *solves = 0;
    while update >= enough && *solves < iterations {
        *solves += 1;
        if *solves > max_iterations {
            return Err(StepFailure::Newton);
        }
        let x: Vec<f64> = state.x.iter().zip(&dx).map(|(x, dx)| x + dx).collect();
        let v: Vec<f64> = if makes(StepMistake::ImplicitVelocitiesKept) {
            state.v.clone()
        } else {
            state.v.iter().zip(&dv).map(|(v, dv)| v + dv).collect()
        };
        let mut rhs = forces::gradient(world, &x, &v);
        let minus_h = black_box(-h);
        for (k, entry) in rhs.iter_mut().enumerate() {
            let [force, momentum] =
                [Term::ImplicitRight, Term::ImplicitMomentum].map(|term| world.whole_weight(term, k / 2, 1.0));
            *entry = force * (*entry * minus_h) + momentum * black_box(-(world.masses[k] * dv[k]));
        }
        clear_fixed(world, Term::Implicit, &mut rhs);
        let mut matrix = hessians::system_matrix(world, &x, &v)?;
        linear::solve(&mut matrix, &mut rhs, &mut workspace);
        if world.student.slips(Term::ImplicitVelocities).next().is_none() {
            dv.iter_mut().zip(&rhs).for_each(|(dv, change)| *dv += change);
        } else {
            world.advance(Term::ImplicitVelocities, &mut dv, 1.0, &rhs);
        }
        if !makes(StepMistake::ImplicitPositionsKept) {
            dx = state.v.iter().zip(&dv).map(|(v, dv)| h * (v + dv)).collect();
        }
        update = norm(&rhs);
    }
    if world.student.slips(Term::ImplicitPositions).next().is_some() {
        let new: Vec<f64> = state.v.iter().zip(&dv).map(|(v, dv)| v + dv).collect();
        world.advance(
            Term::ImplicitPositions,
            &mut state.x,
            h,
            &position_rate(world, Term::ImplicitPositions, &new, &state.v),
        );
    } else {
        state.x.iter_mut().zip(&dx).for_each(|(x, dx)| *x += dx);
    }
    state.v.iter_mut().zip(&dv).for_each(|(v, dv)| *v += dv);
    Ok(())
}

/// Returns the length of a vector of even size, with the squares of even and odd entries summed separately.
fn norm(vector: &[f64]) -> f64 {
    let squares = |start: usize| {
        let squares = vector.iter().skip(start).step_by(2).map(|entry| entry * entry);
        squares.reduce(|sum, square| sum + square).unwrap_or(0.0)
    };
    (squares(0) + squares(1)).sqrt()
}
