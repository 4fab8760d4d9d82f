//! The kinds of forces (simulation.md 3).

/// A kind of force. How it is written in scenes stands with the scenes' readers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ForceKind {
    /// A spring along an edge, with damping.
    Spring,
    /// One acceleration for every particle.
    SimpleGravity,
    /// The attraction of two particles by their masses.
    Gravitation,
    /// One force on every particle.
    Constant,
    /// Drag against each particle's velocity.
    Drag,
    /// A pair of particles that turn around each other.
    Vortex,
}

impl ForceKind {
    /// All kinds, in the order in which they act.
    pub const ALL: [Self; 6] =
        [Self::Spring, Self::SimpleGravity, Self::Gravitation, Self::Constant, Self::Drag, Self::Vortex];
}
