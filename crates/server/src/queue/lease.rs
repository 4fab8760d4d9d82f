//! The messages of a worker that has a lease. A message counts only while the job runs under this lease.
use super::{Lease, MAX_PLATFORM_WAIT, QueuePolicy, millis};
use crate::{
    db::{DbError, Row, Transaction},
    values,
};
use serde::{Deserialize, Serialize};
use std::time::Duration;
use utoipa::ToSchema;

/// The effect of reporting that a job is finished.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CompletionEffect {
    /// The job is finished, and the caller must write its result in the same transaction.
    Done,
    /// The worker had already finished the job under the same lease, but did not receive the answer.
    Repeated,
    /// The lease was lost, so nothing may be written.
    Late,
}

/// The effect of reporting that a try failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FailureEffect {
    /// The job waits for another try.
    Retried,
    /// The job has no tries left. The caller must write the failure in the same transaction.
    GivenUp,
    /// The lease was lost before the worker reported the failure.
    Late,
}

/// The progress of a grading, counted in scenes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Progress {
    /// The number of scenes that have a verdict.
    #[schema(maximum = 1_000_000)]
    pub done: u32,
    /// The total number of scenes in the grading.
    #[schema(maximum = 1_000_000)]
    pub all: u32,
}

/// Extends a lease, but not beyond a maximum age of the claim. Stores the progress if the worker reports it. Returns
/// `false` if the lease was lost; the worker should then stop.
///
/// # Errors
///
/// Fails if the database cannot be changed.
pub async fn renew(
    transaction: &mut Transaction,
    policy: &QueuePolicy,
    lease: &Lease,
    progress: Option<Progress>,
    max_age: Duration,
) -> Result<bool, DbError> {
    let (done, all) = progress.map(|Progress { done, all }| (i64::from(done), i64::from(all))).unzip();
    let statement = "UPDATE job SET lease_until = {now} + ?, scenes_done = coalesce(?, scenes_done),
           scenes = coalesce(?, scenes)
        WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running' AND started_at >= {now} - ?";
    let values = values![millis(policy.lease), done, all, lease.job, lease.attempt, &lease.key, millis(max_age)];
    Ok(transaction.execute(statement, values).await? > 0)
}

/// Returns the task of a leased job; `None` if the lease was lost.
///
/// # Errors
///
/// Fails if the database cannot be read.
pub async fn payload(transaction: &mut Transaction, lease: &Lease) -> Result<Option<String>, DbError> {
    let statement = "SELECT payload FROM job WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running'";
    let row = transaction.row(statement, values![lease.job, lease.attempt, &lease.key]).await?;
    row.map(|row| row.text("payload")).transpose()
}

/// Ends a job. If the lease has expired but no other worker has the job, the result still counts, because the work is
/// done.
///
/// # Errors
///
/// Fails if the database cannot be changed.
pub async fn complete(transaction: &mut Transaction, lease: &Lease) -> Result<CompletionEffect, DbError> {
    // The lease's key stays in the row, so that a repeated report is recognized.
    let statement = "UPDATE job SET state = 'done', finished_at = {now}, lease_until = NULL
        WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running'";
    let changed = transaction.execute(statement, values![lease.job, lease.attempt, &lease.key]).await?;
    if changed > 0 {
        return Ok(CompletionEffect::Done);
    }
    let statement = "SELECT id FROM job WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'done'";
    let same = transaction.row(statement, values![lease.job, lease.attempt, &lease.key]).await?;
    Ok(if same.is_some() { CompletionEffect::Repeated } else { CompletionEffect::Late })
}

/// Gives a job back to the queue because its worker must stop. This does not count as a failure. Returns `false` if the
/// lease was lost.
///
/// # Errors
///
/// Fails if the database cannot be changed.
pub async fn release(transaction: &mut Transaction, lease: &Lease) -> Result<bool, DbError> {
    let statement =
        "UPDATE job SET state = 'waiting', run_after = {now}, worker = NULL, lease_key = NULL, lease_until = NULL
        WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running'";
    let changed = transaction.execute(statement, values![lease.job, lease.attempt, &lease.key]).await?;
    Ok(changed > 0)
}

/// Records that a try failed, and why. The next try begins after `min_wait` at the earliest.
///
/// # Errors
///
/// Fails if the database cannot be changed.
pub async fn fail(
    transaction: &mut Transaction,
    policy: &QueuePolicy,
    lease: &Lease,
    fault: &str,
    min_wait: Duration,
) -> Result<FailureEffect, DbError> {
    let statement = "SELECT failures, deaths FROM job
        WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running' {for update}";
    let leased = transaction.row(statement, values![lease.job, lease.attempt, &lease.key]).await?;
    let Some(row) = leased else { return Ok(FailureEffect::Late) };
    let failures = row.int("failures")? + 1;
    let (deaths, wait) = (row.int("deaths")?, policy.retry_delay(failures).max(min_wait).min(MAX_PLATFORM_WAIT));
    let failed_try = FailedTry { job: lease.job, failures, deaths, wait, fault };
    end_try(transaction, failed_try, failures >= i64::from(policy.max_failures)).await
}

/// A failed try of a job, with the updated counts of failures.
struct FailedTry<'a> {
    job: i64,
    failures: i64,
    deaths: i64,
    /// The minimum time until the next try.
    wait: Duration,
    fault: &'a str,
}

/// Records that a job's worker was lost. The transaction must have locked the job, whose counts are in `row`.
pub(super) async fn give_up_worker(
    transaction: &mut Transaction,
    policy: &QueuePolicy,
    row: &Row,
    fault: &str,
) -> Result<FailureEffect, DbError> {
    let (failures, deaths) = (row.int("failures")?, row.int("deaths")? + 1);
    let failed_try = FailedTry { job: row.int("id")?, failures, deaths, wait: policy.wait_after_death(deaths), fault };
    end_try(transaction, failed_try, deaths >= policy.max_deaths()).await
}

/// Gives a job up if this was its last try, or lets it wait for another.
async fn end_try(transaction: &mut Transaction, loss: FailedTry<'_>, is_last: bool) -> Result<FailureEffect, DbError> {
    let FailedTry { job, failures, deaths, wait, fault } = loss;
    if is_last {
        let statement = "UPDATE job SET state = 'buried', failures = ?, deaths = ?, finished_at = {now},
               lease_key = NULL, lease_until = NULL, last_fault = ?
            WHERE id = ?";
        transaction.execute(statement, values![failures, deaths, fault, job]).await?;
        return Ok(FailureEffect::GivenUp);
    }
    let statement = "UPDATE job SET state = 'waiting', failures = ?, deaths = ?, run_after = {now} + ?,
           failed_by = worker, worker = NULL, lease_key = NULL, lease_until = NULL, last_fault = ?
        WHERE id = ?";
    transaction.execute(statement, values![failures, deaths, millis(wait), fault, job]).await?;
    Ok(FailureEffect::Retried)
}
