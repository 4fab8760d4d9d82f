//! Puts jobs into the queue, with their ranks.
//!
//! A job's **rank** is a time by which jobs are ordered. The rank of a student's first waiting job is the present time.
//! Each further job has a rank that is later by [`JobOwner::Student`]'s spacing, so that twenty uploads of one student
//! do not delay another student's first upload. Jobs of a regrade get later ranks than uploads that arrive at the same
//! time; each is later than the one before. Ranks never change, so only a bounded number of other jobs can pass a
//! waiting job. Therefore no aging is needed, and a job's position in the queue is the number of jobs with a smaller
//! rank.
use super::JobKind;
use crate::{
    db::{DbError, Transaction},
    values,
};

/// The owner of a job. Owners take turns, so that no owner's jobs delay all others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JobOwner {
    /// A student who uploaded a submission; the value is the account's ID.
    Student(i64),
    /// A regrade; the value is its ID.
    Regrade(i64),
    /// A score that a platform receives; the values are the IDs of the link and of the account.
    Score(i64, i64),
}

impl JobOwner {
    /// Returns the delay between consecutive jobs of one owner, in milliseconds.
    pub(crate) fn spacing_millis(self) -> i64 {
        match self {
            Self::Student(_) => 600_000,
            Self::Regrade(_) => 20_000,
            Self::Score(..) => 0,
        }
    }

    /// Returns how much later than an upload of the same time the owner's first job is ranked, in milliseconds.
    fn delay_millis(self) -> i64 {
        match self {
            Self::Student(_) | Self::Score(..) => 0,
            Self::Regrade(_) => 1_800_000,
        }
    }

    /// Returns the rank of the owner's next job.
    pub(crate) async fn next(self, transaction: &mut Transaction) -> Result<i64, DbError> {
        // Two simultaneous uploads of one student may get the same rank. Then the job with the smaller ID is first.
        let statement = "SELECT max(rank) AS last, {now} AS now FROM job
            WHERE fair_key = ? AND state IN ('waiting', 'running')";
        let last = transaction.one(statement, values![self.key()]).await?;
        let earliest = last.int("now")? + self.delay_millis();
        Ok(last.maybe_int("last")?.map_or(earliest, |last| earliest.max(last + self.spacing_millis())))
    }

    pub(crate) fn key(self) -> String {
        match self {
            Self::Student(account) => format!("student {account}"),
            Self::Regrade(id) => format!("campaign {id}"),
            Self::Score(link, account) => format!("score {link} {account}"),
        }
    }
}

/// A job for the queue.
#[derive(Debug, Clone)]
pub struct NewJob<'a> {
    /// The kind of the job.
    pub kind: JobKind,
    /// The ID of the submission that is graded; `None` for other kinds of jobs.
    pub submission: Option<i64>,
    /// The ID of the regrade to which the job belongs, if any.
    pub regrade_id: Option<i64>,
    /// The owner of the job, which determines its rank.
    pub owner: JobOwner,
    /// The task as text, in the form that the worker reads.
    pub payload: &'a str,
}

/// Enqueues a job within the caller's transaction and returns its ID. Workers are notified by
/// [`super::Notifier::commit`].
///
/// # Errors
/// Fails if the database cannot be changed.
pub async fn enqueue(transaction: &mut Transaction, job: &NewJob<'_>) -> Result<i64, DbError> {
    let key = job.owner.key();
    let rank = job.owner.next(transaction).await?;
    let statement =
        "INSERT INTO job (lane, submission, campaign, fair_key, payload, state, rank, run_after, enqueued_at)
        VALUES (?, ?, ?, ?, ?, 'waiting', ?, {now}, {now}) RETURNING id";
    let row = transaction
        .one(statement, values![job.kind.name(), job.submission, job.regrade_id, key, job.payload, rank])
        .await?;
    row.int("id")
}

/// Returns whether a job of this owner is waiting, and stays so until the caller's transaction ends. In that case no
/// further job is needed.
///
/// # Errors
///
/// Fails if the database cannot be read.
pub async fn is_waiting(transaction: &mut Transaction, owner: JobOwner) -> Result<bool, DbError> {
    let statement = "SELECT id FROM job WHERE fair_key = ? AND state = 'waiting' LIMIT 1 {for update}";
    let row = transaction.row(statement, values![owner.key()]).await?;
    Ok(row.is_some())
}
