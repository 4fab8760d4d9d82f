//! The grader. Today that is the program `fosssim-oracle` as a child ([`super::Program`]); a worker does not care.
use crate::task::{Outcome, Task};
use std::{
    future::Future,
    path::{Path, PathBuf},
};
use thiserror::Error;
use tokio_util::sync::CancellationToken;

/// The result of a grading, with its files still in the working folder.
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

/// The file in its folder into which a grader may write its progress, as `3/85`: scenes with a verdict, all scenes.
pub const PROGRESS: &str = "progress";

/// The reason why there is no verdict. Never the submission's fault.
#[derive(Debug, Error)]
pub enum GraderFault {
    /// The grading failed; another try may help.
    #[error("{0}")]
    Failed(String),
    /// The grading was stopped on request.
    #[error("the grading was stopped")]
    Stopped,
}

/// The grader.
pub trait Grader: Clone + Send + Sync + 'static {
    /// Proves that it can grade here and now, and may use the empty folder as it likes.
    ///
    /// # Errors
    /// The reason why it can't; shown to staff, never to students.
    fn prove(&self, folder: &Path, stop: CancellationToken) -> impl Future<Output = Result<(), String>> + Send;

    /// Grades the submission at `submission`, by the suite whose archive is at `suite` if there is one, and may use
    /// `folder` freely. When `stop` is canceled it ends soon, with all that it started.
    fn grade(
        &self,
        task: &Task,
        submission: &Path,
        suite: Option<&Path>,
        folder: &Path,
        stop: CancellationToken,
    ) -> impl Future<Output = Result<GradingOutput, GraderFault>> + Send;
}
