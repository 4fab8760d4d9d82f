//! The kinds of forces (simulation.md 3).
use serde::{Deserialize, Serialize};

fosssim_num::closed_set! {
    /// A kind of force. The scene readers define how it is written in a scene.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    pub enum ForceKind {
        /// A spring along an edge, with damping.
        Spring = "spring force",
        /// A uniform acceleration, the same for every particle.
        SimpleGravity = "simple gravity",
        /// The attraction of two particles by their masses.
        Gravitation = "gravitational force",
        /// A constant force, the same on every particle.
        Constant = "constant force",
        /// Drag against each particle's velocity.
        Drag = "drag force",
        /// A pair of particles that turn around each other.
        Vortex = "vortex force",
    }
}
