//! What to grade, and grading it: suites, verdicts, grades, recordings.
//!
//! The only place that knows both traces and programs. Yields a [`Grade`]; it writes no markup, speaks no HTTP and
//! parses no arguments.
//!
//! ```
//! use fosssim_grading::plan;
//!
//! let plan = plan::find("t2m2")?;
//! assert!(plan.scenes().count() > 100);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod assignments;
pub mod batch;
mod cancellation;
pub mod cards;
#[cfg(test)]
mod cast;
mod conclude;
pub mod config;
pub mod coverage;
mod execute;
mod fault;
mod form;
pub mod grader;
mod guard;
pub mod headroom;
mod hints;
mod key;
pub mod library;
pub mod located;
pub mod names;
pub mod near;
mod one_file;
pub mod patience;
pub mod plan;
pub mod recording;
pub mod results;
pub mod scene_files;
pub mod score;
mod shape;
mod staging;
mod task;
mod temporary;
pub mod upload;

pub use cancellation::Cancellation;
pub use conclude::{Look, Run, bytes_of_nothing, conclude};
pub use execute::Runner;
pub use fosssim_findings::{
    Build, Grade, GroupGrade, PassedOver, Reason, SceneGrade, SceneResult, Unfit, Verdict, disclosure, result,
};
use fosssim_findings::{grade, verdict};
pub use grader::{Grader, Submission};
pub use guard::{Fault, guarded};
pub use hints::cut;
pub use key::{Key, this_build};
pub use one_file::OneFile;
pub use task::SceneTask;
pub use temporary::Folders;
