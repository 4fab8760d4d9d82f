//! Stores results, so that nothing is lost or done twice.
//!
//! A result is found by a key, which is a digest of everything that the result depends on ([`ResultKey`]). If the
//! program, the scene, a rule or the grader changes, the old result is not found. Grades do not depend on whether
//! results are stored.
mod folder;

pub use super::stored_result::{StoredResult, format_line, read_line};
pub use folder::{FolderResults, JOURNAL_NAME, LOCK_FILE, MAX_JOURNAL_BYTES, MAX_LINE_BYTES, for_each_line};

use super::{key::ResultKey, result::SceneResult};

/// A storage of results. Several jobs use it at the same time.
pub trait Results: Sync {
    /// Finds the newest result that was stored under a key.
    fn find(&self, key: &ResultKey) -> Option<SceneResult>;

    /// Stores a result. If the storage is persistent, the result is written before this function returns. The
    /// submission's name only informs readers of the file.
    ///
    /// # Errors
    ///
    /// Fails if the result can't be stored, for example because the disk is full. Earlier results are kept.
    fn store(&self, key: &ResultKey, submission: &str, result: &SceneResult) -> Result<(), StoreError>;
}

/// The reason why a result can't be stored. It is always an error of the grader or the machine.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct StoreError(pub String);
