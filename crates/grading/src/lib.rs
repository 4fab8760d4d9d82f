//! What to grade, and grading it: suites, verdicts, grades, recordings.
//!
//! The only place that knows both traces and programs. Yields a [`Grade`]; it writes no markup, speaks no HTTP and
//! parses no arguments.

pub mod batch;
pub mod cards;
mod conclude;
pub mod config;
mod execute;
mod fault;
mod grade;
mod guard;
pub mod headroom;
mod hints;
pub mod journal;
mod kept;
pub mod library;
pub mod patience;
pub mod plan;
pub mod recording;
pub mod score;
mod shape;
mod staging;
mod temporary;
pub mod upload;
mod verdict;

pub use conclude::{Run, conclude};
pub use execute::{Cancellation, Runner, SceneTask};
pub use grade::{Build, Grade, GroupGrade, SceneGrade, SceneResult};
pub use guard::{Fault, guarded};
pub use verdict::Verdict;
