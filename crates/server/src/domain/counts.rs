//! Numbers for monitoring. The database counts them with indexes. Simultaneous requests share one answer and one
//! connection.
use crate::{
    db::{Database, DbError},
    health,
    instruments::Metrics,
    queue::{JobKind, QueuePolicy},
    values,
};
use std::time::{Duration, Instant};
use tokio::sync::Mutex;

/// The time for which the numbers are reused.
const MAX_AGE: Duration = Duration::from_secs(1);

/// The latest numbers for monitors, with the time at which they were read.
#[derive(Debug, Default)]
pub struct Counts(Mutex<Option<(Instant, Metrics)>>);

impl Counts {
    /// Returns numbers that are at most a second old.
    pub(super) async fn read(&self, database: &Database, policy: &QueuePolicy) -> Result<Metrics, DbError> {
        let mut last = self.0.lock().await;
        if let Some((at, metrics)) = last.as_ref()
            && at.elapsed() < MAX_AGE
        {
            return Ok(metrics.clone());
        }
        let metrics = count(database, policy).await?;
        *last = Some((Instant::now(), metrics.clone()));
        Ok(metrics)
    }
}

async fn count(database: &Database, policy: &QueuePolicy) -> Result<Metrics, DbError> {
    let mut transaction = database.read().await?;
    let mut metrics = Metrics::default();
    // Submission IDs are assigned only once, even if rows are removed, so the highest ID
    // counts all submissions so far.
    let statement = "SELECT (SELECT coalesce(max(id), 0) FROM submission) AS submissions,
        (SELECT coalesce(max(id), 0) FROM result) AS results";
    let row = transaction.one(statement, values![]).await?;
    metrics.submissions = row.int("submissions")?;
    let mut graded_count = row.int("results")?;
    // These events are rare. A job that was given up also has a result, but it was not graded.
    for kind in ["failed try", "late answer", "buried"] {
        let n = transaction.one("SELECT count(*) AS n FROM event WHERE kind = ?", values![kind]).await?.int("n")?;
        graded_count -= if kind == "buried" { n } else { 0 };
        metrics.events.push((kind.to_owned(), n));
    }
    metrics.events.push(("graded".to_owned(), graded_count));
    metrics.jobs.push(("done".to_owned(), graded_count));
    for (kind, counts) in [(JobKind::Grading, &mut metrics.jobs), (JobKind::Passback, &mut metrics.scores)] {
        let statement = "SELECT (SELECT count(*) FROM job WHERE lane = ? AND state = 'waiting') AS waiting,
            (SELECT count(*) FROM job WHERE lane = ? AND state = 'running') AS running,
            (SELECT count(*) FROM job WHERE lane = ? AND state = 'buried' AND replaced = 0) AS buried,
            (SELECT count(*) FROM job WHERE lane = ? AND state = 'cancelled') AS cancelled";
        let row = transaction.one(statement, values![kind.name(), kind.name(), kind.name(), kind.name()]).await?;
        for state in ["waiting", "running", "buried", "cancelled"] {
            counts.push((state.to_owned(), row.int(state)?));
        }
    }
    let statement = "SELECT (SELECT count(*) FROM job WHERE lane = 'passback' AND state = 'done') AS sent,
        (SELECT coalesce({now} - min(enqueued_at), 0) FROM job
            WHERE lane = 'grading' AND state = 'waiting' AND campaign IS NULL) AS oldest";
    let row = transaction.one(statement, values![]).await?;
    metrics.scores.push(("done".to_owned(), row.int("sent")?));
    metrics.longest_wait_ms = row.int("oldest")?.max(0);
    let statement =
        "SELECT CAST(coalesce(sum(bytes), 0) AS {int}) AS bytes, CAST(coalesce(max(bytes), 0) AS {int}) AS most
        FROM (SELECT sum(bytes) AS bytes FROM kept_bytes GROUP BY course) AS of_courses";
    let row = transaction.one(statement, values![]).await?;
    metrics.stored_bytes = [row.int("bytes")?, row.int("most")?];
    let recent = health::worker_timeout_millis(policy);
    let statement =
        "SELECT count(*) AS n, CAST(coalesce(sum(slots), 0) AS {int}) AS slots, count(aside_since) AS aside,
           count(CASE WHEN aside_since IS NULL AND EXISTS (SELECT 1 FROM job
               WHERE job.state = 'running' AND job.worker = worker.name) THEN 1 END) AS working
        FROM worker WHERE seen_at > {now} - ? AND seen_at <= {now} + ?";
    let row = transaction.one(statement, values![recent, recent]).await?;
    (metrics.workers, metrics.slots, metrics.paused_workers) = (row.int("n")?, row.int("slots")?, row.int("aside")?);
    metrics.busy_workers = row.int("working")?;
    Ok(metrics)
}
