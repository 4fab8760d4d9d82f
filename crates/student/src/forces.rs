//! The forces: the gradient of their potentials (simulation.md 2 and 3).
use fosssim_model::scene::{Collision, CollisionDetection, Force};
use fosssim_num::vector::{Vec2, divide, length, vector_at};

use super::{
    Slip, StepMistake, Term,
    author::Student,
    penalty::{self, PenaltyLayer},
    slip_effects::TermPart,
    world::{World, add, subtract},
};

/// Returns the gradient of the potentials of all forces at positions `x` and velocities `v`. The forces are added in
/// the order of the scene, and the penalty force is added last.
pub fn gradient(world: &World, x: &[f64], v: &[f64]) -> Vec<f64> {
    let mut g = vec![0.0; x.len()];
    for force in &world.scene.forces {
        add_gradient(world, force, x, v, &mut g);
    }
    let (k, h, detection) = match world.scene.collision {
        Collision::Penalty { stiffness, thickness, detection } => (stiffness, thickness, detection),
        Collision::Hybrid { stiffness, thickness, .. } => (stiffness, thickness, CollisionDetection::AllPairs),
        _ => return g,
    };
    penalty::add_gradient(world, PenaltyLayer { k, h, detection }, x, v, &mut g);
    g
}

fn add_gradient(world: &World, force: &Force, x: &[f64], v: &[f64], g: &mut [f64]) {
    let (student, count) = (world.student, world.scene.particles.len());
    let subtracted = |term, particle| TermPart { is_negative: true, ..TermPart::from_term(term, particle) };
    match *force {
        Force::Spring { .. } => add_spring(world, force, x, v, g),
        Force::SimpleGravity { acceleration } => {
            for i in 0..count {
                world.contribute(g, subtracted(Term::Gravity, i), world.masses[2 * i] * acceleration);
            }
        }
        Force::Gravitation { first, second, constant } => add_gravitation(world, (first, second), constant, x, g),
        Force::Constant { force } => (0..count).for_each(|i| subtract(g, i, force)),
        Force::Drag { coefficient } => {
            let of = if student.makes(StepMistake::DragOfPositions) { x } else { v };
            for i in 0..count {
                let speed = if student.makes(StepMistake::DragQuadratic) { length(vector_at(v, i)) } else { 1.0 };
                let of = vector_at(of, i);
                let of = if student.makes(StepMistake::DragSquares) { of.component_mul(&of.abs()) } else { of };
                world.contribute(g, TermPart::from_term(Term::Drag, i), speed * (coefficient * of));
            }
        }
        Force::Vortex { .. } => add_vortex(force, x, v, g),
    }
}

fn add_spring(world: &World, force: &Force, x: &[f64], v: &[f64], g: &mut [f64]) {
    let Force::Spring { edge, stiffness, rest_length, damping } = *force else { return };
    let student = world.student;
    let makes = |mistake: StepMistake| student.makes(mistake);
    let edge = world.scene.edges[edge];
    let (a, b) = (edge.first, edge.second);
    let d = vector_at(x, b) - vector_at(x, a);
    let l = length(d);
    let is_long = makes(StepMistake::SpringDirection) || makes(StepMistake::SpringDirectionEverywhere);
    let n = if is_long { d } else { divide(d, l) };
    let stiffness = if makes(StepMistake::SpringNoStiffness) { 1.0 } else { stiffness };
    let stretch = match () {
        () if makes(StepMistake::SpringNoRestLength) => l,
        () if makes(StepMistake::SpringRestLengthSign) => l + rest_length,
        () if makes(StepMistake::SpringRestLengthInteger) => l - rest_length.trunc(),
        () if makes(StepMistake::SpringPullsOnly) => (l - rest_length).max(0.0),
        () if makes(StepMistake::SpringStrain) => (l - rest_length) / rest_length,
        () => l - rest_length,
    };
    let tension = apply_slips(student, Term::SpringElastic, stiffness * stretch, stretch);
    world.contribute_opposite(g, Term::SpringElastic, (a, b), tension * n, l);

    let damping = if makes(StepMistake::SpringDampingNoCoefficient) { 1.0 } else { damping };
    let w = match () {
        () if makes(StepMistake::SpringDampingOneVelocity) => vector_at(v, b),
        () if makes(StepMistake::SpringDampingFirstVelocity) => -vector_at(v, a),
        () if makes(StepMistake::SpringDampingVelocitySum) => vector_at(v, b) + vector_at(v, a),
        () => vector_at(v, b) - vector_at(v, a),
    };
    let damped = if makes(StepMistake::SpringDampingAllDirections) {
        damping * w
    } else {
        let speed = if makes(StepMistake::SpringDampingSpeed) { length(w) } else { n.dot(&w) };
        apply_slips(student, Term::SpringDamping, damping * speed, speed) * n
    };
    world.contribute_opposite(g, Term::SpringDamping, (a, b), damped, l);
}

/// Returns `value` with the student's slip in this term, if there is one. A student may take the absolute value, or
/// multiply by `factor` once more, as the energy contains its square.
fn apply_slips(student: Student, term: Term, value: f64, factor: f64) -> f64 {
    match () {
        () if student.makes_slip(term, Slip::Absolute) => value.abs(),
        () if student.makes_slip(term, Slip::Squared) => value * factor,
        () if student.makes_slip(term, Slip::SquaredHalf) => 0.5 * value * factor,
        () => value,
    }
}

fn add_gravitation(world: &World, (first, second): (usize, usize), constant: f64, x: &[f64], g: &mut [f64]) {
    let makes = |mistake: StepMistake| world.student.makes(mistake);
    let d = vector_at(x, second) - vector_at(x, first);
    let r = length(d);
    let n = divide(d, r);
    let constant = if makes(StepMistake::GravitationNoConstant) { 1.0 } else { constant };
    let (m1, m2) = match () {
        () if makes(StepMistake::GravitationNoMasses) => (1.0, 1.0),
        () if makes(StepMistake::GravitationOwnMass) => (world.masses[2 * first], world.masses[2 * first]),
        () if makes(StepMistake::GravitationOtherMass) => (world.masses[2 * second], world.masses[2 * second]),
        () if makes(StepMistake::GravitationMassSum) => (1.0, world.masses[2 * first] + world.masses[2 * second]),
        () if makes(StepMistake::GravitationMassIndex) => (world.masses[first], world.masses[second]),
        () => (world.masses[2 * second], world.masses[2 * first]),
    };
    let pull = constant * m1 * m2 / (r * r) * n;
    world.contribute_opposite(g, Term::Gravitation, (first, second), pull, r);
}

/// Adds the vortex force, which the course's library computes.
fn add_vortex(force: &Force, x: &[f64], v: &[f64], g: &mut [f64]) {
    let Force::Vortex { first, second, strength, coupling } = *force else { return };
    let d = vector_at(x, second) - vector_at(x, first);
    let r = length(d);
    let scaled_direction = strength * divide(d, r);
    let around = Vec2::new(-scaled_direction.y, scaled_direction.x) - (vector_at(v, second) - vector_at(v, first));
    let push = -(coupling * divide(around, r * r));
    subtract(g, first, push);
    add(g, second, push);
}
