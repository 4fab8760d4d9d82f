//! The work of regrades: set-based statements over some hundred submissions at a time, so that nobody who writes waits
//! for long. Where a regrade is stands in its row: anybody who looks goes on with it, also after the server died.
use super::{
    Settings,
    bulk::{payload, pieces},
    view::{self, Assignment, Entry},
};
use crate::{
    db::{Database, DbError, FromRow, Row, Transaction, Value},
    lti::score,
    problem::Problem,
    queue::{Notifier, Turn},
    task::JUDGE_ERROR,
    values,
};
use std::time::{Duration, Instant};
use tokio_util::sync::CancellationToken;

/// Submissions in one transaction.
const BATCH: i64 = 500;

/// How often somebody looks although nobody rang.
const LOOK_EVERY: Duration = Duration::from_secs(2);

/// Works on regrades until `stop` is cancelled.
pub async fn run(database: Database, notifier: Notifier, stop: CancellationToken) {
    let mut subscription = notifier.subscribe();
    while !stop.is_cancelled() {
        match step(&database, None).await {
            // Others who write come in between.
            Ok(Step::Done) => continue,
            Ok(Step::Busy | Step::Nothing) => {}
            Err(problem) => tracing::warn!(detail = problem.detail, "a regrade does not go on yet"),
        }
        tokio::select! {
            () = stop.cancelled() => return,
            _ = subscription.wait(LOOK_EVERY) => {}
        }
    }
}

/// Works on one regrade while somebody waits for the answer, and not for longer than that: a small one is done then.
/// The wish is written by now: a fault here is the background's, which tries again, and no refusal.
pub(super) async fn hurry(database: &Database, campaign: i64, at_most: Duration) {
    let start = Instant::now();
    while start.elapsed() < at_most {
        match step(database, Some(campaign)).await {
            Ok(Step::Done) => {}
            Ok(Step::Busy) => tokio::time::sleep(Duration::from_millis(10)).await,
            Ok(Step::Nothing) => break,
            Err(problem) => {
                tracing::warn!(detail = problem.detail, campaign, "a regrade goes on in the background");
                break;
            }
        }
    }
}

/// The result of a try to do a batch.
enum Step {
    Done,
    /// Somebody else is at it.
    Busy,
    Nothing,
}

/// A regrade that there is something to do for.
struct Campaign {
    id: i64,
    /// The last row that was looked at.
    cursor: i64,
    assignment: Assignment,
    course: i64,
    reason: String,
    by: i64,
}

/// Does the next batch of a regrade, or of any.
async fn step(database: &Database, wanted: Option<i64>) -> Result<Step, Problem> {
    // A reader's transaction only, where there is nothing to do.
    let due = "SELECT id FROM campaign WHERE doing IS NOT NULL AND (id = ? OR ? = 0) ORDER BY id LIMIT 1";
    let wanted = wanted.unwrap_or(0);
    if database.read().await?.row(due, values![wanted, wanted]).await?.is_none() {
        return Ok(Step::Nothing);
    }
    let mut transaction = database.begin().await?;
    let statement = "SELECT id, doing, cursor, assignment, settings, reason, coalesce(decided_by, started_by) AS by
        FROM campaign WHERE doing IS NOT NULL AND (id = ? OR ? = 0) ORDER BY id LIMIT 1 {skip locked}";
    let row = transaction.row(statement, values![wanted, wanted]).await?;
    let Some(row) = row else { return Ok(Step::Busy) };
    let statement =
        "SELECT id, slug, title, visible, settings, published_at, revision, course FROM assignment WHERE id = ?";
    let of = transaction.one(statement, values![row.int("assignment")?]).await?;
    let campaign = Campaign {
        id: row.int("id")?,
        cursor: row.int("cursor")?,
        assignment: Assignment { settings: Settings::read(&row.text("settings")?)?, ..Assignment::from_row(&of)? },
        course: of.int("course")?,
        reason: row.text("reason")?,
        by: row.int("by")?,
    };
    match row.text("doing")?.as_str() {
        "begin" => begin(&mut transaction, &campaign).await?,
        "apply" => apply(&mut transaction, &campaign).await?,
        "undo" => undo(&mut transaction, &campaign).await?,
        _ => discard(&mut transaction, &campaign).await?,
    }
    transaction.commit().await?;
    Ok(Step::Done)
}

/// The rows of the next batch: their last number and how many there are.
fn batch(row: &Row) -> Result<Option<(i64, i64)>, DbError> {
    row.maybe_int("last")?.map(|last| row.int("n").map(|n| (last, n))).transpose()
}

async fn advance(transaction: &mut Transaction, campaign: i64, last: i64, count: i64) -> Result<(), DbError> {
    let statement = "UPDATE campaign SET cursor = ?, done = done + ? WHERE id = ?";
    transaction.execute(statement, values![last, count, campaign]).await.map(drop)
}

async fn finish(transaction: &mut Transaction, campaign: i64) -> Result<(), DbError> {
    transaction.execute("UPDATE campaign SET doing = NULL WHERE id = ?", values![campaign]).await.map(drop)
}

/// Enqueues submissions that the regrade does not know yet.
async fn begin(transaction: &mut Transaction, campaign: &Campaign) -> Result<(), Problem> {
    let statement = "SELECT max(id) AS last, count(*) AS n FROM (SELECT id FROM submission
        WHERE assignment = ? AND id > ? AND removed_at IS NULL ORDER BY id LIMIT ?) AS batch";
    let row = transaction.one(statement, values![campaign.assignment.id, campaign.cursor, BATCH]).await?;
    let Some((last, count)) = batch(&row)? else { return Ok(finish(transaction, campaign.id).await?) };
    let turn = Turn::Campaign(campaign.id);
    let from = turn.next(transaction).await?;
    let mut values: Vec<Value> = vec![campaign.id.into(), turn.key().into()];
    values.extend(pieces(&campaign.assignment)?.into_iter().map(Value::from));
    values.extend([from, turn.spacing_millis()].map(Value::from));
    values.extend([campaign.assignment.id, campaign.cursor, last, campaign.id].map(Value::from));
    // The plus keeps SQLite from looking through all jobs of the regrade for each submission.
    let statement = concat!(
        "INSERT INTO job (lane, submission, campaign, fair_key, payload, state, rank, run_after, enqueued_at)
         SELECT 'grading', submission.id, CAST(? AS {int}), CAST(? AS TEXT), ",
        payload!(),
        ", 'waiting', ? + ? * (row_number() OVER (ORDER BY submission.id) - 1), {now}, {now}
         FROM submission
         WHERE submission.assignment = ? AND submission.id > ? AND submission.id <= ?
            AND submission.removed_at IS NULL
            AND NOT EXISTS (SELECT 1 FROM job WHERE job.submission = submission.id AND +job.campaign = ?)"
    );
    transaction.execute(statement, &values).await?;
    Ok(advance(transaction, campaign.id, last, count).await?)
}

/// The next batch of a regrade's results.
async fn results(transaction: &mut Transaction, campaign: &Campaign) -> Result<Row, DbError> {
    let statement = "SELECT max(id) AS last, count(*) AS n FROM (SELECT id FROM result
        WHERE campaign = ? AND id > ? ORDER BY id LIMIT ?) AS batch";
    transaction.one(statement, values![campaign.id, campaign.cursor, BATCH]).await
}

/// Makes results count.
async fn apply(transaction: &mut Transaction, campaign: &Campaign) -> Result<(), Problem> {
    let row = results(transaction, campaign).await?;
    let Some((last, count)) = batch(&row)? else {
        return Ok(decided(transaction, campaign, "applied", "applied").await?);
    };
    let &Campaign { id, cursor, by, course, .. } = campaign;
    let statement =
        "INSERT INTO grade_change (submission, old_result, new_result, changed_by, campaign, reason, changed_at)
        SELECT result.submission, grade.result, result.id, CAST(? AS {int}), CAST(? AS {int}), CAST(? AS TEXT), {now}
        FROM result LEFT JOIN grade ON grade.submission = result.submission
        WHERE result.campaign = ? AND result.id > ? AND result.id <= ? AND result.code <> ?";
    let values = values![by, id, &campaign.reason, id, cursor, last, JUDGE_ERROR];
    transaction.execute(statement, values).await?;
    let statement = "INSERT INTO event (happened_at, kind, actor, course, assignment, submission, text)
        SELECT {now}, 'grade changed', CAST(? AS {int}), CAST(? AS {int}), CAST(? AS {int}), result.submission,
           CAST(? AS TEXT)
        FROM result LEFT JOIN grade ON grade.submission = result.submission
        LEFT JOIN result AS old ON old.id = grade.result
        WHERE result.campaign = ? AND result.id > ? AND result.id <= ? AND result.code <> ?
           AND (old.id IS NULL OR old.code <> result.code
               OR coalesce(old.points, '') <> coalesce(result.points, ''))";
    let values = values![by, course, campaign.assignment.id, &campaign.reason, id, cursor, last, JUDGE_ERROR];
    transaction.execute(statement, values).await?;
    let statement = "INSERT INTO grade (submission, result, set_at)
        SELECT submission, id, {now} FROM result
        WHERE campaign = ? AND id > ? AND id <= ? AND code <> ?
        ON CONFLICT (submission) DO UPDATE SET result = excluded.result, set_at = excluded.set_at";
    transaction.execute(statement, values![id, cursor, last, JUDGE_ERROR]).await?;
    score::changed_by(transaction, id, cursor, last).await?;
    Ok(advance(transaction, id, last, count).await?)
}

async fn decided(
    transaction: &mut Transaction,
    campaign: &Campaign,
    state: &'static str,
    words: &str,
) -> Result<(), DbError> {
    let statement = "UPDATE campaign SET state = ?, decided_at = {now} WHERE id = ?";
    transaction.execute(statement, values![state, campaign.id]).await?;
    finish(transaction, campaign.id).await?;
    let text = format!("regrade {} {words}", campaign.id);
    let (course, assignment) = (Some(campaign.course), Some(campaign.assignment.id));
    view::note(transaction, &Entry { course, assignment, ..Entry::new("regrade", campaign.by, &text) }).await
}

/// Of grades that a regrade changed, and that nothing changed since.
macro_rules! undo {
    ($what:literal, $which:literal) => {
        concat!(
            $what,
            "grade_change AS applied JOIN grade AS now_is ON now_is.submission = applied.submission
                AND now_is.result = applied.new_result
             WHERE applied.campaign = ? AND applied.new_result > ? AND applied.new_result <= ? AND ",
            $which
        )
    };
}

/// Makes what counted before a regrade's results count again, where nothing else does by now.
async fn undo(transaction: &mut Transaction, campaign: &Campaign) -> Result<(), Problem> {
    let row = results(transaction, campaign).await?;
    let Some((last, count)) = batch(&row)? else { return Ok(undone(transaction, campaign).await?) };
    let reason = format!("regrade {} was taken back", campaign.id);
    let statement = undo!(
        "INSERT INTO grade_change (submission, old_result, new_result, changed_by, reason, changed_at)
         SELECT applied.submission, applied.new_result, applied.old_result, CAST(? AS {int}), CAST(? AS TEXT),
            {now} FROM ",
        "applied.old_result IS NOT NULL"
    );
    transaction.execute(statement, values![campaign.by, reason, campaign.id, campaign.cursor, last]).await?;
    let statement =
        undo!("DELETE FROM grade WHERE submission IN (SELECT applied.submission FROM ", "applied.old_result IS NULL)");
    transaction.execute(statement, values![campaign.id, campaign.cursor, last]).await?;
    let statement = undo!(
        "INSERT INTO grade (submission, result, set_at) SELECT applied.submission, applied.old_result, {now} FROM ",
        "applied.old_result IS NOT NULL
         ON CONFLICT (submission) DO UPDATE SET result = excluded.result, set_at = excluded.set_at"
    );
    transaction.execute(statement, values![campaign.id, campaign.cursor, last]).await?;
    score::changed_by(transaction, campaign.id, campaign.cursor, last).await?;
    Ok(advance(transaction, campaign.id, last, count).await?)
}

async fn undone(transaction: &mut Transaction, campaign: &Campaign) -> Result<(), DbError> {
    // Unless somebody set others meanwhile.
    let statement =
        "UPDATE assignment SET settings = (SELECT settings_before FROM campaign WHERE id = ?), revision = revision + 1
        WHERE id = ? AND settings = (SELECT settings FROM campaign WHERE id = ? AND settings_before IS NOT NULL)";
    transaction.execute(statement, values![campaign.id, campaign.assignment.id, campaign.id]).await?;
    decided(transaction, campaign, "discarded", "taken back").await
}

/// Takes what is left of a regrade out of the queue.
async fn discard(transaction: &mut Transaction, campaign: &Campaign) -> Result<(), DbError> {
    let statement = "WITH left_over AS (SELECT id FROM job WHERE campaign = ? AND state IN ('waiting', 'running')
           ORDER BY id LIMIT ? {for update})
        UPDATE job SET state = 'cancelled', finished_at = {now}, lease_key = NULL, lease_until = NULL
        WHERE id IN (SELECT id FROM left_over)";
    let cancelled = transaction.execute(statement, values![campaign.id, BATCH]).await?;
    if cancelled == 0 { finish(transaction, campaign.id).await } else { Ok(()) }
}
