//! Claiming.
use super::{Claim, Lane, Lease, Policy, millis};
use crate::{
    db::{DbError, Transaction},
    secret, values,
};

/// Claims the job whose turn it is, if there is one. A job on which this worker failed last is left to others for a
/// third of a lease: the fault may be the worker's. Two workers never get the same: the row is locked, and passed over
/// by others, until the caller commits.
///
/// # Errors
/// What the database says.
pub async fn claim(
    transaction: &mut Transaction,
    policy: &Policy,
    lane: Lane,
    worker: &str,
) -> Result<Option<Claim>, DbError> {
    let next = transaction
        .row(
            "SELECT id FROM job WHERE lane = ? AND state = 'waiting' AND run_after <= {now}
                AND (failed_by IS NULL OR failed_by <> ? OR run_after <= {now} - ?)
             ORDER BY rank, id LIMIT 1 {skip locked}",
            values![lane.name(), worker, millis(policy.lease / 3)],
        )
        .await?;
    let Some(next) = next else { return Ok(None) };
    let job = next.int("id")?;
    let key = secret::random_hex();
    let row = transaction
        .one(
            "UPDATE job SET state = 'running', attempt = attempt + 1, worker = ?, lease_key = ?,
                lease_until = {now} + ?, started_at = {now}
             WHERE id = ? RETURNING attempt, failures, submission, payload",
            values![worker, &key, millis(policy.lease), job],
        )
        .await?;
    Ok(Some(Claim {
        lease: Lease { job, attempt: row.int("attempt")?, key },
        submission: row.maybe_int("submission")?,
        payload: row.text("payload")?,
        failures: row.int("failures")?,
    }))
}

/// Whether something in a lane is to be looked at: a job whose turn has come, or one that somebody holds, and may have
/// let go of. Costs a reader's transaction only.
///
/// # Errors
/// What the database says.
pub async fn is_due(transaction: &mut Transaction, lane: Lane) -> Result<bool, DbError> {
    let row = transaction
        .row(
            "SELECT id FROM job WHERE lane = ? AND (
                (state = 'waiting' AND run_after <= {now}) OR (state = 'running' AND lease_until < {now})
             ) LIMIT 1",
            values![lane.name()],
        )
        .await?;
    Ok(row.is_some())
}
