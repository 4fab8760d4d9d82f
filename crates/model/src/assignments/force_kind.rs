//! The kinds of forces (simulation.md 3).
use serde::{Deserialize, Serialize};

fosssim_num::closed_set! {
    /// A kind of force. The scene readers define how it is written in a scene.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    pub enum ForceKind {
        /// A spring along an edge, with damping.
        Spring,
        /// A uniform acceleration, the same for every particle.
        SimpleGravity,
        /// The attraction of two particles by their masses.
        Gravitation,
        /// A constant force, the same on every particle.
        Constant,
        /// Drag against each particle's velocity.
        Drag,
        /// A pair of particles that turn around each other.
        Vortex,
    }
}
