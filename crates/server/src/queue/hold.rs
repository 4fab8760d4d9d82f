//! The reports of a worker that has a lease. Each counts only while the job runs under this lease.
use super::{Lease, MAX_PLATFORM_WAIT, QueuePolicy, millis};
use crate::{
    db::{DbError, Row, Transaction},
    values,
};
use serde::{Deserialize, Serialize};
use std::time::Duration;
use utoipa::ToSchema;

/// The result of reporting a job as finished.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Completion {
    /// The job is finished, and the caller must write its result in the same transaction.
    Done,
    /// The job was already finished under the same lease, but the worker did not receive the answer.
    Repeated,
    /// The lease was lost, so nothing may be written.
    Late,
}

/// The result of reporting a failed try.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Failure {
    /// The job waits again.
    Retried,
    /// The job has no tries left; the caller writes the failure in the same transaction.
    Buried,
    /// The lease was lost before the report.
    Late,
}

/// The progress of a grading, in scenes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Progress {
    /// The number of scenes with a verdict.
    #[schema(maximum = 1_000_000)]
    pub done: u32,
    /// The number of scenes in the grading.
    #[schema(maximum = 1_000_000)]
    pub all: u32,
}

/// Extends a lease, up to a maximum age of the claim, and stores the worker's progress, if it is reported. Returns
/// `false` if the lease was lost; the worker should then stop.
///
/// # Errors
///
/// Fails if the database fails.
pub async fn renew(
    transaction: &mut Transaction,
    policy: &QueuePolicy,
    lease: &Lease,
    progress: Option<Progress>,
    most: Duration,
) -> Result<bool, DbError> {
    let (done, all) = progress.map(|Progress { done, all }| (i64::from(done), i64::from(all))).unzip();
    let statement = "UPDATE job SET lease_until = {now} + ?, scenes_done = coalesce(?, scenes_done),
           scenes = coalesce(?, scenes)
        WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running' AND started_at >= {now} - ?";
    let values = values![millis(policy.lease), done, all, lease.job, lease.attempt, &lease.key, millis(most)];
    Ok(transaction.execute(statement, values).await? > 0)
}

/// Returns the task of a leased job; `None` if the lease was lost.
///
/// # Errors
///
/// Fails if the database fails.
pub async fn payload(transaction: &mut Transaction, lease: &Lease) -> Result<Option<String>, DbError> {
    let statement = "SELECT payload FROM job WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running'";
    let row = transaction.row(statement, values![lease.job, lease.attempt, &lease.key]).await?;
    row.map(|row| row.text("payload")).transpose()
}

/// Ends a job. An expired lease still counts if no other worker got the job, because the work is done.
///
/// # Errors
///
/// Fails if the database fails.
pub async fn complete(transaction: &mut Transaction, lease: &Lease) -> Result<Completion, DbError> {
    // The key stays, so that a repeated report is recognized.
    let statement = "UPDATE job SET state = 'done', finished_at = {now}, lease_until = NULL
        WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running'";
    let changed = transaction.execute(statement, values![lease.job, lease.attempt, &lease.key]).await?;
    if changed > 0 {
        return Ok(Completion::Done);
    }
    let statement = "SELECT id FROM job WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'done'";
    let same = transaction.row(statement, values![lease.job, lease.attempt, &lease.key]).await?;
    Ok(if same.is_some() { Completion::Repeated } else { Completion::Late })
}

/// Returns a job without counting a failure, because its worker must stop. Returns `false` if the lease was lost.
///
/// # Errors
///
/// Fails if the database fails.
pub async fn release(transaction: &mut Transaction, lease: &Lease) -> Result<bool, DbError> {
    let statement =
        "UPDATE job SET state = 'waiting', run_after = {now}, worker = NULL, lease_key = NULL, lease_until = NULL
        WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running'";
    let changed = transaction.execute(statement, values![lease.job, lease.attempt, &lease.key]).await?;
    Ok(changed > 0)
}

/// Records that a try failed, with the reason. The next try begins after `least` at the earliest.
///
/// # Errors
///
/// Fails if the database fails.
pub async fn fail(
    transaction: &mut Transaction,
    policy: &QueuePolicy,
    lease: &Lease,
    fault: &str,
    least: Duration,
) -> Result<Failure, DbError> {
    let statement = "SELECT failures, deaths FROM job
        WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running' {for update}";
    let held = transaction.row(statement, values![lease.job, lease.attempt, &lease.key]).await?;
    let Some(row) = held else { return Ok(Failure::Late) };
    let failures = row.int("failures")? + 1;
    let (deaths, wait) = (row.int("deaths")?, policy.retry_delay(failures).max(least).min(MAX_PLATFORM_WAIT));
    let loss = Loss { job: lease.job, failures, deaths, wait, fault };
    lose_job(transaction, loss, failures >= i64::from(policy.max_failures)).await
}

/// A failed try, with the updated counts of its job.
struct Loss<'a> {
    job: i64,
    failures: i64,
    deaths: i64,
    /// The wait before the next try.
    wait: Duration,
    fault: &'a str,
}

/// Records that the worker of a job was lost. This transaction has locked `row`, which contains the job's counts.
pub(super) async fn give_up_worker(
    transaction: &mut Transaction,
    policy: &QueuePolicy,
    row: &Row,
    fault: &str,
) -> Result<Failure, DbError> {
    let (failures, deaths) = (row.int("failures")?, row.int("deaths")? + 1);
    let loss = Loss { job: row.int("id")?, failures, deaths, wait: policy.wait_after_death(deaths), fault };
    lose_job(transaction, loss, deaths >= policy.max_deaths()).await
}

/// Gives a job up after its last try, or lets it wait again.
async fn lose_job(transaction: &mut Transaction, loss: Loss<'_>, is_last: bool) -> Result<Failure, DbError> {
    let Loss { job, failures, deaths, wait, fault } = loss;
    if is_last {
        let statement = "UPDATE job SET state = 'buried', failures = ?, deaths = ?, finished_at = {now},
               lease_key = NULL, lease_until = NULL, last_fault = ?
            WHERE id = ?";
        transaction.execute(statement, values![failures, deaths, fault, job]).await?;
        return Ok(Failure::Buried);
    }
    let statement = "UPDATE job SET state = 'waiting', failures = ?, deaths = ?, run_after = {now} + ?,
           failed_by = worker, worker = NULL, lease_key = NULL, lease_until = NULL, last_fault = ?
        WHERE id = ?";
    transaction.execute(statement, values![failures, deaths, millis(wait), fault, job]).await?;
    Ok(Failure::Retried)
}
