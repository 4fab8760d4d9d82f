//! Storage of results, so that nothing is lost or done twice.
//!
//! Results are found by a key that digests everything they depend on ([`Key`]), so the results of a changed program,
//! scene, rule or grader are not found. The grades do not depend on the storage.
mod folder;

pub use super::form::{Entry, format_line, read_line};
pub use folder::{FolderResults, JOURNAL_NAME, LOCK_FILE, MAX_JOURNAL_BYTES, MAX_LINE_BYTES, for_each_line};

use super::{key::Key, result::SceneResult};

/// A storage of results, which several jobs use in parallel.
pub trait Results: Sync {
    /// Finds the newest result that was stored under a key.
    fn find(&self, key: &Key) -> Option<SceneResult>;

    /// Stores a result. With persistent storage, the result is written when this function returns. The submission's
    /// name is for people only.
    ///
    /// # Errors
    ///
    /// Fails if the result can't be stored, for example because the disk is full. Earlier results stay.
    fn keep(&self, key: &Key, submission: &str, result: &SceneResult) -> Result<(), KeepError>;
}

/// The reason why a result can't be stored; always an error of the grader or the machine.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct KeepError(pub String);
