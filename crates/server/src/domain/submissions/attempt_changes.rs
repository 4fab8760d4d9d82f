//! The scenes and group points that are stored with a result next to its grade, and the scenes that changed between two
//! attempts.
use crate::domain::{Member, view::Submission};
use crate::{
    db::{DbError, Row},
    problem::Problem,
    values,
    visible_grade::GradeParts,
};
use std::collections::{BTreeMap, BTreeSet};

/// The scenes that a result does not accept. The key is the scene's name, and the value is the code of its verdict.
pub type FailedScenes = BTreeMap<String, String>;

/// The scenes that changed from one attempt to the next.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AttemptChange {
    /// The number of the attempt with which this attempt is compared.
    pub since: i64,
    /// The scenes that were not accepted before, and are now.
    pub newly_right: Vec<String>,
    /// The scenes that were accepted before, and are not now.
    pub newly_wrong: Vec<String>,
    /// Whether no scene is accepted now.
    pub is_all_wrong: bool,
}

impl AttemptChange {
    /// Compares an attempt with the earlier attempt `since`.
    pub fn compare(since: i64, old: &StoredResult, new: &StoredResult) -> Self {
        let names = |result: &StoredResult| result.failed.keys().cloned().collect::<BTreeSet<_>>();
        let is_all_wrong = !new.parts.scenes.is_empty() && !new.parts.scenes.contains('r');
        let (old_names, new_names) = (names(old), names(new));
        let changes = [&old_names - &new_names, &new_names - &old_names];
        let [newly_right, newly_wrong] = changes.map(|names| names.into_iter().collect());
        Self { since, newly_right, newly_wrong, is_all_wrong }
    }
}

/// Reads the stored text. It has a line for each scene that is not accepted, such as `WA Group/name`.
fn read(text: &str) -> FailedScenes {
    let lines = text.lines().filter_map(|line| line.split_once(' '));
    lines.map(|(code, scene)| (scene.to_owned(), code.to_owned())).collect()
}

/// The details that are stored with a result: the scenes that are not accepted, and the parts of the grade.
#[derive(Debug, Default)]
pub struct StoredResult {
    /// The scenes that the result does not accept.
    pub failed: FailedScenes,
    /// The points of groups and the likely mistakes; empty for results that an older version stored.
    pub parts: GradeParts,
}

impl Member {
    /// Returns what is stored with the course's results, by the ID of the result. Results that an older version
    /// stored have empty parts. Hidden groups are included, so students may read this only if the groups are published
    /// or the suite hides no groups.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn stored_results(&self, results: &[i64]) -> Result<BTreeMap<i64, StoredResult>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT result.id, result.failed, result.parts FROM result
            JOIN submission ON submission.id = result.submission
            JOIN assignment ON assignment.id = submission.assignment
            WHERE assignment.course = ? AND result.failed IS NOT NULL
               AND result.id IN (SELECT CAST(wanted.value AS {int}) FROM {each})";
        let results = serde_json::to_string(results).unwrap_or_default();
        let rows = transaction.rows(statement, values![self.course, results]).await?;
        let read_row = |row: &Row| {
            let parts = row.maybe_text("parts")?.and_then(|parts| serde_json::from_str(&parts).ok());
            let failed = read(&row.text("failed")?);
            Ok((row.int("id")?, StoredResult { failed, parts: parts.unwrap_or_default() }))
        };
        Ok(rows.iter().map(read_row).collect::<Result<_, DbError>>()?)
    }

    /// Returns the changes between consecutive graded attempts of one person, newest first. Each is stored under the ID
    /// of the later attempt. Attempts with withheld groups are left out.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn attempt_changes(&self, attempts: &[Submission]) -> Result<BTreeMap<i64, AttemptChange>, Problem> {
        let graded_attempts = attempts.iter().filter_map(|attempt| Some((attempt, attempt.grade.as_ref()?.result)));
        let graded_attempts: Vec<(&Submission, i64)> = graded_attempts.collect();
        let visible_attempts = graded_attempts.iter().filter(|(submission, _)| !submission.is_withheld);
        let stored_results =
            self.stored_results(&visible_attempts.map(|(_, result)| *result).collect::<Vec<_>>()).await?;
        let change = |pair: &[(&Submission, i64)]| {
            let [(later, new), (earlier, old)] = *pair else { return None };
            later.grade.as_ref().filter(|grade| grade.has_run())?;
            let change = AttemptChange::compare(earlier.number, stored_results.get(&old)?, stored_results.get(&new)?);
            Some((later.id, change))
        };
        Ok(graded_attempts.windows(2).filter_map(change).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_attempt_makes_scenes_right_and_others_wrong() {
        let (old, new) = (read("WA a/b\nTLE a/c d\n"), read("WA a/c d\nRTE e"));
        assert_eq!(old["a/c d"], "TLE");
        let result = |failed, scenes: &str| StoredResult {
            failed,
            parts: GradeParts { scenes: scenes.to_owned(), ..GradeParts::default() },
        };
        let change = AttemptChange::compare(3, &result(old, "we|r"), &result(new, "re|e"));
        assert!(
            !change.is_all_wrong
                && AttemptChange::compare(3, &result(read(""), "r"), &result(read("WA e"), "w")).is_all_wrong
        );
        assert_eq!((change.newly_right, change.newly_wrong), (vec!["a/b".to_owned()], vec!["e".to_owned()]));
        assert_eq!(read(""), FailedScenes::new());
    }
}
