//! The interface to the grader. The grader is the program `fosssim-oracle`, which runs as a child process
//! ([`super::Program`]).
use crate::task::{Outcome, Task};
use std::{
    future::Future,
    path::{Path, PathBuf},
};
use thiserror::Error;
use tokio_util::sync::CancellationToken;

/// The result of a grading, while its files are still in the working folder.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct GradingOutput {
    /// The outcome. Its list of files is still empty.
    pub outcome: Outcome,
    /// The files that the grading produced.
    pub files: Vec<NewFile>,
}

/// A file that a grading produced, but that is not stored yet.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NewFile {
    /// The file's name.
    pub name: String,
    /// The file's media type.
    pub media_type: String,
    /// The path of the file.
    pub path: PathBuf,
}

/// The name of the file into which the grader writes its progress, such as `3/85`. The first number counts the scenes
/// that have a verdict, and the second counts all scenes.
pub const PROGRESS_FILE: &str = "progress";

/// The reason why a grading has no verdict. It is never the submission's fault.
#[derive(Debug, Error)]
pub enum GraderFault {
    /// The grader failed; a retry may succeed.
    #[error("{0}")]
    Failed(String),
    /// The grading was stopped because the worker requested it.
    #[error("the grading was stopped")]
    Stopped,
}

/// A program that grades submissions.
pub trait Grader: Clone + Send + Sync + 'static {
    /// Checks that the grader can grade at present. `folder` is empty, and the grader may write into it.
    ///
    /// # Errors
    ///
    /// Fails if the grader can't grade. The error is the reason, which only staff should see.
    fn check_ability(&self, folder: &Path, stop: CancellationToken) -> impl Future<Output = Result<(), String>> + Send;

    /// Grades the file `submission`. If the suite is an archive, it is the file `suite`. The grader may write into
    /// `folder`. After `stop` is canceled, the grading and everything that it started end soon.
    fn grade(
        &self,
        task: &Task,
        submission: &Path,
        suite: Option<&Path>,
        folder: &Path,
        stop: CancellationToken,
    ) -> impl Future<Output = Result<GradingOutput, GraderFault>> + Send;
}
