//! The suites of the grader, by name, and those that were uploaded to a course. The grader lists its suites itself
//! (`suite list --format json`), so that this program is independent of them.
use crate::{
    calendar,
    db::{DbError, Transaction, from_row},
    problem::Problem,
    task::Suite,
    values,
};
use serde::{Deserialize, Serialize};

/// The grader's suites, the newest version of each first. A server without a grader, whose workers are elsewhere,
/// accepts any plain name. The worker's grader then reports whether it has such a suite.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Suites {
    entries: Vec<Entry>,
}

#[derive(Deserialize)]
struct ListedSuites {
    suites: Vec<Entry>,
}

#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
struct Entry {
    name: String,
    /// The suite's name without its version.
    #[serde(default)]
    suite: String,
    #[serde(default)]
    title: String,
    default: bool,
    #[serde(default)]
    groups: Vec<SuiteGroup>,
}

/// A group of scenes in a suite.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SuiteGroup {
    pub(crate) name: String,
    /// The number of scenes; `None` if an uploaded suite selects them by patterns.
    pub(crate) scenes: Option<u64>,
    pub(crate) points: serde_json::Number,
    /// Whether students see the group only after staff publish it.
    #[serde(default)]
    pub(crate) is_hidden: bool,
}

impl SuiteGroup {
    /// Reads a group of an uploaded suite.
    pub(crate) fn from_toml(group: &toml::Value) -> Self {
        let scenes = group.get("scenes").and_then(toml::Value::as_array).map_or(&[][..], Vec::as_slice);
        let is_pattern = |scene: &toml::Value| scene.as_str().is_none_or(|scene| scene.contains(['*', '?', '[']));
        let points = group.get("points").cloned().and_then(|points| points.try_into().ok());
        Self {
            name: group.get("name").and_then(toml::Value::as_str).unwrap_or_default().to_owned(),
            scenes: (!scenes.iter().any(is_pattern)).then_some(scenes.len() as u64),
            points: points.unwrap_or_else(|| 1.into()),
            is_hidden: group.get("visibility").is_some_and(|visibility| visibility.as_str() != Some("visible")),
        }
    }
}

/// A suite that was uploaded to a course earlier.
#[derive(Debug, Clone)]
pub struct UploadedSuite {
    /// The digest of the suite's archive.
    pub digest: String,
    /// The suite's name; empty if an older version of the server received it.
    pub name: String,
    /// The time of the last upload, in milliseconds since 1970; `None` if an older version of the server received it.
    pub uploaded_at: Option<i64>,
}

from_row! { UploadedSuite { digest, name, uploaded_at } }

impl UploadedSuite {
    /// Returns the suite's name and the time of its upload, such as `Mini (uploaded 2026-11-22 08:45 UTC)`.
    pub(crate) fn describe(&self) -> String {
        let name = if self.name.is_empty() { self.digest.get(..12).unwrap_or_default() } else { &self.name };
        let time = self.uploaded_at.map(|at| format!(" {} UTC", calendar::format_minute(at))).unwrap_or_default();
        format!("{name} (uploaded{time})")
    }
}

/// Returns the name of a suite, which is the grader's or one of `uploaded`.
pub(in crate::domain) fn describe_suite(suite: &Suite, uploaded: &[UploadedSuite]) -> String {
    match suite {
        Suite::Named(name) => name.clone(),
        Suite::Archive(digest) => {
            let found = uploaded.iter().find(|uploaded| uploaded.digest == digest.to_string());
            found.map_or_else(|| digest.short().to_owned(), UploadedSuite::describe)
        }
    }
}

/// Returns the suites that were uploaded to a course, newest first.
pub(in crate::domain) async fn read_suites(
    transaction: &mut Transaction,
    course: i64,
) -> Result<Vec<UploadedSuite>, DbError> {
    let statement = "SELECT digest, name, uploaded_at FROM suite WHERE course = ?
        ORDER BY coalesce(uploaded_at, 0) DESC, digest LIMIT 100";
    transaction.all(statement, values![course]).await
}

/// Returns whether a name is a single file name on every system, and cannot be misread in messages.
pub fn is_file_name(name: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    (1..=100).contains(&name.len()) && name.chars().all(plain) && !name.starts_with(['.', '-'])
}

impl Suites {
    /// Reads the grader's list.
    ///
    /// # Errors
    ///
    /// Fails if the JSON is not a list of suites.
    pub fn read(json: &[u8]) -> Result<Self, serde_json::Error> {
        let list: ListedSuites = serde_json::from_slice(json)?;
        Ok(Self { entries: list.suites })
    }

    /// Returns the suite's name for settings. An empty name becomes the grader's default, and a name without a version
    /// gets the newest version, so that later versions of the grader do not change the assignment. If the grader can't
    /// be called, the name stays as it is, and the grader chooses the version.
    pub(in crate::domain) fn name_or_default(&self, name: &str) -> String {
        let is_selected = |entry: &&Entry| if name.is_empty() { entry.default } else { entry.suite == name };
        self.entries.iter().find(is_selected).map_or(name, |entry| &entry.name).to_owned()
    }

    /// Checks that the grader has a suite with this name.
    pub(in crate::domain) fn check(&self, name: &str) -> Result<(), Problem> {
        // The version follows an `@`.
        let is_name = name.is_empty() || name.split('@').count() <= 2 && name.split('@').all(is_file_name);
        match () {
            () if !is_name => Err(Problem::invalid(format!("suite must be {}", self.describe()))),
            () if self.entries.is_empty() || self.entries.iter().any(|known| known.name == name) => Ok(()),
            () => Err(Problem::conflict(format!("suite must be {}", self.describe()), "name an existing one")),
        }
    }

    /// Returns the name and the title of each suite; empty if the grader can't be called.
    pub fn names_and_titles(&self) -> impl Iterator<Item = (&str, &str)> {
        self.entries.iter().map(|suite| (suite.name.as_str(), suite.title.as_str()))
    }

    /// Returns the groups of a suite; empty if the grader does not list them.
    pub(crate) fn groups(&self, name: &str) -> &[SuiteGroup] {
        self.entries.iter().find(|suite| suite.name == name).map_or(&[], |suite| &suite.groups)
    }

    /// Returns the names of all suites as a list for a message, such as `a, b or c`.
    pub fn describe(&self) -> String {
        match self.entries.iter().map(|suite| suite.name.as_str()).collect::<Vec<_>>().as_slice() {
            [] => "a name that `fosssim-oracle suite list` shows".to_owned(),
            [only] => (*only).to_owned(),
            [some @ .., last] => format!("{} or {last}", some.join(", ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_graders_list() {
        let json = br#"{"schema": 1, "suites": [{"name": "new", "title": "New", "default": false},
            {"name": "old", "title": "Old", "default": true}]}"#;
        let suites = Suites::read(json).expect("a list");
        assert_eq!(suites.describe(), "new or old");
        assert_eq!((suites.name_or_default("").as_str(), suites.name_or_default("new").as_str()), ("old", "new"));
        let json = br#"{"schema": 2, "suites": [{"name": "m@2", "suite": "m", "default": true},
            {"name": "m@1", "suite": "m", "default": false}]}"#;
        let versions = Suites::read(json).expect("a list");
        let filled = ["", "m", "m@1", "m@2"].map(|name| versions.name_or_default(name));
        assert_eq!(filled, ["m@2", "m@2", "m@1", "m@2"], "what is kept names its version");
        assert!(suites.check("new").is_ok() && suites.check("old").is_ok());
        assert_eq!(suites.check("other").expect_err("unknown").detail, "suite must be new or old");
        assert!(Suites::read(b"usage: ...").is_err());
    }

    #[test]
    fn without_a_grader_any_plain_name_will_do() {
        let suites = Suites::default();
        assert!(suites.check("").is_ok() && suites.check("t9m9").is_ok() && suites.check("t9m9@2").is_ok());
        assert!(suites.check("t9m9@").is_err() && suites.check("t9m9@1@2").is_err());
        assert!(suites.check("../../etc/passwd").is_err() && suites.check("--output").is_err());
    }
}
