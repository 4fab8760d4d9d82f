//! The pairs whose penalty forces are added, and their order.
//!
//! The default is the order of a detection pass (collisions.md 1). In the contest (Theme 2, Milestone 3) the original
//! searches for nearby pairs ([`Sweep`]), and adds the forces of pairs of particles, then those of particles with
//! edges, then those of particles with half-planes.
use super::sweep::{Sweep, SweepOrder};
use crate::{
    scene::{CollisionDetection, Scene},
    sim::{
        nearby::{NearbyPairs, is_beyond},
        pair::{Pair, PairKind, pair},
        pairs::{ObjectCounts, PassCursor, is_end},
    },
};
use fosssim_num::vector::{Vec2, vector_at};

/// The pairs of a scene's penalty force, with the memory to find nearby pairs.
#[derive(Debug, Clone)]
pub struct PenaltyPairs {
    radii: Vec<f64>,
    edges: Vec<[usize; 2]>,
    half_planes: usize,
    thickness: f64,
    nearby: Option<NearbyPairs>,
    sweep: Option<Box<Sweep>>,
}

impl PenaltyPairs {
    /// Creates the pairs for the bodies of a scene and the given thickness.
    pub fn new(scene: &Scene, thickness: f64, detection: CollisionDetection) -> Self {
        let is_contest = detection == CollisionDetection::Contest;
        Self {
            radii: scene.particles.iter().map(|particle| particle.radius).collect(),
            edges: scene.edges.iter().map(|edge| [edge.first, edge.second]).collect(),
            half_planes: scene.half_planes.len(),
            thickness,
            nearby: if is_contest { None } else { NearbyPairs::for_large_scene(scene, thickness) },
            sweep: is_contest.then(|| Box::new(Sweep::new(scene))),
        }
    }

    /// Copies the order of a contest's last search into `order`. Returns false for other scenes.
    pub fn copy_order(&self, order: &mut SweepOrder) -> bool {
        self.sweep.as_ref().map(|sweep| sweep.copy_order(order)).is_some()
    }

    /// Continues from `order`, in a contest.
    pub fn set_order(&mut self, order: &SweepOrder) {
        if let Some(sweep) = &mut self.sweep {
            sweep.set_order(order);
        }
    }

    /// Calls `visit` for all pairs that may be closer at positions `x` (2N) than the sum of their radii and the
    /// thickness, in the order in which their forces are added. In large scenes few other pairs are included.
    pub fn visit_pairs(&mut self, x: &[f64], mut visit: impl FnMut(Pair)) {
        let particle_count = self.radii.len();
        let edges = &self.edges;
        let objects = ObjectCounts { particles: particle_count, edges: edges.len(), half_planes: self.half_planes };
        let row = |i: usize| objects.remaining_row(PassCursor::from_first(i));
        let edges_of = |i: usize| (0..edges.len()).filter(move |&edge| !is_end(edges[edge], i));
        if let Some(sweep) = &mut self.sweep {
            sweep.update(x);
            sweep.visit_particles(|i, j| visit(pair(PairKind::ParticleParticle, i, j)));
            sweep.visit_edges(|i, edge| visit(pair(PairKind::ParticleEdge, i, edge)));
            for i in 0..particle_count {
                let [.., half_planes] = row(i);
                half_planes.for_each(|half_plane| visit(pair(PairKind::ParticleHalfPlane, i, half_plane)));
            }
            return;
        }
        let mut found = self.nearby.as_mut().and_then(|nearby| nearby.find(x));
        for i in 0..particle_count {
            let [others, _, half_planes] = row(i);
            if let Some(found) = &mut found {
                let [others, edges] = found.next(i);
                others.for_each(|j| visit(pair(PairKind::ParticleParticle, i, j)));
                edges.for_each(|edge| visit(pair(PairKind::ParticleEdge, i, edge)));
            } else {
                // Nearly all other pairs are out of reach, which is tested with as few instructions as possible.
                let (own, radius) = (vector_at(x, i), self.radii[i]);
                let bodies = x.as_chunks::<2>().0[others.clone()].iter().zip(&self.radii[others.clone()]);
                for (j, (&other, other_radius)) in others.zip(bodies) {
                    if !is_beyond(Vec2::from(other) - own, (radius + other_radius) + self.thickness) {
                        visit(pair(PairKind::ParticleParticle, i, j));
                    }
                }
                edges_of(i).for_each(|edge| visit(pair(PairKind::ParticleEdge, i, edge)));
            }
            half_planes.for_each(|half_plane| visit(pair(PairKind::ParticleHalfPlane, i, half_plane)));
        }
    }
}
