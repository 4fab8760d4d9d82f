//! The parts shared by all milestones: forces, integrators, the penalty force and simple responses. Their programs log
//! only states, not intermediate results.
mod edits;
pub(super) mod probes;
mod slip_text;
mod slips;
mod steps;
mod terms;

pub use edits::EDIT_ROWS;
pub use slips::Slip;
pub use steps::{STEPS, StepMistake};
pub use terms::{Edit, TERMS, Term, TermRow};
