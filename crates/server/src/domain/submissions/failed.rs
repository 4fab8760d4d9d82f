//! The scenes that submissions do not have right: of a class for its staff, and from one attempt to the next.
use crate::domain::{Member, Staff, view::Submission};
use crate::{
    db::{DbError, Transaction},
    problem::Problem,
    values,
};
use std::collections::{BTreeMap, BTreeSet};

/// Scenes that a result does not accept, each with its verdict in short.
pub type FailedScenes = BTreeMap<String, String>;

/// The scenes that an attempt has changed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AttemptChange {
    /// The number of the attempt before it.
    pub since: i64,
    /// Scenes that became right.
    pub right: Vec<String>,
    /// Scenes that are no longer right.
    pub wrong: Vec<String>,
}

impl AttemptChange {
    /// Returns the difference between two attempts.
    pub fn between(since: i64, old: &FailedScenes, new: &FailedScenes) -> Self {
        let names = |scenes: &FailedScenes| scenes.keys().cloned().collect::<BTreeSet<_>>();
        let (old, new) = (names(old), names(new));
        Self { since, right: (&old - &new).into_iter().collect(), wrong: (&new - &old).into_iter().collect() }
    }
}

/// Reads the column as it is kept: `WA Group/name` in each line.
fn read(text: &str) -> FailedScenes {
    let lines = text.lines().filter_map(|line| line.split_once(' '));
    lines.map(|(code, scene)| (scene.to_owned(), code.to_owned())).collect()
}

impl Staff {
    /// Returns the scenes that results of the course do not accept, by the results' numbers; of results of older
    /// versions nothing.
    ///
    /// # Errors
    /// When the database does not answer.
    pub async fn failed_scenes(&self, results: &[i64]) -> Result<BTreeMap<i64, FailedScenes>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT result.id, result.failed FROM result
            JOIN submission ON submission.id = result.submission
            JOIN assignment ON assignment.id = submission.assignment
            WHERE assignment.course = ? AND result.failed IS NOT NULL
               AND result.id IN (SELECT CAST(wanted.value AS {int}) FROM {each})";
        let results = serde_json::to_string(results).unwrap_or_default();
        let rows = transaction.rows(statement, values![self.course, results]).await?;
        Ok(rows.iter().map(|row| Ok((row.int("id")?, read(&row.text("failed")?)))).collect::<Result<_, DbError>>()?)
    }
}

impl Member {
    /// Returns the change that a submission has made since the graded one of the same person before it. Nothing where
    /// there is none, and to students nothing where groups of one of both are withheld.
    ///
    /// # Errors
    /// When the database does not answer.
    pub async fn change(&self, submission: &Submission) -> Result<Option<AttemptChange>, Problem> {
        if submission.is_withheld || submission.grade.is_none() {
            return Ok(None);
        }
        let mut transaction = self.app.0.database.read().await?;
        Ok(change(&mut transaction, submission.id, self.is_staff || submission.is_published).await?)
    }
}

async fn change(
    transaction: &mut Transaction,
    submission: i64,
    sees_all: bool,
) -> Result<Option<AttemptChange>, DbError> {
    let statement = "SELECT earlier.number, old.shown, old.failed AS old_failed, new.failed AS new_failed
        FROM submission AS later
        JOIN grade AS new_grade ON new_grade.submission = later.id
        JOIN result AS new ON new.id = new_grade.result
        JOIN submission AS earlier ON earlier.assignment = later.assignment AND earlier.account = later.account
           AND earlier.id < later.id
        JOIN grade AS old_grade ON old_grade.submission = earlier.id
        JOIN result AS old ON old.id = old_grade.result
        WHERE later.id = ? ORDER BY earlier.id DESC LIMIT 1";
    let Some(row) = transaction.row(statement, values![submission]).await? else { return Ok(None) };
    // A result that hides nothing has nothing that is shown instead.
    if !sees_all && row.maybe_text("shown")?.is_none_or(|shown| !shown.is_empty()) {
        return Ok(None);
    }
    let (Some(old), Some(new)) = (row.maybe_text("old_failed")?, row.maybe_text("new_failed")?) else {
        return Ok(None);
    };
    Ok(Some(AttemptChange::between(row.int("number")?, &read(&old), &read(&new))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_attempt_makes_scenes_right_and_others_wrong() {
        let (old, new) = (read("WA a/b\nTLE a/c d\n"), read("WA a/c d\nRTE e"));
        assert_eq!(old["a/c d"], "TLE");
        let change = AttemptChange::between(3, &old, &new);
        assert_eq!((change.right, change.wrong), (vec!["a/b".to_owned()], vec!["e".to_owned()]));
        assert_eq!(read(""), FailedScenes::new());
    }
}
