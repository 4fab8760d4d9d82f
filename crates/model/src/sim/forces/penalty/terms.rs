//! The penalty force as separate terms, one per pair.
use super::Penalty;
use crate::{
    scene::{Collision, Scene},
    sim::{
        bodies::Bodies,
        pair::{Pair, PairKind},
    },
};
use fosssim_num::vector::{Vec2, set_vector, vector_at};

/// The terms of a scene's penalty force, which a step adds.
#[derive(Debug, Clone)]
pub struct PenaltyTerms {
    bodies: Bodies,
    penalty: Penalty,
    gradient: Vec<f64>,
}

impl PenaltyTerms {
    /// Returns the terms of a scene with `penalty` handling, or `None` for other scenes.
    pub fn for_scene(scene: &Scene) -> Option<Self> {
        let Collision::Penalty { stiffness, thickness, detection } = scene.collision else { return None };
        let gradient = vec![0.0; 2 * scene.particles.len()];
        Some(Self {
            bodies: Bodies::new(scene),
            penalty: Penalty::new(scene, stiffness, thickness, detection),
            gradient,
        })
    }

    /// Calls `visit` for every pair that repels at positions `x` (2N), with the force on each of its particles.
    pub fn visit_pairs(&mut self, x: &[f64], mut visit: impl FnMut(Pair, &[(usize, Vec2)])) {
        let Self { bodies, penalty: Penalty { parameters: law, pairs }, gradient } = self;
        pairs.visit_pairs(x, |pair| {
            let count = match pair.kind {
                PairKind::ParticleParticle => 2,
                PairKind::ParticleEdge => 3,
                PairKind::ParticleHalfPlane => 1,
            };
            let mut terms = bodies.pair_particles(pair).map(|particle| (particle, Vec2::zeros()));
            let terms = &mut terms[..count];
            terms.iter().for_each(|(particle, _)| set_vector(gradient, *particle, Vec2::zeros()));
            law.add(bodies, pair, x, gradient);
            terms.iter_mut().for_each(|(particle, force)| *force = -1.0 * vector_at(gradient, *particle));
            if terms.iter().any(|(_, force)| *force != Vec2::zeros()) {
                visit(pair, terms);
            }
        });
    }
}
