//! What to grade, and grading it: suites, verdicts, grades, recordings.
//!
//! The only place that knows both traces and programs. Yields a [`Grade`]; it writes no markup, speaks no HTTP and
//! parses no arguments.

pub mod batch;
pub mod cards;
#[cfg(test)]
mod cast;
mod conclude;
pub mod config;
mod execute;
mod fault;
mod form;
mod grade;
pub mod grader;
mod guard;
pub mod headroom;
mod hints;
mod key;
pub mod library;
pub mod patience;
pub mod plan;
pub mod recording;
pub mod result;
pub mod results;
pub mod score;
mod shape;
mod staging;
mod temporary;
pub mod told;
pub mod upload;
mod verdict;

pub use conclude::{Run, conclude};
pub use execute::{Cancellation, Runner, SceneTask};
pub use grade::{Build, Grade, GroupGrade, SceneGrade, Unfit};
pub use grader::{Grader, Submission};
pub use guard::{Fault, guarded};
pub use key::Key;
pub use result::{Reason, SceneResult};
pub use verdict::Verdict;
