//! The forces: the gradient of their potentials (simulation.md 2 and 3).
use fosssim_model::scene::{Collision, CollisionDetection, Force};
use fosssim_num::vector::{Vec2, at, length, over};

use super::{
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
            penalty::add_gradient(world, PenaltyLayer { k, h, detection }, x, &mut g);
        }
        Collision::Hybrid { stiffness: k, thickness: h, .. } => {
            penalty::add_gradient(world, PenaltyLayer { k, h, detection: CollisionDetection::AllPairs }, x, &mut g);
        }
        _ => {}
    }
    g
}

fn add_gradient(world: &World, force: &Force, x: &[f64], v: &[f64], g: &mut [f64]) {
    let count = world.scene.particles.len();
    match *force {
        Force::Spring { edge, stiffness, rest_length, damping } => {
            let edge = world.scene.edges[edge];
            let (a, b) = (edge.first, edge.second);
            let d = at(x, b) - at(x, a);
            let l = length(d);
            let n = over(d, l);
            let elastic = stiffness * (l - rest_length) * n;
            subtract(g, a, elastic);
            add(g, b, elastic);
            let damped = damping * n.dot(&(at(v, b) - at(v, a))) * n;
            subtract(g, a, damped);
            add(g, b, damped);
        }
        Force::SimpleGravity { acceleration } => {
            for i in 0..count {
                subtract(g, i, world.masses[2 * i] * acceleration);
            }
        }
        Force::Gravitation { first, second, constant } => {
            let d = at(x, second) - at(x, first);
            let r = length(d);
            let n = over(d, r);
            let pull = constant * world.masses[2 * second] * world.masses[2 * first] / (r * r) * n;
            subtract(g, first, pull);
            add(g, second, pull);
        }
        Force::Constant { force } => {
            for i in 0..count {
                subtract(g, i, force);
            }
        }
        Force::Drag { coefficient } => {
            for i in 0..count {
                add(g, i, coefficient * at(v, i));
            }
        }
        Force::Vortex { first, second, strength, coupling } => {
            let d = at(x, second) - at(x, first);
            let r = length(d);
            let n = over(d, r);
            let along = strength * n;
            let around = Vec2::new(-along.y, along.x) - (at(v, second) - at(v, first));
            let push = coupling * over(around, r * r);
            subtract(g, first, -push);
            add(g, second, -push);
        }
    }
}
