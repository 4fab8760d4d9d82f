//! Places for results, so that nothing is lost and nothing is done twice.
//!
//! Results are found by a key that digests everything they depend on ([`Key`]), so a changed program, scene, rule or
//! grader is simply not found. The outcome of a grading does not depend on the place of its results.
mod folder;

pub use super::form::{Entry, line, read_line};
pub use folder::{FolderResults, JOURNAL, LARGEST_JOURNAL, LOCK, LONGEST_LINE, for_each_line};

use super::{key::Key, result::SceneResult};

/// A place for results, which several jobs use at one time.
pub trait Results: Sync {
    /// Finds the result that was kept under this key; the last of several.
    fn find(&self, key: &Key) -> Option<SceneResult>;

    /// Keeps a result. A place that outlives the grader has it written when this returns. The submission's name is for
    /// people only.
    ///
    /// # Errors
    /// When it can't be kept, for example because the disk is full. What was kept before stays.
    fn keep(&self, key: &Key, submission: &str, result: &SceneResult) -> Result<(), KeepError>;
}

/// The reason why a result can't be kept: always ours or the machine's fault.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct KeepError(pub String);
