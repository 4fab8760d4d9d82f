//! What to grade, and grading it: suites, verdicts, grades, recordings.
//!
//! The only place that knows both traces and programs. Yields a [`Grade`]; it writes no markup, speaks no HTTP and
//! parses no arguments.

pub mod batch;
mod conclude;
pub mod config;
mod execute;
mod grade;
pub mod headroom;
mod hints;
pub mod journal;
mod kept;
pub mod library;
pub mod plan;
pub mod recording;
pub mod score;
mod staging;
mod verdict;

pub use conclude::conclude;
pub use execute::{Cancellation, Runner, SceneTask, not_run};
pub use grade::{Build, Grade, GroupGrade, SceneGrade};
pub use verdict::Verdict;
