//! The time integrators of scenes (scene-format.md 4).
use serde::{Deserialize, Serialize};

fosssim_num::closed_set! {
    /// A time integrator (simulation.md 4), with its name in scenes.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    pub enum Integrator {
        /// Positions and velocities are computed only from the start of the step.
        ExplicitEuler = "explicit-euler",
        /// Velocities are advanced first; positions then use the new velocities.
        ForwardBackwardEuler = "forward-backward-euler",
        /// Another name for [`Integrator::ForwardBackwardEuler`], whose name is printed for both.
        SymplecticEuler = "symplectic-euler",
        /// Every step uses Newton's method until it converges.
        ImplicitEuler = "implicit-euler",
        /// Every step uses one iteration of Newton's method.
        LinearizedImplicitEuler = "linearized-implicit-euler",
    }
}

impl Integrator {
    /// Returns whether the integrator solves a system of equations in every step.
    pub const fn is_implicit(self) -> bool {
        match self {
            Self::ImplicitEuler | Self::LinearizedImplicitEuler => true,
            Self::ExplicitEuler | Self::ForwardBackwardEuler | Self::SymplecticEuler => false,
        }
    }
}
