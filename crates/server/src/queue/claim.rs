//! Claims jobs for workers.
use super::{Claim, JobKind, Lease, QueuePolicy, millis};
use crate::{
    db::{DbError, Transaction, read_row},
    secret, values,
};

/// The worker that claims a job.
#[derive(Debug, Clone, Copy)]
pub struct Claimant<'a> {
    /// The worker's name.
    pub worker: &'a str,
    /// The ID of the token with which the worker signed in; `None` for the server's own workers.
    pub token_id: Option<i64>,
}

/// Claims the next job; `None` if there is no job. If this worker was the last one that failed on a job, the job is
/// left to other workers for a third of a lease, because this worker may be at fault. Two workers never get the same
/// job: until the caller commits, the job's row is locked, and other workers skip it.
///
/// # Errors
///
/// Fails if the database cannot be changed.
pub async fn claim(
    transaction: &mut Transaction,
    policy: &QueuePolicy,
    kind: JobKind,
    claimant: Claimant<'_>,
) -> Result<Option<Claim>, DbError> {
    let Claimant { worker, token_id } = claimant;
    let statement = "SELECT id FROM job WHERE lane = ? AND state = 'waiting' AND run_after <= {now}
            AND (failed_by IS NULL OR failed_by <> ? OR run_after <= {now} - ?)
        ORDER BY rank, id LIMIT 1 {skip locked}";
    let next = transaction.row(statement, values![kind.name(), worker, millis(policy.lease / 3)]).await?;
    let Some(next) = next else { return Ok(None) };
    let job = next.int("id")?;
    let key = secret::random_hex();
    let statement = "UPDATE job SET state = 'running', attempt = attempt + 1, worker = ?, lease_key = ?,
           lease_until = {now} + ?, started_at = {now}, scenes_done = NULL, scenes = NULL, token = ?
        WHERE id = ? RETURNING attempt, failures, deaths, submission, payload";
    let row = transaction.one(statement, values![worker, &key, millis(policy.lease), token_id, job]).await?;
    let lease = Lease { job, attempt: row.int("attempt")?, key };
    let row = &row;
    Ok(Some(read_row!(row => Claim { submission, payload, failures, deaths; lease })))
}

/// Returns whether a job in this lane may be ready: a job that waits, or a running job whose lease may have expired.
/// This needs only a read transaction.
///
/// # Errors
///
/// Fails if the database cannot be read.
pub async fn is_due(transaction: &mut Transaction, kind: JobKind) -> Result<bool, DbError> {
    let statement = "SELECT id FROM job WHERE lane = ? AND (
           (state = 'waiting' AND run_after <= {now}) OR (state = 'running' AND lease_until < {now})
        ) LIMIT 1";
    Ok(transaction.row(statement, values![kind.name()]).await?.is_some())
}
