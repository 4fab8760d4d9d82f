//! Removes old uploads and reports, and artifacts to which nothing refers. Grades and their history stay forever. The
//! work is done in batches, so that memory is the same for ten submissions and for a million, and no request waits for
//! long.
use crate::{
    db::{Database, DbError, Transaction},
    queue::millis,
    store::{Digest, Store, StoreError},
    values,
};
use std::{collections::HashSet, time::Duration};
use thiserror::Error;

/// The minimum age of an artifact that is removed. A running transaction may still refer to a younger one.
pub const MIN_AGE: Duration = Duration::from_secs(24 * 3600);

/// The number of submissions that expire in one transaction.
const BATCH_SIZE: i64 = 500;

/// The reason why some expired data could not be removed.
#[derive(Debug, Error)]
pub enum RetentionError {
    /// The database reported an error.
    #[error(transparent)]
    Database(#[from] DbError),
    /// The store reported an error.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// The numbers of submissions and artifacts that were removed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct RemovalCounts {
    /// The number of submissions whose upload and reports were removed.
    pub submissions: u64,
    /// The number of removed artifacts.
    pub artifacts: usize,
}

/// Removes the uploads and reports of submissions that are older than `keep_for`, if it is set. Removes artifacts that
/// are older than `min_age` and to which nothing refers. Submissions that are being graded or regraded are left alone.
///
/// # Errors
///
/// Fails if the database or the store fails. The next call removes the rest.
pub async fn remove_expired(
    database: &Database,
    store: &Store,
    keep_for: Option<Duration>,
    min_age: Duration,
) -> Result<RemovalCounts, RetentionError> {
    let submissions = match keep_for {
        Some(keep) => expire_submissions(database, millis(keep)).await?,
        None => 0,
    };
    let artifacts = store.remove_unreferenced(min_age, |digests| find_referenced(database, digests)).await?;
    Ok(RemovalCounts { submissions, artifacts })
}

async fn expire_submissions(database: &Database, keep_for: i64) -> Result<u64, DbError> {
    let (mut after, mut id) = (i64::MIN, 0);
    let mut submissions = 0;
    loop {
        // The search uses a read transaction, so that it does not block writers.
        let mut transaction = database.read().await?;
        let statement = "SELECT id, created_at FROM submission
            WHERE removed_at IS NULL AND created_at <= {now} - ? AND (created_at, id) > (?, ?)
            ORDER BY created_at, id LIMIT ?";
        let found = transaction.rows(statement, values![keep_for, after, id, BATCH_SIZE]).await?;
        drop(transaction);
        let Some(last) = found.last() else { break };
        (after, id) = (last.int("created_at")?, last.int("id")?);
        let ids = found.iter().map(|row| row.int("id")).collect::<Result<Vec<_>, _>>()?;
        let mut transaction = database.begin().await?;
        submissions += transaction
            .execute(
                "WITH found AS (SELECT id FROM submission
                    WHERE id IN (SELECT CAST(wanted.value AS {int}) FROM {each}) ORDER BY id {for update})
                 UPDATE submission SET removed_at = {now} WHERE id IN (SELECT id FROM found) AND removed_at IS NULL
                    AND NOT EXISTS (SELECT 1 FROM job
                        WHERE job.submission = submission.id AND job.state IN ('waiting', 'running'))
                    AND NOT EXISTS (SELECT 1 FROM campaign
                        WHERE campaign.assignment = submission.assignment AND campaign.state = 'open')",
                values![serde_json::to_string(&ids).unwrap_or_default()],
            )
            .await?;
        transaction.commit().await?;
    }
    if submissions > 0 {
        let mut transaction = database.begin().await?;
        let text = format!("uploads and reports of {submissions} submissions were removed");
        let statement = "INSERT INTO event (happened_at, kind, text) VALUES ({now}, 'retention', ?)";
        transaction.execute(statement, values![text]).await?;
        transaction.commit().await?;
    }
    Ok(submissions)
}

/// Returns those of the digests to which the database still refers.
async fn find_referenced(database: &Database, digests: Vec<Digest>) -> Result<HashSet<Digest>, RetentionError> {
    let mut transaction = database.read().await?;
    let suites = used_suites(&mut transaction).await?;
    let digests_json = serde_json::to_string(&digests).unwrap_or_default();
    let statement = "SELECT wanted.value AS digest FROM {each}
        WHERE EXISTS (SELECT 1 FROM submission
               WHERE submission.digest = wanted.value AND submission.removed_at IS NULL)
           OR EXISTS (SELECT 1 FROM result_file
               JOIN result ON result.id = result_file.result
               JOIN submission ON submission.id = result.submission
               WHERE result_file.digest = wanted.value AND submission.removed_at IS NULL)
           OR EXISTS (SELECT 1 FROM job_file JOIN job ON job.id = job_file.job
               WHERE job_file.digest = wanted.value AND job.state IN ('waiting', 'running'))
           OR EXISTS (SELECT 1 FROM result JOIN submission ON submission.id = result.submission
               WHERE {strpos}(result.task, '\"archive\":\"') > 0
                   AND substr(result.task, {strpos}(result.task, '\"archive\":\"') + 11, 64) = wanted.value
                   AND submission.removed_at IS NULL)";
    let rows = transaction.rows(statement, values![digests_json]).await?;
    let mut referenced: HashSet<Digest> =
        digests.iter().filter(|digest| suites.contains(digest.as_str())).cloned().collect();
    for row in &rows {
        referenced.extend(row.text("digest")?.parse::<Digest>());
    }
    Ok(referenced)
}

/// Returns the digests of suite archives that settings or unfinished jobs name.
async fn used_suites(transaction: &mut Transaction) -> Result<HashSet<String>, DbError> {
    let statement = "SELECT settings AS words FROM assignment UNION SELECT settings FROM campaign
        UNION SELECT substr(payload, {strpos}(payload, '\"archive\":\"') + 11, 64) FROM job
           WHERE state IN ('waiting', 'running') AND {strpos}(payload, '\"archive\":\"') > 0";
    let texts = transaction.rows(statement, values![]).await?;
    let mut digests = HashSet::new();
    for row in &texts {
        let text = row.text("words")?;
        let is_digest = |word: &&str| word.parse::<Digest>().is_ok();
        digests.extend(text.split(|c: char| !c.is_ascii_alphanumeric()).filter(is_digest).map(str::to_owned));
    }
    Ok(digests)
}
