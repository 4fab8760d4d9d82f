//! The scene's constants as one array per attribute.
//!
//! Nothing in them changes during a simulation. Particles, edges and half-planes keep their document order, which is
//! the order of every loop over them (simulation.md 1).
use super::{
    pair::{Pair, PairKind},
    pairs::ObjectCounts,
};
use crate::scene::Scene;
use fosssim_num::vector::Vec2;

/// Masses, radii, flags, edges and half-planes.
#[derive(Debug, Clone)]
pub(super) struct Bodies {
    /// The mass of each particle, as written.
    pub masses: Vec<f64>,
    /// The mass of each particle for responses. A fixed particle has an infinite mass (collisions.md 3).
    pub response_masses: Vec<f64>,
    /// The radius of each particle.
    pub radii: Vec<f64>,
    /// Whether a particle is fixed.
    pub fixed: Vec<bool>,
    /// The first and the second endpoint of each edge.
    pub edges: Vec<[usize; 2]>,
    /// The radius of each edge.
    pub edge_radii: Vec<f64>,
    /// A boundary point of each half-plane.
    pub points: Vec<Vec2>,
    /// The normal of each half-plane, as written.
    pub normals: Vec<Vec2>,
}

impl Bodies {
    /// Copies the scene's constants.
    ///
    /// # Panics
    /// Panics if an edge names a particle that the scene does not have; the strict reader rejects such scenes.
    pub fn new(scene: &Scene) -> Self {
        let particles = &scene.particles;
        for (index, edge) in scene.edges.iter().enumerate() {
            assert!(
                edge.first < particles.len() && edge.second < particles.len(),
                "edge {index} has an endpoint that is not a particle"
            );
        }
        Self {
            masses: particles.iter().map(|p| p.mass).collect(),
            response_masses: particles.iter().map(|p| if p.fixed { f64::INFINITY } else { p.mass }).collect(),
            radii: particles.iter().map(|p| p.radius).collect(),
            fixed: particles.iter().map(|p| p.fixed).collect(),
            edges: scene.edges.iter().map(|e| [e.first, e.second]).collect(),
            edge_radii: scene.edges.iter().map(|e| e.radius).collect(),
            points: scene.half_planes.iter().map(|h| h.point).collect(),
            normals: scene.half_planes.iter().map(|h| h.normal).collect(),
        }
    }

    /// Returns the number of particles N.
    pub fn particle_count(&self) -> usize {
        self.masses.len()
    }

    /// Returns the number of objects of each kind.
    #[inline]
    pub fn object_counts(&self) -> ObjectCounts {
        ObjectCounts { particles: self.particle_count(), edges: self.edges.len(), half_planes: self.points.len() }
    }

    /// Returns the particles of a pair. If there are fewer than three, the last one is repeated.
    pub fn pair_particles(&self, pair: Pair) -> [usize; 3] {
        let (first, second) = (pair.first as usize, pair.second as usize);
        match pair.kind {
            PairKind::ParticleParticle => [first, second, second],
            PairKind::ParticleEdge => [first, self.edges[second][0], self.edges[second][1]],
            PairKind::ParticleHalfPlane => [first; 3],
        }
    }

    /// Estimates the number of pairs in a pass.
    pub fn estimate_pair_count(&self) -> usize {
        self.particle_count() * (self.particle_count() / 2 + self.edges.len() + self.points.len())
    }

    /// Writes +0 into both entries of every fixed particle of an array in trace order.
    pub fn zero_fixed(&self, array: &mut [f64]) {
        for (index, &fixed) in self.fixed.iter().enumerate() {
            if fixed {
                array[2 * index] = 0.0;
                array[2 * index + 1] = 0.0;
            }
        }
    }
}
