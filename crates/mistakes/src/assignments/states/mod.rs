//! The parts that milestones before collisions share with those behind them: forces, integrators, the penalty force
//! and simple responses. Their programs log states, and nothing of how a step comes about.
pub(super) mod probes;
mod steps;

pub use steps::{STEPS, StepMistake};
