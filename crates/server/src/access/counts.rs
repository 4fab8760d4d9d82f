//! Numbers for monitors: counted by indexes of what is in motion, and by sums of what only grows. Many who ask at once
//! get one answer, and hold one connection.
use crate::{
    db::{Database, DbError, Transaction},
    health,
    instruments::Metrics,
    queue::{Lane, QueuePolicy},
    values,
};
use std::time::{Duration, Instant};
use tokio::sync::Mutex;

/// For so long an answer counts.
const FRESH: Duration = Duration::from_secs(1);

/// Rows that are older than this, in milliseconds, are committed or never will be, and can be summed up.
const SETTLED: i64 = 300_000;

/// With this many new rows a sum is brought up to date.
const MANY: i64 = 10_000;

/// The last answer.
#[derive(Debug, Default)]
pub struct Counts(Mutex<Option<(Instant, Metrics)>>);

impl Counts {
    /// The numbers of this moment, or of a moment ago.
    pub(super) async fn of(&self, database: &Database, policy: &QueuePolicy) -> Result<Metrics, DbError> {
        let mut last = self.0.lock().await;
        if let Some((at, metrics)) = last.as_ref()
            && at.elapsed() < FRESH
        {
            return Ok(metrics.clone());
        }
        let (metrics, grown) = count(database, policy).await?;
        if !grown.is_empty() {
            let mut transaction = database.begin().await?;
            for name in grown {
                sum_up(&mut transaction, name).await?;
            }
            transaction.commit().await?;
        }
        *last = Some((Instant::now(), metrics.clone()));
        Ok(metrics)
    }
}

/// A number that only grows: its name among the sums, how its rows after one are counted, and the last of them that is
/// settled.
struct Growing {
    name: &'static str,
    newer: &'static str,
    settled: &'static str,
    older: &'static str,
}

macro_rules! growing {
    ($name:literal, $table:literal, $time:literal, $which:literal) => {
        Growing {
            name: $name,
            newer: concat!("SELECT count(*) AS n FROM ", $table, " WHERE ", $which, " AND id > ?"),
            settled: concat!(
                "SELECT id FROM ",
                $table,
                " WHERE ",
                $which,
                " AND id > ? AND ",
                $time,
                " < {now} - ? ORDER BY id DESC LIMIT 1"
            ),
            older: concat!("SELECT count(*) AS n FROM ", $table, " WHERE ", $which, " AND id > ? AND id <= ?"),
        }
    };
}

const GROWING: [Growing; 6] = [
    growing!("graded", "event", "happened_at", "kind = 'graded'"),
    growing!("failed try", "event", "happened_at", "kind = 'failed try'"),
    growing!("late answer", "event", "happened_at", "kind = 'late answer'"),
    growing!("buried", "event", "happened_at", "kind = 'buried'"),
    growing!("submission", "submission", "created_at", "1 = 1"),
    growing!("result", "result", "created_at", "code <> 'JE'"),
];

async fn count(database: &Database, policy: &QueuePolicy) -> Result<(Metrics, Vec<&'static Growing>), DbError> {
    let mut transaction = database.read().await?;
    let mut metrics = Metrics::default();
    let mut grown = Vec::new();
    for growing in &GROWING {
        let sum = transaction.one("SELECT upto, n FROM tally WHERE name = ?", values![growing.name]).await?;
        let newer = transaction.one(growing.newer, values![sum.int("upto")?]).await?.int("n")?;
        if newer > MANY {
            grown.push(growing);
        }
        let n = sum.int("n")? + newer;
        match growing.name {
            "submission" => metrics.submissions = n,
            "result" => metrics.jobs.push(("done".to_owned(), n)),
            kind => metrics.events.push((kind.to_owned(), n)),
        }
    }
    for (lane, counts) in [(Lane::Grading, &mut metrics.jobs), (Lane::Passback, &mut metrics.scores)] {
        let statement = "SELECT (SELECT count(*) FROM job WHERE lane = ? AND state = 'waiting') AS waiting,
            (SELECT count(*) FROM job WHERE lane = ? AND state = 'running') AS running,
            (SELECT count(*) FROM job WHERE lane = ? AND state = 'buried' AND replaced = 0) AS buried,
            (SELECT count(*) FROM job WHERE lane = ? AND state = 'cancelled') AS cancelled";
        let row = transaction.one(statement, values![lane.name(), lane.name(), lane.name(), lane.name()]).await?;
        for state in ["waiting", "running", "buried", "cancelled"] {
            counts.push((state.to_owned(), row.int(state)?));
        }
    }
    let statement = "SELECT (SELECT count(*) FROM job WHERE lane = 'passback' AND state = 'done') AS sent,
        (SELECT count(*) FROM job WHERE lane = 'paused' AND state = 'waiting') AS paused,
        (SELECT coalesce({now} - min(enqueued_at), 0) FROM job
            WHERE lane = 'grading' AND state = 'waiting' AND campaign IS NULL) AS oldest";
    let row = transaction.one(statement, values![]).await?;
    metrics.scores.push(("done".to_owned(), row.int("sent")?));
    (metrics.paused, metrics.oldest) = (row.int("paused")?, row.int("oldest")?.max(0));
    let statement =
        "SELECT CAST(coalesce(sum(bytes), 0) AS {int}) AS bytes, CAST(coalesce(max(bytes), 0) AS {int}) AS most
        FROM (SELECT sum(bytes) AS bytes FROM kept_bytes GROUP BY course) AS of_courses";
    let row = transaction.one(statement, values![]).await?;
    metrics.kept = [row.int("bytes")?, row.int("most")?];
    let recent = health::recent(policy);
    let statement =
        "SELECT count(*) AS n, CAST(coalesce(sum(slots), 0) AS {int}) AS slots, count(aside_since) AS aside,
           count(CASE WHEN aside_since IS NULL AND EXISTS (SELECT 1 FROM job
               WHERE job.state = 'running' AND job.worker = worker.name) THEN 1 END) AS working
        FROM worker WHERE seen_at > {now} - ? AND seen_at <= {now} + ?";
    let row = transaction.one(statement, values![recent, recent]).await?;
    (metrics.workers, metrics.slots, metrics.aside) = (row.int("n")?, row.int("slots")?, row.int("aside")?);
    metrics.working = row.int("working")?;
    Ok((metrics, grown))
}

/// Adds what is settled to a sum. Two servers that do so at once do it once.
async fn sum_up(transaction: &mut Transaction, growing: &Growing) -> Result<(), DbError> {
    let sum = transaction.one("SELECT upto FROM tally WHERE name = ? {for update}", values![growing.name]).await?;
    let upto = sum.int("upto")?;
    let Some(last) = transaction.row(growing.settled, values![upto, SETTLED]).await? else { return Ok(()) };
    let last = last.int("id")?;
    let n = transaction.one(growing.older, values![upto, last]).await?.int("n")?;
    transaction.execute("UPDATE tally SET upto = ?, n = n + ? WHERE name = ?", values![last, n, growing.name]).await?;
    Ok(())
}
