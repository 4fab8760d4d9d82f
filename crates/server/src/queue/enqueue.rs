//! Puts jobs into the queue, with their ranks.
//!
//! A job's **rank** is a time by which jobs are ordered. For the first waiting job of a student it is the present; each
//! further one is later by [`Turn::Student`]'s spacing, so that twenty uploads of one student do not delay another
//! student's first upload. Jobs of a regrade get a later rank than uploads of the same time, and increasing ranks among
//! themselves. Ranks never change, so only a bounded number of other jobs can pass a waiting job. No aging is needed,
//! and the position of a job in the queue is a count.
use super::Lane;
use crate::{
    db::{DbError, Transaction},
    values,
};

/// The owner of a job, by whom jobs take turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Turn {
    /// A student with an upload; the value is the account.
    Student(i64),
    /// A regrade.
    Campaign(i64),
    /// A score of an account for a platform's link.
    Score(i64, i64),
}

impl Turn {
    /// Returns the delay between consecutive jobs of one owner, in milliseconds.
    pub(crate) fn spacing_millis(self) -> i64 {
        match self {
            Self::Student(_) => 600_000,
            Self::Campaign(_) => 20_000,
            Self::Score(..) => 0,
        }
    }

    /// Returns the delay of the owner's first job after an upload of the same time, in milliseconds.
    fn delay_millis(self) -> i64 {
        match self {
            Self::Student(_) | Self::Score(..) => 0,
            Self::Campaign(_) => 1_800_000,
        }
    }

    /// Returns the rank of the owner's next job.
    pub(crate) async fn next(self, transaction: &mut Transaction) -> Result<i64, DbError> {
        // Two simultaneous uploads of one student may have the same rank; then the number decides.
        let statement = "SELECT max(rank) AS last, {now} AS now FROM job
            WHERE fair_key = ? AND state IN ('waiting', 'running')";
        let last = transaction.one(statement, values![self.key()]).await?;
        let own = last.int("now")? + self.delay_millis();
        Ok(last.maybe_int("last")?.map_or(own, |last| own.max(last + self.spacing_millis())))
    }

    pub(crate) fn key(self) -> String {
        match self {
            Self::Student(account) => format!("student {account}"),
            Self::Campaign(campaign) => format!("campaign {campaign}"),
            Self::Score(link, account) => format!("score {link} {account}"),
        }
    }
}

/// A job for the queue.
#[derive(Debug, Clone)]
pub struct NewJob<'a> {
    /// The lane that does the work.
    pub lane: Lane,
    /// The submission of the job.
    pub submission: Option<i64>,
    /// The regrade of the job.
    pub campaign: Option<i64>,
    /// The owner of the job.
    pub turn: Turn,
    /// The task, in the form for the worker.
    pub payload: &'a str,
}

/// Enqueues a job within the caller's transaction and returns its number. Workers are notified by
/// [`super::Notifier::commit`].
///
/// # Errors
/// Fails if the database fails.
pub async fn enqueue(transaction: &mut Transaction, job: &NewJob<'_>) -> Result<i64, DbError> {
    let key = job.turn.key();
    let rank = job.turn.next(transaction).await?;
    let statement =
        "INSERT INTO job (lane, submission, campaign, fair_key, payload, state, rank, run_after, enqueued_at)
        VALUES (?, ?, ?, ?, ?, 'waiting', ?, {now}, {now}) RETURNING id";
    let row = transaction
        .one(statement, values![job.lane.name(), job.submission, job.campaign, key, job.payload, rank])
        .await?;
    row.int("id")
}

/// Returns whether a job of this owner is waiting and stays so until the caller's transaction ends. Then no further job
/// is needed.
///
/// # Errors
///
/// Fails if the database fails.
pub async fn is_waiting(transaction: &mut Transaction, turn: Turn) -> Result<bool, DbError> {
    let statement = "SELECT id FROM job WHERE fair_key = ? AND state = 'waiting' LIMIT 1 {for update}";
    let row = transaction.row(statement, values![turn.key()]).await?;
    Ok(row.is_some())
}
