//! The polynomials that a detection computes.
use fosssim_model::sim::PairKind;
use serde::{Deserialize, Serialize};

fosssim_num::closed_set! {
    /// A polynomial of a detection: the kind of pair, and the condition that it describes (collisions.md 2).
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
    pub enum Subject {
        /// Two particles overlap.
        ParticleOverlap = "particle-particle overlap",
        /// Two particles approach each other.
        ParticleApproach = "particle-particle approach",
        /// A particle overlaps the line through an edge.
        EdgeOverlap = "particle-edge overlap",
        /// The closest point on the line is after the edge's first endpoint.
        AlphaLow = "particle-edge alpha > 0",
        /// The closest point on the line is before the edge's second endpoint.
        AlphaHigh = "particle-edge alpha < 1",
        /// A particle and an edge approach each other.
        EdgeApproach = "particle-edge approach",
        /// A particle overlaps the boundary of a half-plane.
        HalfPlaneOverlap = "particle-half-plane overlap",
        /// A particle and a half-plane approach each other.
        HalfPlaneApproach = "particle-half-plane approach",
    }
}

impl Subject {
    /// Returns the polynomials of one kind of pair, in the order of the trace.
    pub const fn all_of_kind(kind: PairKind) -> &'static [Self] {
        match kind {
            PairKind::ParticleParticle => &[Self::ParticleOverlap, Self::ParticleApproach],
            PairKind::ParticleEdge => &[Self::EdgeOverlap, Self::AlphaLow, Self::AlphaHigh, Self::EdgeApproach],
            PairKind::ParticleHalfPlane => &[Self::HalfPlaneOverlap, Self::HalfPlaneApproach],
        }
    }

    /// Returns the kind of pair that the polynomial belongs to.
    pub const fn kind(self) -> PairKind {
        match self {
            Self::ParticleOverlap | Self::ParticleApproach => PairKind::ParticleParticle,
            Self::EdgeOverlap | Self::AlphaLow | Self::AlphaHigh | Self::EdgeApproach => PairKind::ParticleEdge,
            Self::HalfPlaneOverlap | Self::HalfPlaneApproach => PairKind::ParticleHalfPlane,
        }
    }

    /// Returns the degree of the polynomial.
    pub const fn degree(self) -> usize {
        match self {
            Self::ParticleApproach | Self::HalfPlaneApproach => 1,
            Self::ParticleOverlap | Self::AlphaLow | Self::AlphaHigh | Self::HalfPlaneOverlap => 2,
            Self::EdgeOverlap => 4,
            Self::EdgeApproach => 5,
        }
    }
}
