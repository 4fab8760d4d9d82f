//! The interface to the grader, which is the program `fosssim-oracle` as a child process ([`super::Program`]).
use crate::task::{Outcome, Task};
use std::{
    future::Future,
    path::{Path, PathBuf},
};
use thiserror::Error;
use tokio_util::sync::CancellationToken;

/// The result of a grading, whose files are still in the working folder.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct GradingOutput {
    /// The result, without files.
    pub outcome: Outcome,
    /// The result's files.
    pub files: Vec<NewFile>,
}

/// A file that belongs to a result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NewFile {
    /// The file's name.
    pub name: String,
    /// The file's media type.
    pub media_type: String,
    /// The place of the file.
    pub path: PathBuf,
}

/// The name of the file for a grader's progress, such as `3/85`: the number of scenes with a verdict, and of all
/// scenes.
pub const PROGRESS_FILE: &str = "progress";

/// The reason why there is no verdict, which is never the submission's fault.
#[derive(Debug, Error)]
pub enum GraderFault {
    /// The grading failed; a retry may succeed.
    #[error("{0}")]
    Failed(String),
    /// The grading was stopped on request.
    #[error("the grading was stopped")]
    Stopped,
}

/// A program that grades submissions.
pub trait Grader: Clone + Send + Sync + 'static {
    /// Checks that the grader can grade at present; it may use the empty folder freely.
    ///
    /// # Errors
    ///
    /// Fails if it can't, with the reason, which is for staff only.
    fn prove(&self, folder: &Path, stop: CancellationToken) -> impl Future<Output = Result<(), String>> + Send;

    /// Grades the submission at `submission`, with the suite's archive at `suite` if there is one; it may use `folder`
    /// freely. After `stop` is canceled, it ends soon with everything that it started.
    fn grade(
        &self,
        task: &Task,
        submission: &Path,
        suite: Option<&Path>,
        folder: &Path,
        stop: CancellationToken,
    ) -> impl Future<Output = Result<GradingOutput, GraderFault>> + Send;
}
