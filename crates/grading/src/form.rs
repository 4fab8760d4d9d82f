//! The one serialized form of results: what every place that keeps results writes.
//!
//! [`VERSION`] rises when anything changes its meaning that results are made of: here or in
//! `fosssim_findings`.
use super::{key::Key, result::SceneResult};
use serde::{Deserialize, Serialize};

/// The version of the form.
const VERSION: u32 = 6;

/// A result as it is kept: the form's version comes before all that depends on it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    form: u32,
    /// The key under which it is found.
    pub key: Key,
    /// The submission's name, for people.
    pub submission: String,
    /// The result.
    pub result: SceneResult,
}

/// Returns the line that keeps a result, with its end and the key under which it is found; the submission is for
/// people.
#[must_use]
pub fn line(key: &Key, submission: &str, result: &SceneResult) -> Vec<u8> {
    let (key, submission, result) = (key.clone(), submission.to_owned(), result.clone());
    let mut line = serde_json::to_vec(&Entry { form: VERSION, key, submission, result }).unwrap_or_default();
    line.push(b'\n');
    line
}

/// Reads the entry that a line keeps; `None` if the line is damaged, or of another version.
#[must_use]
pub fn read_line(line: &[u8]) -> Option<Entry> {
    serde_json::from_slice(line).ok().filter(|entry: &Entry| entry.form == VERSION)
}

#[cfg(test)]
mod tests;
