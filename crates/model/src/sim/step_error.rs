//! The reasons why a step has no result.
use super::pair::Pair;
use serde::{Deserialize, Serialize};

/// The reason why a step has no result. The original hangs or continues with garbage in this case.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, thiserror::Error)]
pub enum StepError {
    /// The root search of a pair would never end, because its polynomials contain values that are not finite.
    #[error("step {step}: the root search of this pair does not terminate")]
    RootSearch {
        /// The step, from 1.
        step: u32,
        /// The pair whose detection failed.
        pair: Pair,
    },
    /// Newton's method of implicit-euler does not converge (or cycles).
    #[error("step {step}: Newton's method does not converge")]
    Newton {
        /// The step, from 1.
        step: u32,
    },
    /// A vortex force has no Hessian, which implicit integrators need (scene-format.md 6).
    #[error("step {step}: vortexforce has no Hessian, so it can't be used with an implicit integrator")]
    VortexHessian {
        /// The step, from 1.
        step: u32,
    },
    /// The step needs more work than allowed ([`Simulation::limit_work`](super::Simulation::limit_work)).
    #[error("step {step}: collision handling needs more work than allowed; a normal run of the scene needs far less")]
    Work {
        /// The step, from 1.
        step: u32,
    },
}

impl StepError {
    /// Returns the step, from 1.
    pub const fn step(&self) -> u32 {
        match *self {
            Self::RootSearch { step, .. }
            | Self::Newton { step }
            | Self::VortexHessian { step }
            | Self::Work { step } => step,
        }
    }
}
