//! Evidence: the data that a viewer shows of a judged trace. Both motions, the reference's events in each step from the
//! trace's own state, and the detection calls that findings are about.
//!
//! Judges nothing: its caller knows which steps are wrong ([`StepRulings`]). It goes through the trace once more and
//! holds no more than [`BUDGET`] says, so that it can be made of a trace of any length. A step starts from the trace's
//! own state (oracle-behaviour.md 4.2), takes over the trace's mid record, and ends where the reference ends from
//! there.
#![forbid(unsafe_code)]
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

mod examined;
mod gather;
mod inspected_pair;
mod inspected_step;
mod matching;
mod rulings;
#[cfg(test)]
mod tests;
mod track;

pub use examined::{Examined, Keep, examine};
pub use gather::{Evidence, Focus, Step, StepClass, gather};
pub use inspected_pair::{InspectedPair, Records, inspect};
pub use inspected_step::{InspectedCall, InspectedPass, InspectedStep, Logged, MergedZones};
pub use rulings::{StepRuling, StepRulings};
pub use track::{BUDGET, Track, Window};
