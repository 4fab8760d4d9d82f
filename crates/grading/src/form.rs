//! The one serialised form of results: what every place that keeps results writes.
//!
//! [`VERSION`] rises when anything here or in `mirror`, which holds the parts, changes its meaning.
use super::{key::Key, result::SceneResult};
use serde::{Deserialize, Serialize};

/// The version of the form.
const VERSION: u32 = 4;

/// What is written: the form's version before all that depends on it.
#[derive(Serialize)]
struct Written<'a> {
    form: u32,
    key: &'a Key,
    submission: &'a str,
    result: &'a SceneResult,
}

#[derive(Deserialize)]
struct Read {
    form: u32,
    key: Key,
    submission: String,
    result: SceneResult,
}

/// A result as it was kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Under what it is found.
    pub key: Key,
    /// Whose it is, for people.
    pub submission: String,
    /// The result.
    pub result: SceneResult,
}

/// A result in its form, on one line without an end, with the key under which it is found; the submission is for
/// people.
#[must_use]
pub fn write(key: &Key, submission: &str, result: &SceneResult) -> Vec<u8> {
    serde_json::to_vec(&Written { form: VERSION, key, submission, result }).unwrap_or_default()
}

/// What [`write`] wrote; `None` where it is damaged or of another version.
#[must_use]
pub fn read(bytes: &[u8]) -> Option<Entry> {
    let Read { form, key, submission, result } = serde_json::from_slice(bytes).ok()?;
    (form == VERSION).then_some(Entry { key, submission, result })
}

#[cfg(test)]
mod tests;
