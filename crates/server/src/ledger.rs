//! Writes the results of jobs: grades and their history. Each is written in the transaction that ends its job.
use crate::{
    db::{Database, DbError, Transaction, read_row},
    health,
    lti::score,
    queue::{self, CompletionEffect, FailureEffect, GivenUpJob, Lease, QueuePolicy},
    task::{JUDGE_ERROR, Outcome, format_points},
    values,
};
use std::time::Duration;

/// Writes the result of a job if its lease is still valid. A result that arrives too late is recorded, but changes
/// nothing.
///
/// # Errors
///
/// Fails if the database cannot be changed. In that case the caller must not commit.
pub async fn finish(
    transaction: &mut Transaction,
    lease: &Lease,
    outcome: &Outcome,
) -> Result<CompletionEffect, DbError> {
    let completion = queue::complete(transaction, lease).await?;
    match completion {
        CompletionEffect::Done => {
            let about = write_result(transaction, lease.job, lease.attempt, outcome).await?;
            health::record_result(transaction, &about.worker).await?;
        }
        CompletionEffect::Late => log_late(transaction, lease, &format!("a result, {}", outcome.verdict)).await?,
        CompletionEffect::Repeated => {}
    }
    Ok(completion)
}

/// Records that a try failed. After the last try, the verdict "judge error" is written.
///
/// # Errors
///
/// Fails if the database cannot be changed.
pub async fn fail(
    transaction: &mut Transaction,
    policy: &QueuePolicy,
    lease: &Lease,
    fault: &str,
) -> Result<FailureEffect, DbError> {
    let fault = &health::strip_paths(fault);
    let failure = queue::fail(transaction, policy, lease, fault, Duration::ZERO).await?;
    if failure == FailureEffect::Late {
        log_late(transaction, lease, "a failure").await?;
        return Ok(failure);
    }
    let row = find_job(transaction, lease.job).await?;
    if failure == FailureEffect::GivenUp {
        fail_job(transaction, lease.job, lease.attempt, fault).await?;
    } else {
        log_event(transaction, &row, "failed try", fault).await?;
    }
    // The worker's row is locked last, as in `finish`, so that no deadlock is possible.
    health::record_failure(transaction, &row.worker, fault).await?;
    Ok(failure)
}

/// Finds silent workers. Jobs that were tried too often get the verdict "judge error". This uses its own transaction:
/// it locks the jobs of other workers, so it must not wait for locks that they hold.
///
/// # Errors
///
/// Fails if the database cannot be changed.
pub async fn tick(database: &Database, policy: &QueuePolicy) -> Result<(), DbError> {
    let mut transaction = database.begin().await?;
    let tick = queue::tick(&mut transaction, policy).await?;
    record_given_up(&mut transaction, &tick.given_up).await?;
    transaction.commit().await?;
    if tick.outage {
        tracing::warn!("the queue was not served for a while, so all leases begin again");
    }
    if tick.retried > 0 {
        tracing::warn!(jobs = tick.retried, "jobs of silent workers wait again");
    }
    for job in &tick.given_up {
        tracing::error!(job = job.job, worker = job.worker, fault = job.fault, "a job was tried too often");
    }
    Ok(())
}

/// A job, with details of its submission.
struct JobDetails {
    job: i64,
    submission: Option<i64>,
    regrade_id: Option<i64>,
    assignment: Option<i64>,
    course: Option<i64>,
    worker: String,
    /// The account that requested the job's regrade.
    asked_by: Option<i64>,
    task: String,
    seconds: i64,
}

async fn find_job(transaction: &mut Transaction, job: i64) -> Result<JobDetails, DbError> {
    let statement = "SELECT job.submission, job.campaign, job.payload, job.asked_by,
                coalesce(job.worker, job.failed_by, '') AS worker,
           submission.assignment, assignment.course,
           {now} - coalesce(job.started_at, {now}) AS took
        FROM job
        LEFT JOIN submission ON submission.id = job.submission
        LEFT JOIN assignment ON assignment.id = submission.assignment
        WHERE job.id = ?";
    let row = &transaction.one(statement, values![job]).await?;
    let seconds = row.int("took")? / 1000;
    Ok(read_row!(row => JobDetails {
        submission, assignment, course, worker, asked_by, regrade_id = "campaign", task = "payload"; job, seconds
    }))
}

/// Writes an entry about a job into the audit log.
async fn log_event(transaction: &mut Transaction, about: &JobDetails, kind: &str, text: &str) -> Result<(), DbError> {
    let statement = "INSERT INTO event (happened_at, kind, course, assignment, submission, job, text)
        VALUES ({now}, ?, ?, ?, ?, ?, ?)";
    transaction
        .execute(statement, values![kind, about.course, about.assignment, about.submission, about.job, text])
        .await?;
    Ok(())
}

/// Records and counts a worker's message that arrived too late. The message has no other effect. If the job does not
/// exist, the message is not counted.
async fn log_late(transaction: &mut Transaction, lease: &Lease, what: &str) -> Result<(), DbError> {
    let known_claim =
        transaction.row("SELECT id FROM job WHERE id = ? AND attempt >= ?", values![lease.job, lease.attempt]).await?;
    if known_claim.is_some() {
        let row = find_job(transaction, lease.job).await?;
        log_event(transaction, &row, "late answer", &format!("{what}, of attempt {}", lease.attempt)).await?;
    }
    Ok(())
}

async fn record_given_up(transaction: &mut Transaction, jobs: &[GivenUpJob]) -> Result<(), DbError> {
    for job in jobs {
        fail_job(transaction, job.job, job.attempt, &job.fault).await?;
    }
    Ok(())
}

async fn fail_job(transaction: &mut Transaction, job: i64, attempt: i64, fault: &str) -> Result<(), DbError> {
    let row = write_result(transaction, job, attempt, &Outcome::judge_error()).await?;
    if row.submission.is_none() && score::record_failure(transaction, &row.task, fault).await? {
        return Ok(());
    }
    log_event(transaction, &row, "buried", fault).await
}

/// Writes a result. It also becomes the grade, unless it belongs to a regrade on which staff have not decided.
async fn write_result(
    transaction: &mut Transaction,
    job: i64,
    attempt: i64,
    outcome: &Outcome,
) -> Result<JobDetails, DbError> {
    let about = find_job(transaction, job).await?;
    // Only grading jobs have a result.
    let Some(submission_id) = about.submission else { return Ok(about) };
    let seconds = if outcome.code == JUDGE_ERROR { about.seconds.to_string() } else { outcome.seconds.clone() };
    let statement =
        "INSERT INTO result (job, submission, campaign, attempt, worker, verdict, code, points, max_points, summary,
           version, task, seconds, grader, shown, failed, parts, created_at)
        VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, {now}) RETURNING id";
    let result_id = transaction
        .one(
            statement,
            values![
                job,
                submission_id,
                about.regrade_id,
                attempt,
                &about.worker,
                &outcome.verdict,
                &outcome.code,
                outcome.points.clone(),
                outcome.max_points.clone(),
                &outcome.summary,
                &outcome.version,
                &about.task,
                seconds,
                &outcome.grader,
                outcome.shown.clone(),
                outcome.failed.clone(),
                outcome.parts.clone()
            ],
        )
        .await?
        .int("id")?;
    for file in &outcome.files {
        let size = i64::try_from(file.artifact.size).unwrap_or(i64::MAX);
        let statement = "INSERT INTO result_file (result, name, media_type, digest, size) VALUES (?, ?, ?, ?, ?)";
        transaction
            .execute(statement, values![result_id, &file.name, &file.media_type, file.artifact.digest.as_str(), size])
            .await?;
    }
    let counted = transaction.row("SELECT result FROM grade WHERE submission = ?", values![submission_id]).await?;
    // A failure of the grader does not replace a grade.
    if about.regrade_id.is_none() && !(outcome.code == JUDGE_ERROR && counted.is_some()) {
        let reason = if counted.is_some() { "graded again" } else { "graded" };
        let change = GradeChange { submission_id, result_id, changed_by: about.asked_by, regrade_id: None, reason };
        set_grade(transaction, &change).await?;
    }
    // Judge errors are recorded when their jobs are given up.
    if outcome.code == JUDGE_ERROR {
        return Ok(about);
    }
    let text = match (&outcome.points, &outcome.max_points) {
        (Some(points), Some(max_points)) => {
            format!("{}: {} of {} points", outcome.verdict, format_points(points), format_points(max_points))
        }
        _ => outcome.verdict.clone(),
    };
    match about.regrade_id {
        None => log_event(transaction, &about, "graded", &text).await?,
        Some(_) => log_event(transaction, &about, "previewed", &format!("{text}, if the regrade is applied")).await?,
    }
    Ok(about)
}

/// A change of the result that counts for a submission, with its reason.
#[derive(Debug, Clone, Copy)]
pub struct GradeChange<'a> {
    /// The ID of the submission whose grade changes.
    pub submission_id: i64,
    /// The ID of the result that counts from now on.
    pub result_id: i64,
    /// The ID of the account that requested the change; `None` for the first grading.
    pub changed_by: Option<i64>,
    /// The ID of the regrade that caused the change, if any.
    pub regrade_id: Option<i64>,
    /// The reason for the change, as students read it.
    pub reason: &'a str,
}

/// Makes a result count, and records the result that counted previously.
///
/// # Errors
///
/// Fails if the database cannot be changed.
pub async fn set_grade(transaction: &mut Transaction, change: &GradeChange<'_>) -> Result<(), DbError> {
    let GradeChange { submission_id, result_id, changed_by, regrade_id, reason } = *change;
    let statement = "SELECT result FROM grade WHERE submission = ? {for update}";
    let old = transaction.row(statement, values![submission_id]).await?;
    let old = old.map(|row| row.int("result")).transpose()?;
    let statement = "INSERT INTO grade (submission, result, set_at) VALUES (?, ?, {now})
        ON CONFLICT (submission) DO UPDATE SET result = excluded.result, set_at = excluded.set_at";
    transaction.execute(statement, values![submission_id, result_id]).await?;
    let statement =
        "INSERT INTO grade_change (submission, old_result, new_result, changed_by, campaign, reason, changed_at)
        VALUES (?, ?, ?, ?, ?, ?, {now})";
    transaction.execute(statement, values![submission_id, old, result_id, changed_by, regrade_id, reason]).await?;
    score::queue_changed_scores(transaction, submission_id).await
}
