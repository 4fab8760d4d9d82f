//! Grades submissions with suites: verdicts, grades and recordings.
//!
//! This is the only crate that uses both traces and programs. It computes a [`Grade`], but does not render it, and it
//! does not use HTTP or parse arguments. Running programs requires Linux. Reading suites and grading existing traces
//! ([`traces`]) work on every machine.
//!
//! ```
//! use fosssim_grading::plan;
//!
//! let plan = plan::find_suite("t2m2")?;
//! assert!(plan.scenes().count() > 100);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod assignments;
#[cfg(target_os = "linux")]
pub mod batch;
#[cfg(target_os = "linux")]
mod cancellation;
#[cfg(target_os = "linux")]
pub mod cards;
mod conclusion;
pub mod config;
#[cfg(target_os = "linux")]
pub mod coverage;
#[cfg(target_os = "linux")]
mod failed_scene;
#[cfg(target_os = "linux")]
pub mod failure_cause;
#[cfg(all(test, target_os = "linux"))]
mod fake_programs;
#[cfg(target_os = "linux")]
pub mod file_names;
#[cfg(target_os = "linux")]
pub mod grader;
mod guard;
#[cfg(target_os = "linux")]
mod key;
pub mod library;
#[cfg(target_os = "linux")]
pub mod milestone;
pub mod plan;
#[cfg(target_os = "linux")]
mod program_file;
#[cfg(target_os = "linux")]
mod recipe;
#[cfg(target_os = "linux")]
pub mod recording;
#[cfg(target_os = "linux")]
pub mod results;
#[cfg(target_os = "linux")]
mod runner;
#[cfg(target_os = "linux")]
pub mod scene_files;
pub mod score;
#[cfg(target_os = "linux")]
mod skipped_scenes;
#[cfg(target_os = "linux")]
pub mod smallest_scene;
#[cfg(target_os = "linux")]
mod speed;
#[cfg(target_os = "linux")]
mod staging;
#[cfg(target_os = "linux")]
mod stored_result;
pub mod suggestions;
mod suite_shape;
mod task;
#[cfg(target_os = "linux")]
mod temporary_folders;
#[cfg(target_os = "linux")]
pub mod timings;
pub mod traces;
#[cfg(target_os = "linux")]
mod upload;

#[cfg(target_os = "linux")]
pub use self::{
    cancellation::Cancellation,
    grader::{Grader, Submission},
    key::{ResultKey, running_build},
    program_file::ProgramFile,
    runner::Runner,
    temporary_folders::Folders,
};
pub use fosssim_findings::{
    Build, Grade, GroupGrade, Reason, SceneGrade, SceneResult, SkippedEntry, SubmissionFault, Verdict, disclosure,
    earlier_grade::EarlierGrade, result,
};
use fosssim_findings::{grade, verdict};
pub use guard::{CaughtPanic, catch_panic};
pub use task::SceneTask;
