//! The forces: the gradient of their potentials (simulation.md 2 and 3).
use fosssim_model::scene::{Collision, CollisionDetection, Force};
use fosssim_num::vector::{Vec2, at, length, over};

use super::{
    StepMistake,
    author::Student,
    penalty::{self, PenaltyLayer},
    world::{World, add, subtract},
};

/// The gradient of all forces at positions `x` and velocities `v`, in the order in which they act.
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

impl Student {
    /// The weight of the first of these mistakes that the student makes, else 1.
    pub fn weight(self, weights: &[(StepMistake, f64)]) -> f64 {
        weights.iter().find(|(mistake, _)| self.makes(*mistake)).map_or(1.0, |(_, weight)| *weight)
    }

    /// The value with such a weight.
    fn weighted(self, value: Vec2, weights: &[(StepMistake, f64)]) -> Vec2 {
        self.weight(weights) * value
    }

    /// Adds opposite forces to the two particles: `push` is the gradient's part of the second one. The mistakes: only
    /// the first one gets it, only the second one does, both get the same.
    fn add_opposite(self, g: &mut [f64], (a, b): (usize, usize), push: Vec2, mistakes: [Option<StepMistake>; 3]) {
        let [first_only, second_only, same_sign] = mistakes.map(|one| one.is_some_and(|one| self.makes(one)));
        if !second_only {
            subtract(g, a, push);
        }
        if !first_only {
            add(g, b, if same_sign { -push } else { push });
        }
    }
}

fn add_gradient(world: &World, force: &Force, x: &[f64], v: &[f64], g: &mut [f64]) {
    let (student, count) = (world.student, world.scene.particles.len());
    match *force {
        Force::Spring { .. } => spring(world, force, x, v, g),
        Force::SimpleGravity { acceleration } => {
            let last = count - usize::from(student.makes(StepMistake::GravityLastMissing)).min(count);
            for i in 0..last {
                let mass = if student.makes(StepMistake::GravityNoMass) { 1.0 } else { world.masses[2 * i] };
                let weights = [(StepMistake::GravityMissing, 0.0), (StepMistake::GravitySign, -1.0)];
                subtract(g, i, student.weighted(mass * acceleration, &weights));
            }
        }
        Force::Gravitation { first, second, constant } => gravitation(world, (first, second), constant, x, g),
        Force::Constant { force } => {
            for i in 0..count {
                let force = if student.makes(StepMistake::ConstantMass) { world.masses[2 * i] * force } else { force };
                let weights = [(StepMistake::ConstantMissing, 0.0), (StepMistake::ConstantSign, -1.0)];
                subtract(g, i, student.weighted(force, &weights));
            }
        }
        Force::Drag { coefficient } => {
            for i in 0..count {
                let weights = [
                    (StepMistake::DragMissing, 0.0),
                    (StepMistake::DragSign, -1.0),
                    (StepMistake::DragMass, world.masses[2 * i]),
                    (StepMistake::DragQuadratic, length(at(v, i))),
                ];
                add(g, i, student.weighted(coefficient * at(v, i), &weights));
            }
        }
        Force::Vortex { .. } => vortex(world, force, x, v, g),
    }
}

fn spring(world: &World, force: &Force, x: &[f64], v: &[f64], g: &mut [f64]) {
    let Force::Spring { edge, stiffness, rest_length, damping } = *force else { return };
    let student = world.student;
    let makes = |mistake: StepMistake| student.makes(mistake);
    let edge = world.scene.edges[edge];
    let (a, b) = (edge.first, edge.second);
    let d = at(x, b) - at(x, a);
    let l = length(d);
    let n = over(d, l);
    let is_long = makes(StepMistake::SpringDirection) || makes(StepMistake::SpringDirectionEverywhere);
    let along = if is_long || makes(StepMistake::SpringElasticDirection) { d } else { n };
    let stiffness = if makes(StepMistake::SpringNoStiffness) { 1.0 } else { stiffness };
    let stretch = match () {
        () if makes(StepMistake::SpringNoRestLength) => l,
        () if makes(StepMistake::SpringRestLengthSign) => l + rest_length,
        () if makes(StepMistake::SpringStretchSquared) => 0.5 * (l - rest_length) * (l - rest_length),
        () => l - rest_length,
    };
    let weights = [
        (StepMistake::SpringMissing, 0.0),
        (StepMistake::SpringElasticMissing, 0.0),
        (StepMistake::SpringElasticSign, -1.0),
        (StepMistake::SpringElasticHalved, 0.5),
        (StepMistake::SpringElasticDoubled, 2.0),
    ];
    let ends = [StepMistake::SpringFirstOnly, StepMistake::SpringSecondOnly, StepMistake::SpringSameSign].map(Some);
    student.add_opposite(g, (a, b), student.weighted(stiffness * stretch * along, &weights), ends);

    let along = if is_long || makes(StepMistake::SpringDampingDirection) { d } else { n };
    let damping = if makes(StepMistake::SpringDampingNoCoefficient) { 1.0 } else { damping };
    let w = match () {
        () if makes(StepMistake::SpringDampingOneVelocity) => at(v, b),
        () if makes(StepMistake::SpringDampingVelocitySum) => at(v, b) + at(v, a),
        () => at(v, b) - at(v, a),
    };
    let damped =
        if makes(StepMistake::SpringDampingAllDirections) { damping * w } else { damping * along.dot(&w) * along };
    let weights = [
        (StepMistake::SpringMissing, 0.0),
        (StepMistake::SpringDampingMissing, 0.0),
        (StepMistake::SpringDampingSign, -1.0),
    ];
    let damped = student.weighted(damped, &weights);
    if makes(StepMistake::SpringDampingFirstOnly) {
        subtract(g, a, damped);
    } else {
        student.add_opposite(g, (a, b), damped, ends);
    }
}

fn gravitation(world: &World, (first, second): (usize, usize), constant: f64, x: &[f64], g: &mut [f64]) {
    let student = world.student;
    let makes = |mistake: StepMistake| student.makes(mistake);
    let d = at(x, second) - at(x, first);
    let r = length(d);
    let n = over(d, r);
    let constant = if makes(StepMistake::GravitationNoConstant) { 1.0 } else { constant };
    let (m1, m2) = match () {
        () if makes(StepMistake::GravitationNoMasses) => (1.0, 1.0),
        () if makes(StepMistake::GravitationOwnMass) => (world.masses[2 * first], world.masses[2 * first]),
        () => (world.masses[2 * second], world.masses[2 * first]),
    };
    let distances = match () {
        () if makes(StepMistake::GravitationDistanceOnce) => r,
        () if makes(StepMistake::GravitationDistanceCubed) => r * r * r,
        () => r * r,
    };
    let weights = [(StepMistake::GravitationMissing, 0.0), (StepMistake::GravitationSign, -1.0)];
    let ends =
        [StepMistake::GravitationFirstOnly, StepMistake::GravitationSecondOnly, StepMistake::GravitationSameSign];
    let pull = student.weighted(constant * m1 * m2 / distances * n, &weights);
    student.add_opposite(g, (first, second), pull, ends.map(Some));
}

fn vortex(world: &World, force: &Force, x: &[f64], v: &[f64], g: &mut [f64]) {
    let Force::Vortex { first, second, strength, coupling } = *force else { return };
    let student = world.student;
    let makes = |mistake: StepMistake| student.makes(mistake);
    let d = at(x, second) - at(x, first);
    let r = length(d);
    let n = if makes(StepMistake::VortexDirection) { d } else { over(d, r) };
    let along = strength * n;
    let turning = match () {
        () if makes(StepMistake::VortexTurn) => Vec2::new(along.y, -along.x),
        () if makes(StepMistake::VortexAlong) => along,
        () => Vec2::new(-along.y, along.x),
    };
    let w = at(v, second) - at(v, first);
    let weights = [(StepMistake::VortexNoVelocity, 0.0), (StepMistake::VortexVelocitySign, -1.0)];
    let around = turning - student.weighted(w, &weights);
    let shared = match () {
        () if makes(StepMistake::VortexDistanceOnce) => over(around, r),
        () if makes(StepMistake::VortexNoDistance) => around,
        () if makes(StepMistake::VortexStrengthDivided) => over(turning, r * r) - w,
        () => over(around, r * r),
    };
    let weights = [(StepMistake::VortexMissing, 0.0), (StepMistake::VortexSign, -1.0)];
    let push = student.weighted(coupling * shared, &weights);
    let ends = [Some(StepMistake::VortexFirstOnly), None, Some(StepMistake::VortexSameSign)];
    student.add_opposite(g, (first, second), -push, ends);
}
