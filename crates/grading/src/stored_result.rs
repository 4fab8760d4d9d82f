//! The form in which results are stored.
//!
//! [`FORM_VERSION`] must be increased if the meaning of any part of a result changes, here or in `fosssim_findings`.
use super::{key::ResultKey, result::SceneResult};
use serde::{Deserialize, Serialize};

/// The version of the schema of stored results.
const FORM_VERSION: u32 = 6;

/// A stored result. The version comes first, because it determines the schema of everything else.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StoredResult {
    form: u32,
    /// The key under which the result is found.
    pub key: ResultKey,
    /// The name of the submission. It only informs readers of the file.
    pub submission: String,
    /// The result of the scene.
    pub result: SceneResult,
}

/// Returns the line that stores a result under its key, with a line feed at its end. The submission's name only informs
/// readers of the file.
pub fn format_line(key: &ResultKey, submission: &str, result: &SceneResult) -> Vec<u8> {
    let (key, submission, result) = (key.clone(), submission.to_owned(), result.clone());
    let mut line =
        serde_json::to_vec(&StoredResult { form: FORM_VERSION, key, submission, result }).unwrap_or_default();
    line.push(b'\n');
    line
}

/// Reads the entry in a line; `None` if the line is damaged or has another version.
pub fn read_line(line: &[u8]) -> Option<StoredResult> {
    serde_json::from_slice(line).ok().filter(|entry: &StoredResult| entry.form == FORM_VERSION)
}

#[cfg(test)]
mod tests;
