//! How the two objects of a detection move.
use fosssim_judge::fair::formulas::{self, BoundedPointMotion};
use fosssim_model::sim::PairKind;
use fosssim_num::{
    bounded::{Bounded, Bounded2},
    vector::Vec2,
};

/// A point on its even way through the step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Where it is at the start of the step (`q_start`), in the scene's length unit.
    pub start: Vec2,
    /// How far it goes within the step (`q_end - q_start`).
    pub displacement: Vec2,
}

/// The two objects of a detection and how they move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motion {
    /// Two particles.
    Particles {
        /// The first and the second particle.
        bodies: [Body; 2],
        /// The radius of each.
        radii: [f64; 2],
    },
    /// A particle and an edge.
    Edge {
        /// The particle, the edge's first and its second endpoint.
        bodies: [Body; 3],
        /// The particle's and the edge's radius.
        radii: [f64; 2],
    },
    /// A particle and a half-plane.
    HalfPlane {
        /// The particle.
        body: Body,
        /// The particle's radius.
        radius: f64,
        /// A point on the boundary.
        point: Vec2,
        /// The normal as the scene gives it, of any length.
        normal: Vec2,
    },
}

impl Motion {
    /// The kind of the pair.
    #[must_use]
    pub const fn kind(&self) -> PairKind {
        match self {
            Self::Particles { .. } => PairKind::ParticleParticle,
            Self::Edge { .. } => PairKind::ParticleEdge,
            Self::HalfPlane { .. } => PairKind::ParticleHalfPlane,
        }
    }
}

/// The way of a point as the fair rules see it. The displacement's value is the sample's, its bound that of a
/// difference of positions.
pub(super) fn way(body: &Body) -> BoundedPointMotion {
    let (start, end) = (Bounded2::exact(body.start), body.start + body.displacement);
    let mut shift = Bounded2::rounded(end) - start;
    (shift.x.value, shift.y.value) = (body.displacement.x, body.displacement.y);
    BoundedPointMotion { start, shift }
}

impl Motion {
    /// The motion as the fair rules see it, whose formulas say what is right.
    pub(crate) fn judged(&self) -> formulas::BoundedPairMotion {
        match self {
            Self::Particles { bodies, radii } => {
                formulas::BoundedPairMotion::Particles(bodies.each_ref().map(way), sum(radii))
            }
            Self::Edge { bodies, radii } => formulas::BoundedPairMotion::Edge(bodies.each_ref().map(way), sum(radii)),
            Self::HalfPlane { body, radius, point, normal } => {
                formulas::BoundedPairMotion::HalfPlane(way(body), Bounded::exact(*radius), *point, *normal)
            }
        }
    }
}

fn sum(radii: &[f64; 2]) -> Bounded {
    Bounded::exact(radii[0]) + Bounded::exact(radii[1])
}
