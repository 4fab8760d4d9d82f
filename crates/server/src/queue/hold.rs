//! What the holder of a lease may say. Everything is fenced: it counts only while the job runs under this very lease.
use super::{Lease, Policy, millis};
use crate::{
    db::{DbError, Transaction},
    values,
};
use std::time::Duration;

/// What became of a wish to finish.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Completion {
    /// The job is done; whoever called writes its result in the same transaction.
    Done,
    /// It was done by this very lease before: the answer got lost, not the result.
    Repeated,
    /// The lease was lost: nothing may be written.
    Late,
}

/// What became of a wish to give up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Failure {
    /// It waits again.
    Retried,
    /// That was its last try; whoever called writes what follows in the same transaction.
    Buried,
    /// The lease was lost before.
    Late,
}

/// Extends a lease from now on; false when it was lost, and the work is for nothing.
///
/// # Errors
/// What the database says.
pub async fn renew(transaction: &mut Transaction, policy: &Policy, lease: &Lease) -> Result<bool, DbError> {
    let changed = transaction
        .execute(
            "UPDATE job SET lease_until = {now} + ?
             WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running'",
            values![millis(policy.lease), lease.job, lease.attempt, &lease.key],
        )
        .await?;
    Ok(changed > 0)
}

/// Ends a job. A lease that ran out but was given to nobody else still counts: the work is done.
///
/// # Errors
/// What the database says.
pub async fn complete(transaction: &mut Transaction, lease: &Lease) -> Result<Completion, DbError> {
    // The key stays, so that the same answer sent twice is known again.
    let changed = transaction
        .execute(
            "UPDATE job SET state = 'done', finished_at = {now}, lease_until = NULL
             WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running'",
            values![lease.job, lease.attempt, &lease.key],
        )
        .await?;
    if changed > 0 {
        return Ok(Completion::Done);
    }
    let same = transaction
        .row(
            "SELECT id FROM job WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'done'",
            values![lease.job, lease.attempt, &lease.key],
        )
        .await?;
    Ok(if same.is_some() { Completion::Repeated } else { Completion::Late })
}

/// Gives a job back at no cost: its worker is asked to stop. False when the lease was lost.
///
/// # Errors
/// What the database says.
pub async fn release(transaction: &mut Transaction, lease: &Lease) -> Result<bool, DbError> {
    let changed = transaction
        .execute(
            "UPDATE job SET state = 'waiting', run_after = {now}, worker = NULL, lease_key = NULL, lease_until = NULL
             WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running'",
            values![lease.job, lease.attempt, &lease.key],
        )
        .await?;
    Ok(changed > 0)
}

/// Says that this try came to nothing, and why.
///
/// # Errors
/// What the database says.
pub async fn fail(
    transaction: &mut Transaction,
    policy: &Policy,
    lease: &Lease,
    fault: &str,
) -> Result<Failure, DbError> {
    fail_for(transaction, policy, lease, fault, Duration::ZERO).await
}

/// The same, and the next try comes no sooner than `least` from now.
///
/// # Errors
/// What the database says.
pub async fn fail_for(
    transaction: &mut Transaction,
    policy: &Policy,
    lease: &Lease,
    fault: &str,
    least: Duration,
) -> Result<Failure, DbError> {
    let held = transaction
        .row(
            "SELECT failures FROM job
             WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running' {for update}",
            values![lease.job, lease.attempt, &lease.key],
        )
        .await?;
    match held {
        None => Ok(Failure::Late),
        Some(row) => lose(transaction, policy, lease.job, row.int("failures")? + 1, fault, least).await,
    }
}

/// Counts a failure of a job whose row is locked by this transaction.
pub(super) async fn lose(
    transaction: &mut Transaction,
    policy: &Policy,
    job: i64,
    failures: i64,
    fault: &str,
    least: Duration,
) -> Result<Failure, DbError> {
    if failures >= i64::from(policy.max_failures) {
        transaction
            .execute(
                "UPDATE job SET state = 'buried', failures = ?, finished_at = {now}, lease_key = NULL,
                    lease_until = NULL, last_fault = ?
                 WHERE id = ?",
                values![failures, fault, job],
            )
            .await?;
        return Ok(Failure::Buried);
    }
    transaction
        .execute(
            "UPDATE job SET state = 'waiting', failures = ?, run_after = {now} + ?, failed_by = worker, worker = NULL,
                lease_key = NULL, lease_until = NULL, last_fault = ?
             WHERE id = ?",
            values![failures, millis(policy.wait(failures).max(least)), fault, job],
        )
        .await?;
    Ok(Failure::Retried)
}
