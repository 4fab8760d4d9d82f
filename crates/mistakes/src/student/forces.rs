//! The forces: the gradient of their potentials (simulation.md 2 and 3).
use fosssim_model::scene::{Collision, CollisionDetection, Force};
use fosssim_num::vector::{Vec2, at, length, over};

use super::{
    ForceMistake,
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
    match world.scene.collision {
        Collision::Penalty { stiffness: k, thickness: h, detection } => {
            penalty::add_gradient(world, PenaltyLayer { k, h, detection }, x, v, &mut g);
        }
        Collision::Hybrid { stiffness: k, thickness: h, .. } => {
            penalty::add_gradient(world, PenaltyLayer { k, h, detection: CollisionDetection::AllPairs }, x, v, &mut g);
        }
        _ => {}
    }
    g
}

impl Student {
    /// The value with the weight of the first of these mistakes that the student makes.
    pub fn weighted(self, value: Vec2, weights: &[(ForceMistake, f64)]) -> Vec2 {
        match weights.iter().find(|(mistake, _)| self.makes(*mistake)) {
            Some((_, weight)) => *weight * value,
            None => value,
        }
    }

    /// Adds opposite forces to the two particles: `push` is the gradient's part of the second one. The mistakes: only
    /// the first one gets it, only the second one does, both get the same.
    fn add_opposite(self, g: &mut [f64], (a, b): (usize, usize), push: Vec2, mistakes: [Option<ForceMistake>; 3]) {
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
            let last = count - usize::from(student.makes(ForceMistake::GravityLastMissing)).min(count);
            for i in 0..last {
                let mass = if student.makes(ForceMistake::GravityNoMass) { 1.0 } else { world.masses[2 * i] };
                let weights = [(ForceMistake::GravityMissing, 0.0), (ForceMistake::GravitySign, -1.0)];
                subtract(g, i, student.weighted(mass * acceleration, &weights));
            }
        }
        Force::Gravitation { first, second, constant } => gravitation(world, (first, second), constant, x, g),
        Force::Constant { force } => {
            for i in 0..count {
                let force = if student.makes(ForceMistake::ConstantMass) { world.masses[2 * i] * force } else { force };
                let weights = [(ForceMistake::ConstantMissing, 0.0), (ForceMistake::ConstantSign, -1.0)];
                subtract(g, i, student.weighted(force, &weights));
            }
        }
        Force::Drag { coefficient } => {
            for i in 0..count {
                let weights = [
                    (ForceMistake::DragMissing, 0.0),
                    (ForceMistake::DragSign, -1.0),
                    (ForceMistake::DragMass, world.masses[2 * i]),
                    (ForceMistake::DragQuadratic, length(at(v, i))),
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
    let makes = |mistake: ForceMistake| student.makes(mistake);
    let edge = world.scene.edges[edge];
    let (a, b) = (edge.first, edge.second);
    let d = at(x, b) - at(x, a);
    let l = length(d);
    let n = over(d, l);
    let is_long = makes(ForceMistake::SpringDirection) || makes(ForceMistake::SpringDirectionEverywhere);
    let along = if is_long || makes(ForceMistake::SpringElasticDirection) { d } else { n };
    let stiffness = if makes(ForceMistake::SpringNoStiffness) { 1.0 } else { stiffness };
    let stretch = match () {
        () if makes(ForceMistake::SpringNoRestLength) => l,
        () if makes(ForceMistake::SpringRestLengthSign) => l + rest_length,
        () if makes(ForceMistake::SpringStretchSquared) => 0.5 * (l - rest_length) * (l - rest_length),
        () => l - rest_length,
    };
    let weights = [
        (ForceMistake::SpringMissing, 0.0),
        (ForceMistake::SpringElasticMissing, 0.0),
        (ForceMistake::SpringElasticSign, -1.0),
        (ForceMistake::SpringElasticHalved, 0.5),
        (ForceMistake::SpringElasticDoubled, 2.0),
    ];
    let ends = [ForceMistake::SpringFirstOnly, ForceMistake::SpringSecondOnly, ForceMistake::SpringSameSign].map(Some);
    student.add_opposite(g, (a, b), student.weighted(stiffness * stretch * along, &weights), ends);

    let along = if is_long || makes(ForceMistake::SpringDampingDirection) { d } else { n };
    let damping = if makes(ForceMistake::SpringDampingNoCoefficient) { 1.0 } else { damping };
    let w = match () {
        () if makes(ForceMistake::SpringDampingOneVelocity) => at(v, b),
        () if makes(ForceMistake::SpringDampingVelocitySum) => at(v, b) + at(v, a),
        () => at(v, b) - at(v, a),
    };
    let damped =
        if makes(ForceMistake::SpringDampingAllDirections) { damping * w } else { damping * along.dot(&w) * along };
    let weights = [
        (ForceMistake::SpringMissing, 0.0),
        (ForceMistake::SpringDampingMissing, 0.0),
        (ForceMistake::SpringDampingSign, -1.0),
    ];
    let damped = student.weighted(damped, &weights);
    if makes(ForceMistake::SpringDampingFirstOnly) {
        subtract(g, a, damped);
    } else {
        student.add_opposite(g, (a, b), damped, ends);
    }
}

fn gravitation(world: &World, (first, second): (usize, usize), constant: f64, x: &[f64], g: &mut [f64]) {
    let student = world.student;
    let makes = |mistake: ForceMistake| student.makes(mistake);
    let d = at(x, second) - at(x, first);
    let r = length(d);
    let n = over(d, r);
    let constant = if makes(ForceMistake::GravitationNoConstant) { 1.0 } else { constant };
    let (m1, m2) = match () {
        () if makes(ForceMistake::GravitationNoMasses) => (1.0, 1.0),
        () if makes(ForceMistake::GravitationOwnMass) => (world.masses[2 * first], world.masses[2 * first]),
        () => (world.masses[2 * second], world.masses[2 * first]),
    };
    let distances = match () {
        () if makes(ForceMistake::GravitationDistanceOnce) => r,
        () if makes(ForceMistake::GravitationDistanceCubed) => r * r * r,
        () => r * r,
    };
    let weights = [(ForceMistake::GravitationMissing, 0.0), (ForceMistake::GravitationSign, -1.0)];
    let ends =
        [ForceMistake::GravitationFirstOnly, ForceMistake::GravitationSecondOnly, ForceMistake::GravitationSameSign];
    let pull = student.weighted(constant * m1 * m2 / distances * n, &weights);
    student.add_opposite(g, (first, second), pull, ends.map(Some));
}

fn vortex(world: &World, force: &Force, x: &[f64], v: &[f64], g: &mut [f64]) {
    let Force::Vortex { first, second, strength, coupling } = *force else { return };
    let student = world.student;
    let makes = |mistake: ForceMistake| student.makes(mistake);
    let d = at(x, second) - at(x, first);
    let r = length(d);
    let n = if makes(ForceMistake::VortexDirection) { d } else { over(d, r) };
    let along = strength * n;
    let turning = match () {
        () if makes(ForceMistake::VortexTurn) => Vec2::new(along.y, -along.x),
        () if makes(ForceMistake::VortexAlong) => along,
        () => Vec2::new(-along.y, along.x),
    };
    let w = at(v, second) - at(v, first);
    let weights = [(ForceMistake::VortexNoVelocity, 0.0), (ForceMistake::VortexVelocitySign, -1.0)];
    let around = turning - student.weighted(w, &weights);
    let shared = match () {
        () if makes(ForceMistake::VortexDistanceOnce) => over(around, r),
        () if makes(ForceMistake::VortexNoDistance) => around,
        () if makes(ForceMistake::VortexStrengthDivided) => over(turning, r * r) - w,
        () => over(around, r * r),
    };
    let weights = [(ForceMistake::VortexMissing, 0.0), (ForceMistake::VortexSign, -1.0)];
    let push = student.weighted(coupling * shared, &weights);
    let ends = [Some(ForceMistake::VortexFirstOnly), None, Some(ForceMistake::VortexSameSign)];
    student.add_opposite(g, (first, second), -push, ends);
}
