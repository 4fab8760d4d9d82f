//! The penalty force, which `penalty` and `hybrid` scenes add to the others (simulation.md 3).
use fosssim_model::{
    scene::CollisionDetection,
    sim::{PairKind, PenaltyPairs},
};
use fosssim_num::vector::{at, length, unit};

use super::world::{World, add, subtract};

/// The layer around bodies that repels others.
#[derive(Clone, Copy)]
pub struct PenaltyLayer {
    /// Stiffness.
    pub k: f64,
    /// Thickness.
    pub h: f64,
    /// How pairs are found, which orders the sum. In the contest bodies at the same place leave each other alone.
    pub detection: CollisionDetection,
}

impl PenaltyLayer {
    fn repels(self, distance: f64, reach: f64) -> bool {
        distance < reach && !(self.detection == CollisionDetection::Contest && distance == 0.0)
    }
}

/// Adds the gradient of the penalty force. Pairs out of its reach add nothing, so that a program may leave them out.
pub fn add_gradient(world: &World, layer: PenaltyLayer, x: &[f64], g: &mut [f64]) {
    PenaltyPairs::new(&world.scene, layer.h, layer.detection).visit(x, |pair| {
        let both = (pair.first as usize, pair.second as usize);
        match pair.kind {
            PairKind::ParticleParticle => particle_particle(world, layer, both, x, g),
            PairKind::ParticleEdge => particle_edge(world, layer, both, x, g),
            PairKind::ParticleHalfPlane => particle_half_plane(world, layer, both, x, g),
        }
    });
}

fn particle_particle(world: &World, layer: PenaltyLayer, (i, j): (usize, usize), x: &[f64], g: &mut [f64]) {
    let PenaltyLayer { k, h, .. } = layer;
    let (first, second) = (world.scene.particles[i].radius, world.scene.particles[j].radius);
    let n = at(x, j) - at(x, i);
    let distance = length(n);
    if layer.repels(distance, first + second + h) {
        // In the contest the original's direction is normalised twice.
        let u = if layer.detection == CollisionDetection::Contest { unit(unit(n)) } else { unit(n) };
        let push = k * (distance - first - second - h) * u;
        subtract(g, i, push);
        add(g, j, push);
    }
}

fn particle_edge(world: &World, layer: PenaltyLayer, (i, edge): (usize, usize), x: &[f64], g: &mut [f64]) {
    let PenaltyLayer { k, h, .. } = layer;
    let edge = world.scene.edges[edge];
    let radius = world.scene.particles[i].radius;
    let (x1, x2, x3) = (at(x, i), at(x, edge.first), at(x, edge.second));
    let alpha = (x1 - x2).dot(&(x3 - x2)) / (x3 - x2).dot(&(x3 - x2));
    // A NaN stays one here, unlike in the responses.
    let alpha = alpha.clamp(0.0, 1.0);
    let n = x2 + alpha * (x3 - x2) - x1;
    let distance = length(n);
    if layer.repels(distance, radius + edge.radius + h) {
        let depth = distance - radius - edge.radius - h;
        let u = unit(n);
        subtract(g, i, k * depth * u);
        add(g, edge.first, k * (1.0 - alpha) * depth * u);
        add(g, edge.second, k * alpha * depth * u);
    }
}

fn particle_half_plane(world: &World, layer: PenaltyLayer, (i, plane): (usize, usize), x: &[f64], g: &mut [f64]) {
    let PenaltyLayer { k, h, .. } = layer;
    let plane = world.scene.half_planes[plane];
    let radius = world.scene.particles[i].radius;
    let q = plane.normal;
    let n = (plane.point - at(x, i)).dot(&q) / q.dot(&q) * q;
    let distance = length(n);
    if layer.repels(distance, radius + h) {
        subtract(g, i, k * (distance - radius - h) * unit(n).dot(&q) / q.dot(&q) * q);
    }
}
