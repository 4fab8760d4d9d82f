//! Finds workers that stopped responding.
//!
//! Every live process ticks, and leases expire only while a process ticks. A gap between ticks means that the database
//! was unavailable, so that no worker could renew its lease. All leases then start again. Therefore a restart of
//! PostgreSQL does not count as a failure of any job.
use super::{FailureEffect, QueuePolicy, lease::give_up_worker, millis};
use crate::{
    db::{DbError, Row, Transaction},
    values,
};

/// The fault that is recorded for a job whose lease expired.
const NO_ANSWER: &str = "the worker stopped responding";

/// The changes that a tick made.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Tick {
    /// The number of jobs that wait again.
    pub retried: usize,
    /// The jobs that were given up, because their workers were lost too often. The caller must write the failures in
    /// the same transaction.
    pub given_up: Vec<GivenUpJob>,
    /// Whether all leases started again, because no process had ticked for a while.
    pub outage: bool,
}

/// A job that was given up, because its workers were lost too often.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GivenUpJob {
    /// The job's ID.
    pub job: i64,
    /// The number of the job's last claim, from 1.
    pub attempt: i64,
    /// The name of the job's last worker.
    pub worker: String,
    /// The reason why the last try failed.
    pub fault: String,
}

/// Ends the leases of workers that stopped responding. This happens at most once per [`QueuePolicy::tick_interval`], no
/// matter how many processes call it.
///
/// # Errors
///
/// Fails if the database cannot be changed.
pub async fn tick(transaction: &mut Transaction, policy: &QueuePolicy) -> Result<Tick, DbError> {
    let pulse =
        transaction.row("SELECT beat_at, {now} AS now FROM pulse WHERE id = 1 {skip locked}", values![]).await?;
    // Another process is searching at the moment.
    let Some(pulse) = pulse else { return Ok(Tick::default()) };
    let (beat, now) = (pulse.int("beat_at")?, pulse.int("now")?);
    if (0..millis(policy.tick_interval())).contains(&(now - beat)) {
        return Ok(Tick::default());
    }
    transaction.execute("UPDATE pulse SET beat_at = {now} WHERE id = 1", values![]).await?;
    // If the clock was set back, or far ahead, that also counts as an outage.
    if now < beat || now - beat > millis(policy.outage_gap()) {
        let statement = "WITH held AS (SELECT id FROM job WHERE state = 'running' ORDER BY id {for update})
            UPDATE job SET lease_until = {now} + ?, started_at = {now}
            WHERE id IN (SELECT id FROM held) AND state = 'running'";
        transaction.execute(statement, values![millis(policy.lease)]).await?;
        return Ok(Tick { outage: true, ..Tick::default() });
    }
    let statement = "SELECT id, attempt, failures, deaths, worker FROM job
        WHERE state = 'running' AND lease_until < {now} ORDER BY id {skip locked}";
    let expired_jobs = transaction.rows(statement, values![]).await?;
    give_up_workers(transaction, policy, expired_jobs).await
}

async fn give_up_workers(
    transaction: &mut Transaction,
    policy: &QueuePolicy,
    expired_jobs: Vec<Row>,
) -> Result<Tick, DbError> {
    let mut tick = Tick::default();
    for row in expired_jobs {
        let (job, attempt) = (row.int("id")?, row.int("attempt")?);
        let worker = row.maybe_text("worker")?.unwrap_or_default();
        match give_up_worker(transaction, policy, &row, NO_ANSWER).await? {
            FailureEffect::GivenUp => tick.given_up.push(GivenUpJob { job, attempt, worker, fault: NO_ANSWER.into() }),
            FailureEffect::Retried | FailureEffect::Late => tick.retried += 1,
        }
    }
    Ok(tick)
}
