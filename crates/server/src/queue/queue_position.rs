//! The position of a job in the queue, and the time until it is expected to be graded.
use super::{JobKind, QueuePolicy, millis};
use crate::{
    db::{DbError, Transaction},
    values,
};
use std::time::Duration;

/// The number of finished jobs from whose durations the expected time is computed.
const RECENT_JOBS: i64 = 50;

/// A waiting job's position in the queue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QueuePosition {
    /// The number of jobs that are ahead of this one.
    pub ahead: i64,
    /// The expected time until the job's result. It is computed from recent jobs and the slots of live workers; `None`
    /// if there are no recent jobs or no live workers.
    pub expected: Option<Duration>,
    /// Whether a worker is alive that can run the job.
    pub is_served: bool,
}

/// Returns a waiting job's position; `None` if it does not wait.
///
/// # Errors
///
/// Fails if the database cannot be read.
pub async fn find_queue_position(
    transaction: &mut Transaction,
    policy: &QueuePolicy,
    kind: JobKind,
    job: i64,
) -> Result<Option<QueuePosition>, DbError> {
    let job_row = transaction.row("SELECT rank FROM job WHERE id = ? AND state = 'waiting'", values![job]).await?;
    let Some(own) = job_row else { return Ok(None) };
    let rank = own.int("rank")?;
    let statement = "SELECT count(*) AS n FROM job
        WHERE lane = ? AND state = 'waiting' AND (rank < ? OR (rank = ? AND id < ?))";
    let ahead = transaction.one(statement, values![kind.name(), rank, rank, job]).await?.int("n")?;
    let usual_millis = usual_millis(transaction, kind).await?;
    let statement = "SELECT CAST(coalesce(sum(slots), 0) AS {int}) AS slots FROM worker
        WHERE seen_at > {now} - ? AND seen_at <= {now} + ?";
    let slots =
        transaction.one(statement, values![2 * millis(policy.lease), 2 * millis(policy.lease)]).await?.int("slots")?;
    let expected = usual_millis.filter(|_| slots > 0).map(|usual| {
        let rounds = ahead / slots + 1;
        Duration::from_millis(u64::try_from(rounds.saturating_mul(usual.max(1))).unwrap_or(0))
    });
    Ok(Some(QueuePosition { ahead, expected, is_served: slots > 0 }))
}

/// Returns the mean duration of recent jobs in milliseconds; `None` if there are none.
async fn usual_millis(transaction: &mut Transaction, kind: JobKind) -> Result<Option<i64>, DbError> {
    let statement = "SELECT CAST(avg(took) AS {int}) AS took FROM (
           SELECT finished_at - started_at AS took FROM job WHERE lane = ? AND state = 'done'
           ORDER BY finished_at DESC LIMIT ?
        ) AS recent";
    transaction.one(statement, values![kind.name(), RECENT_JOBS]).await?.maybe_int("took")
}

/// Returns the number of seconds, at least one, that a running job will still need; `None` if it already takes longer
/// than recent jobs, or does not run.
///
/// # Errors
///
/// Fails if the database cannot be read.
pub async fn find_time_left(transaction: &mut Transaction, kind: JobKind, job: i64) -> Result<Option<u64>, DbError> {
    let statement = "SELECT {now} - started_at AS took FROM job WHERE id = ? AND state = 'running'";
    let Some(row) = transaction.row(statement, values![job]).await? else { return Ok(None) };
    let remaining = usual_millis(transaction, kind).await?.unwrap_or(0) - row.int("took")?;
    Ok(u64::try_from(remaining).ok().map(|remaining| (remaining / 1000).max(1)))
}
