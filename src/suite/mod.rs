//! What to grade, and grading it: suites, verdicts, grades, recordings.
//!
//! The only place that knows both traces and programs. Yields a [`Grade`]; it writes no markup, speaks no HTTP and
//! parses no arguments.

pub mod config;
mod grade;
pub mod journal;
pub mod score;
mod verdict;

pub use grade::{Build, Grade, GroupGrade, SceneGrade};
pub use verdict::Verdict;
