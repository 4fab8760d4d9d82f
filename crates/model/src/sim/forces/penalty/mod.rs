//! The penalty force, which repels all bodies closer than the thickness (simulation.md 3, penalty force).
//!
//! Its Hessians count as zero, as in the original. There is no guard against zero distance: the direction is then NaN,
//! and enters the gradient if the distance test is passed. Only the contest's detection has a guard.
//!
//! Each detection adds the forces of the pairs in a specific order ([`PenaltyPairs`]).
mod extent;
mod introsort;
mod pairs;
mod rows;
mod sweep;
mod terms;
#[cfg(test)]
mod tests;

use super::{add, subtract};
use crate::{
    scene::{CollisionDetection, Scene},
    sim::{
        bodies::Bodies,
        nearby::is_beyond,
        pair::{Pair, PairKind},
    },
};
use fosssim_num::{
    tolerances::CONTEST_MIN_DISTANCE,
    vector::{length, unit, vector_at},
};
pub use pairs::PenaltyPairs;
pub use sweep::SweepOrder;
pub use terms::PenaltyTerms;

/// The penalty force of a scene, with the memory to find nearby pairs.
#[derive(Debug, Clone)]
pub(super) struct Penalty {
    parameters: PenaltyParameters,
    pairs: PenaltyPairs,
}

/// The stiffness (force per length) and the thickness (length) of the layer around every body.
#[derive(Debug, Clone, Copy)]
struct PenaltyParameters {
    /// The stiffness `k`.
    stiffness: f64,
    /// The thickness `h`.
    thickness: f64,
    /// Whether the force is that of Theme 2, Milestone 3 (simulation.md 3.1): bodies at the same position do not repel
    /// each other, particles compare squared lengths, and the direction between them is normalized twice.
    is_contest: bool,
}

impl Penalty {
    /// Creates the force between the bodies of a scene.
    pub fn new(scene: &Scene, stiffness: f64, thickness: f64, detection: CollisionDetection) -> Self {
        let is_contest = detection == CollisionDetection::Contest;
        let pairs = PenaltyPairs::new(scene, thickness, detection);
        Self { parameters: PenaltyParameters { stiffness, thickness, is_contest }, pairs }
    }

    /// Returns the penalty force's pairs.
    pub fn pairs(&mut self) -> &mut PenaltyPairs {
        &mut self.pairs
    }

    /// Adds the gradient, pair by pair.
    pub fn add_gradient(&mut self, bodies: &Bodies, x: &[f64], gradient: &mut [f64]) {
        let law = self.parameters;
        self.pairs.visit_pairs(x, |pair| law.add(bodies, pair, x, gradient));
    }
}

impl PenaltyParameters {
    /// Adds a pair's part to the gradient.
    #[inline]
    fn add(self, bodies: &Bodies, pair: Pair, x: &[f64], gradient: &mut [f64]) {
        let (first, second) = (pair.first as usize, pair.second as usize);
        match pair.kind {
            PairKind::ParticleParticle => self.particle_particle(bodies, first, second, x, gradient),
            PairKind::ParticleEdge => self.particle_edge(bodies, first, second, x, gradient),
            PairKind::ParticleHalfPlane => self.particle_half_plane(bodies, first, second, x, gradient),
        }
    }

    /// Returns whether bodies at `distance` repel each other, if the force acts at distances below `reach`.
    #[inline]
    fn repels(self, distance: f64, reach: f64) -> bool {
        distance < reach && !(self.is_contest && distance < CONTEST_MIN_DISTANCE)
    }

    fn particle_particle(self, bodies: &Bodies, i: usize, j: usize, x: &[f64], gradient: &mut [f64]) {
        let n = vector_at(x, j) - vector_at(x, i);
        let (r1, r2) = (bodies.radii[i], bodies.radii[j]);
        let reach = (r1 + r2) + self.thickness;
        let l = length(n);
        // In the contest a NaN length repels, but its square compares false.
        let repels = if self.is_contest { n.dot(&n) < reach * reach && !(l < CONTEST_MIN_DISTANCE) } else { l < reach };
        if repels {
            let u = if self.is_contest { unit(unit(n)) } else { unit(n) };
            let s = self.stiffness * (((l - r1) - r2) - self.thickness);
            subtract(gradient, i, s * u);
            add(gradient, j, s * u);
        }
    }

    #[inline]
    fn particle_edge(self, bodies: &Bodies, i: usize, edge: usize, x: &[f64], gradient: &mut [f64]) {
        let [first, second] = bodies.edges[edge];
        let (x1, x2, x3) = (vector_at(x, i), vector_at(x, first), vector_at(x, second));
        let x32 = x3 - x2;
        // `f64::clamp` keeps NaN. `response::clamp` returns 0 for NaN.
        let alpha = ((x1 - x2).dot(&x32) / x32.dot(&x32)).clamp(0.0, 1.0);
        let n = (x2 + alpha * x32) - x1;
        let (r1, r2) = (bodies.radii[i], bodies.edge_radii[edge]);
        let reach = (r1 + r2) + self.thickness;
        if is_beyond(n, reach) {
            return;
        }
        let l = length(n);
        if self.repels(l, reach) {
            let u = unit(n);
            let depth = ((l - r1) - r2) - self.thickness;
            let k = self.stiffness;
            subtract(gradient, i, (k * depth) * u);
            add(gradient, first, ((k * (1.0 - alpha)) * depth) * u);
            add(gradient, second, ((k * alpha) * depth) * u);
        }
    }

    #[inline]
    fn particle_half_plane(self, bodies: &Bodies, i: usize, half_plane: usize, x: &[f64], gradient: &mut [f64]) {
        let (p, q) = (bodies.points[half_plane], bodies.normals[half_plane]);
        let squared = q.dot(&q);
        let n = ((p - vector_at(x, i)).dot(&q) / squared) * q;
        let r = bodies.radii[i];
        let reach = r + self.thickness;
        if is_beyond(n, reach) {
            return;
        }
        let l = length(n);
        if self.repels(l, reach) {
            let u = unit(n);
            let s = self.stiffness * ((l - r) - self.thickness) * u.dot(&q) / squared;
            subtract(gradient, i, s * q);
        }
    }
}
