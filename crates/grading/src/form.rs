//! The serialized form of results, which is used wherever results are stored.
//!
//! [`VERSION`] must be increased if the meaning of any part of a result changes, here or in `fosssim_findings`.
use super::{key::Key, result::SceneResult};
use serde::{Deserialize, Serialize};

/// The version of the form.
const VERSION: u32 = 6;

/// A stored result. The form's version comes before everything that depends on it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    form: u32,
    /// The key of the result.
    pub key: Key,
    /// The submission's name, which is only for people.
    pub submission: String,
    /// The result.
    pub result: SceneResult,
}

/// Returns the line that stores a result under its key, with a line end; the submission's name is only for people.
#[must_use]
pub fn format_line(key: &Key, submission: &str, result: &SceneResult) -> Vec<u8> {
    let (key, submission, result) = (key.clone(), submission.to_owned(), result.clone());
    let mut line = serde_json::to_vec(&Entry { form: VERSION, key, submission, result }).unwrap_or_default();
    line.push(b'\n');
    line
}

/// Reads the entry of a line; `None` if the line is damaged or of another version.
#[must_use]
pub fn read_line(line: &[u8]) -> Option<Entry> {
    serde_json::from_slice(line).ok().filter(|entry: &Entry| entry.form == VERSION)
}

#[cfg(test)]
mod tests;
