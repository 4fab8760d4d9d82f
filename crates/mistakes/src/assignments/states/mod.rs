//! The parts that milestones before collisions share with those behind them: forces, integrators, the penalty force
//! and simple responses. Their programs log states, and nothing of how a step comes about.
mod forces;
pub(super) mod probes;
mod steps;

pub use forces::{FORCES, ForceMistake};
pub use steps::{STEPS, StepMistake};
