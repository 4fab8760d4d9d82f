//! The kinds of pairs that detections check (collisions.md 1).
use serde::{Deserialize, Serialize};

fosssim_num::closed_set! {
    /// The kind of a pair. The numbers are those of the trace format.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, schemars::JsonSchema)]
    #[serde(rename_all = "kebab-case")]
    pub enum PairKind {
        /// A pair of two particles (number 0).
        ParticleParticle = "particle-particle", "pp";
        /// A pair of a particle and an edge (number 1).
        ParticleEdge = "particle-edge", "pe";
        /// A pair of a particle and a half-plane (number 2).
        ParticleHalfPlane = "particle-half-plane", "ph";
    }
    /// Returns the kind's short name, which command lines and keys use, such as `pe`.
    short
}

impl PairKind {
    /// Returns the number of polynomials that a detection call of this kind logs: 2, 4 or 2 in the order of the kinds.
    pub const fn polynomial_count(self) -> usize {
        match self {
            Self::ParticleEdge => 4,
            Self::ParticleParticle | Self::ParticleHalfPlane => 2,
        }
    }

    /// Returns the number of coefficients of each polynomial before small leading ones are dropped, or 0 for a missing
    /// polynomial.
    pub const fn coefficient_counts(self) -> [usize; Self::MAX_POLYNOMIALS] {
        match self {
            Self::ParticleEdge => [5, 3, 3, 6],
            Self::ParticleParticle | Self::ParticleHalfPlane => [3, 2, 0, 0],
        }
    }

    /// Returns the number of the kind in a trace.
    pub const fn code(self) -> i32 {
        self as i32
    }

    /// The maximum number of polynomials that a detection call logs.
    pub const MAX_POLYNOMIALS: usize = 4;

    /// Returns the kind's index in [`PairKind::ALL`].
    #[inline]
    pub const fn index(self) -> usize {
        self as usize
    }

    /// Returns the kind with number `code` in a trace, or `None` for the numbers of a damaged trace.
    pub fn from_code(code: i32) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.code() == code)
    }

    /// Returns the name of the second object's kind, such as `edge`.
    pub const fn second_name(self) -> &'static str {
        match self {
            Self::ParticleParticle => "particle",
            Self::ParticleEdge => "edge",
            Self::ParticleHalfPlane => "half-plane",
        }
    }

    /// Returns the original's name for the second object (oracle-behavior.md 6.1).
    pub const fn original_second_name(self) -> &'static str {
        match self {
            Self::ParticleParticle => "Particle",
            Self::ParticleEdge => "Edge",
            Self::ParticleHalfPlane => "Halfplane",
        }
    }
}
