//! How long uploads and reports are kept. Grades and their history stay for ever; bytes that nothing names any more go
//! away.
use crate::{
    db::{Database, DbError, Transaction},
    store::{Store, StoreError},
    values,
};
use std::{collections::BTreeSet, time::Duration};
use thiserror::Error;

/// Younger artefacts are left alone: they may be on their way to be named.
pub const LEAST_AGE: Duration = Duration::from_secs(24 * 3600);

/// Why nothing was given up, or not all.
#[derive(Debug, Error)]
pub enum RetentionError {
    /// The database says so.
    #[error(transparent)]
    Database(#[from] DbError),
    /// The store does.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// What was given up.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct GivenUp {
    /// Submissions whose upload and reports are not kept any more.
    pub submissions: u64,
    /// Artefacts that were removed.
    pub artefacts: usize,
}

/// Gives up uploads and reports of submissions that are older than `keep`, and artefacts older than `least` that
/// nothing names. Submissions that are being graded or regraded stay.
///
/// # Errors
/// What database or store say; the rest is given up the next time.
pub async fn give_up(
    database: &Database,
    store: &Store,
    keep: Duration,
    least: Duration,
) -> Result<GivenUp, RetentionError> {
    let keep = i64::try_from(keep.as_millis()).unwrap_or(i64::MAX);
    let mut transaction = database.begin().await?;
    let submissions = transaction
        .execute(
            "UPDATE submission SET removed_at = {now}
             WHERE removed_at IS NULL AND created_at <= {now} - ?
                AND NOT EXISTS (SELECT 1 FROM job
                    WHERE job.submission = submission.id AND job.state IN ('waiting', 'running'))
                AND NOT EXISTS (SELECT 1 FROM campaign
                    WHERE campaign.assignment = submission.assignment AND campaign.state = 'open')",
            values![keep],
        )
        .await?;
    if submissions > 0 {
        let text = format!("uploads and reports of {submissions} submissions are not kept any longer");
        transaction
            .execute("INSERT INTO event (happened_at, kind, text) VALUES ({now}, 'retention', ?)", values![text])
            .await?;
    }
    transaction.commit().await?;
    let mut transaction = database.read().await?;
    let named = named(&mut transaction).await?;
    drop(transaction);
    let artefacts = store.give_up(least, |digest| named.contains(digest)).await?;
    Ok(GivenUp { submissions, artefacts })
}

/// The digests that something names.
async fn named(transaction: &mut Transaction) -> Result<BTreeSet<String>, DbError> {
    let mut named = BTreeSet::new();
    let digests = transaction
        .rows(
            "SELECT digest FROM submission WHERE removed_at IS NULL
             UNION SELECT result_file.digest FROM result_file
                JOIN result ON result.id = result_file.result
                JOIN submission ON submission.id = result.submission WHERE submission.removed_at IS NULL
             UNION SELECT job_file.digest FROM job_file
                JOIN job ON job.id = job_file.job WHERE job.state IN ('waiting', 'running')",
            values![],
        )
        .await?;
    for row in &digests {
        named.insert(row.text("digest")?);
    }
    // Suites and uploads that are named within settings and tasks.
    let texts = transaction
        .rows(
            "SELECT settings AS words FROM assignment
             UNION SELECT settings FROM campaign
             UNION SELECT payload FROM job WHERE state IN ('waiting', 'running')
             UNION SELECT task FROM result
                JOIN submission ON submission.id = result.submission WHERE submission.removed_at IS NULL",
            values![],
        )
        .await?;
    for row in &texts {
        let words = row.text("words")?;
        let is_hex = |word: &&str| word.len() == 64 && word.bytes().all(|c| c.is_ascii_hexdigit());
        named.extend(words.split(|c: char| !c.is_ascii_alphanumeric()).filter(is_hex).map(str::to_owned));
    }
    Ok(named)
}
