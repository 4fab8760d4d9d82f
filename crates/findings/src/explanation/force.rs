//! Wrong terms in the sum of the forces, where it can be read back from a trace.
use serde::{Deserialize, Serialize};

/// A term of the sum of all forces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum ForceTerm {
    /// The elastic part of springs.
    SpringElastic,
    /// The damping of springs.
    SpringDamping,
    /// Simple gravity.
    Gravity,
    /// The gravitational force.
    Gravitation,
    /// The constant force.
    Constant,
    /// Drag.
    Drag,
    /// The vortex force.
    Vortex,
    /// The penalty force between particles.
    PenaltyParticles,
    /// The penalty force of edges.
    PenaltyEdges,
    /// The penalty force of half-planes.
    PenaltyHalfPlanes,
}

impl ForceTerm {
    /// All terms, in the order in which they act.
    pub const ALL: [Self; 10] = [
        Self::SpringElastic,
        Self::SpringDamping,
        Self::Gravity,
        Self::Gravitation,
        Self::Constant,
        Self::Drag,
        Self::Vortex,
        Self::PenaltyParticles,
        Self::PenaltyEdges,
        Self::PenaltyHalfPlanes,
    ];
}

/// A term's weight, as far as a sentence tells it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum WrongWeight {
    /// It is missing.
    Zero,
    /// It has the wrong sign.
    MinusOne,
    /// It is there twice.
    Two,
    /// It is there by half.
    Half,
    /// It carries another factor.
    Other,
}
