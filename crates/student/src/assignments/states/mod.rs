//! The parts that milestones before collisions share with those behind them: forces, integrators, the penalty force and
//! simple responses. Their programs log states only, not the way to them.
mod edits;
pub(super) mod probes;
mod slips;
mod steps;
mod terms;
mod words;

pub use edits::EDITS;
pub use slips::Slip;
pub use steps::{STEPS, StepMistake};
pub use terms::{Edit, TERMS, Term, TermRow};
