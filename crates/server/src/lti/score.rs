//! The scores that platforms receive for people's work on assignments (AGS 3.4).
//!
//! Every change of a grade puts a job into the queue, in the same transaction. The job contains no score: the score is
//! read when it is sent, so that many changes need only one message. Each score has a time. A later score has a later
//! time, and a score that is sent again has the same time. A platform keeps only the newest score, so a message that
//! arrives twice or late changes nothing.
use super::Platform;
use crate::{
    db::{DbError, FromRow, Row, Transaction, read_row},
    late_policy::Lateness,
    queue::{self, JobKind, JobOwner, NewJob},
    task::format_points,
    values,
    visible_grade::VisibleGrade,
};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// The task of a job that sends a score.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct ScoreOrder {
    /// The ID of the platform's link in the database.
    pub(super) link: i64,
    /// The ID of the student's account.
    pub(super) account: i64,
    /// Whether the score is sent even if the platform already has it.
    #[serde(default)]
    pub(super) again: bool,
}

/// Selects links of platforms, and the students whose scores these links receive. The argument is the end of the
/// statement.
macro_rules! orders {
    ($which:literal) => {
        concat!(
            "SELECT DISTINCT platform_link.id AS link, submission.account FROM submission
             JOIN assignment ON assignment.id = submission.assignment
             JOIN member ON member.course = assignment.course AND member.account = submission.account
                AND member.role = 'student'
             JOIN platform_link ON platform_link.assignment = submission.assignment
             JOIN platform_member ON platform_member.platform_course = platform_link.platform_course
                AND platform_member.account = submission.account
             WHERE coalesce(platform_link.line_item, platform_link.line_items) IS NOT NULL AND ",
            $which,
            " ORDER BY platform_link.id, submission.account"
        )
    };
}

/// Enqueues the score of a submission's owner for the platforms, because the submission's counting result has changed.
pub(crate) async fn queue_changed_scores(transaction: &mut Transaction, submission: i64) -> Result<(), DbError> {
    let rows = transaction.rows(orders!("submission.id = ?"), values![submission]).await?;
    enqueue(transaction, &rows, false).await.map(drop)
}

/// Enqueues all scores of an assignment, and returns their number. With `again`, scores that platforms already have are
/// sent as well.
pub(crate) async fn send_all(transaction: &mut Transaction, assignment: i64, again: bool) -> Result<usize, DbError> {
    let rows = transaction.rows(orders!("submission.assignment = ?"), values![assignment]).await?;
    enqueue(transaction, &rows, again).await
}

/// Enqueues the score of an account for the link by which the person just arrived.
pub(crate) async fn queue_arrival_score(transaction: &mut Transaction, link: i64, account: i64) -> Result<(), DbError> {
    let statement = orders!("submission.account = ? AND platform_link.id = ?");
    let rows = transaction.rows(statement, values![account, link]).await?;
    enqueue(transaction, &rows, false).await.map(drop)
}

async fn enqueue(transaction: &mut Transaction, rows: &[Row], again: bool) -> Result<usize, DbError> {
    for row in rows {
        let order = ScoreOrder { link: row.int("link")?, account: row.int("account")?, again };
        let owner = JobOwner::Score(order.link, order.account);
        if !again && queue::is_waiting(transaction, owner).await? {
            continue;
        }
        let payload = &serde_json::to_string(&order).map_err(|error| DbError::Other(error.to_string()))?;
        let job = NewJob { kind: JobKind::Passback, submission: None, regrade_id: None, owner, payload };
        queue::enqueue(transaction, &job).await?;
    }
    Ok(rows.len())
}

/// A score that is ready to be sent.
#[derive(Debug, Clone)]
pub(super) struct ReadyScore {
    pub(super) order: ScoreOrder,
    pub(super) platform: Platform,
    /// The platform's identifier of the person.
    pub(super) subject: String,
    /// The URL of the link's column in the grade book; `None` if it is not known yet.
    pub(super) line_item: Option<String>,
    /// The URL at which the column is found or created if `line_item` is `None`.
    pub(super) line_items: Option<String>,
    pub(super) resource: String,
    pub(super) slug: String,
    pub(super) title: String,
    pub(super) content: Value,
    /// The time of the score, in milliseconds since 1970.
    pub(super) stamp: i64,
}

/// Returns the score to send for an order, with its time; `None` if there is nothing to send.
pub(super) async fn prepare(transaction: &mut Transaction, order: ScoreOrder) -> Result<Option<ReadyScore>, DbError> {
    let statement =
        "SELECT platform.id, platform.name, platform.settings, platform_account.subject, platform_link.line_item,
           platform_link.line_items, platform_link.resource, platform_link.assignment, assignment.slug,
           assignment.title
        FROM platform_link
        JOIN platform_course ON platform_course.id = platform_link.platform_course
        JOIN platform ON platform.id = platform_course.platform AND platform.disabled_at IS NULL
        JOIN platform_account ON platform_account.issuer = platform.issuer AND platform_account.account = ?
        JOIN assignment ON assignment.id = platform_link.assignment
        WHERE platform_link.id = ?";
    let row = transaction.row(statement, values![order.account, order.link]).await?;
    let Some(row) = row else { return Ok(None) };
    let Some(content) = score_content(transaction, row.int("assignment")?, order.account).await? else {
        return Ok(None);
    };
    let text = content.to_string();
    let statement = "SELECT content, stamp, sent_at FROM platform_score WHERE link = ? AND account = ? {for update}";
    let before = transaction.row(statement, values![order.link, order.account]).await?;
    let stamp = match before {
        Some(before) if before.text("content")? == text && !order.again => {
            if before.maybe_int("sent_at")?.is_some() {
                return Ok(None);
            }
            before.int("stamp")?
        }
        _ => {
            let statement = "INSERT INTO platform_score (link, account, content, stamp) VALUES (?, ?, ?, {now})
                ON CONFLICT (link, account) DO UPDATE SET content = excluded.content, sent_at = NULL, fault = NULL,
                   stamp = CASE WHEN excluded.stamp > platform_score.stamp THEN excluded.stamp
                       ELSE platform_score.stamp + 1 END
                RETURNING stamp";
            transaction.one(statement, values![order.link, order.account, text]).await?.int("stamp")?
        }
    };
    let row = &row;
    Ok(Some(read_row!(row => ReadyScore {
        subject, line_item, line_items, resource, slug, title;
        platform: Platform::from_row(row)?,
        order,
        content,
        stamp,
    })))
}

/// The state of a score that the grader has not determined yet (LTI Assignment and Grade Services 2.0).
pub(crate) const PENDING: &str = "Pending";

/// Returns the score of a person's work on an assignment: the points of the best submission. Before there are points,
/// the platform receives the state `Pending`, or `PendingManual` if the grader failed; it never receives an undeserved
/// zero. Groups that are hidden and not published are left out, because platforms show every score.
async fn score_content(transaction: &mut Transaction, assignment: i64, account: i64) -> Result<Option<Value>, DbError> {
    let statement = "SELECT job.state, result.points, result.max_points, assignment.published_at, result.shown,
           mark.points AS mark, submission.created_at, assignment.settings, extension.due_at AS own_due FROM submission
        LEFT JOIN extension ON extension.assignment = submission.assignment AND extension.account = submission.account
        LEFT JOIN mark ON mark.submission = submission.id
        JOIN assignment ON assignment.id = submission.assignment
        LEFT JOIN job ON job.submission = submission.id AND job.campaign IS NULL AND job.replaced = 0
        LEFT JOIN grade ON grade.submission = submission.id
        LEFT JOIN result ON result.id = grade.result
        WHERE submission.assignment = ? AND submission.account = ? ORDER BY submission.id";
    let rows = transaction.rows(statement, values![assignment, account]).await?;
    let mut best: Option<(f64, f64)> = None;
    let mut is_waiting = false;
    for row in &rows {
        let state = row.maybe_text("state")?.unwrap_or_default();
        is_waiting |= matches!(state.as_str(), "waiting" | "running");
        let withheld = row.maybe_text("shown")?.filter(|_| row.maybe_int("published_at").is_ok_and(|at| at.is_none()));
        let (points, max_points) = match withheld.as_deref().and_then(VisibleGrade::from_text) {
            Some(shown) => (shown.points, shown.max_points),
            None => (row.maybe_text("points")?, row.maybe_text("max_points")?),
        };
        let late = Lateness::from_row(row)?;
        let points = row
            .maybe_text("mark")?
            .or_else(|| points.map(|points| late.map_or(points.clone(), |late| late.points_left(&points))));
        let number =
            |text: Option<String>| text.and_then(|text| text.parse().ok()).filter(|number: &f64| number.is_finite());
        if let (Some(points), Some(max_points)) = (number(points), number(max_points))
            && max_points > 0.0
            && best.is_none_or(|(best, _)| points >= best)
        {
            best = Some((points.max(0.0), max_points));
        }
    }
    Ok(match best {
        _ if rows.is_empty() => None,
        Some((points, max_points)) => Some(json!({
            "scoreGiven": points, "scoreMaximum": max_points,
            "activityProgress": "Completed", "gradingProgress": "FullyGraded",
        })),
        None => {
            let grading = if is_waiting { PENDING } else { "PendingManual" };
            Some(json!({"activityProgress": "Submitted", "gradingProgress": grading}))
        }
    })
}

/// Records that a platform has received the score. If there is a newer score, it remains marked as not sent; the log
/// entry is written in any case.
pub(super) async fn record_sent(transaction: &mut Transaction, score: &ReadyScore) -> Result<(), DbError> {
    let statement =
        "UPDATE platform_score SET sent_at = {now}, fault = NULL WHERE link = ? AND account = ? AND stamp = ?";
    transaction.execute(statement, values![score.order.link, score.order.account, score.stamp]).await?;
    let content = &score.content;
    let what = match (content["scoreGiven"].as_f64(), content["scoreMaximum"].as_f64()) {
        (Some(points), Some(max)) => format!("{} of {} points", format_points(points), format_points(max)),
        _ => content["gradingProgress"].as_str().unwrap_or_default().to_owned(),
    };
    log_event(transaction, score.order, "score sent", &format!("{what}, to {}", score.platform.name)).await
}

/// Records the reason why a platform rejected a score. Staff see it.
pub(super) async fn store_fault(transaction: &mut Transaction, order: ScoreOrder, fault: &str) -> Result<(), DbError> {
    let statement = "UPDATE platform_score SET fault = ? WHERE link = ? AND account = ? AND sent_at IS NULL";
    transaction.execute(statement, values![fault, order.link, order.account]).await.map(drop)
}

/// Records that a job was tried too often. Returns whether the job was to send a score.
pub(crate) async fn record_failure(transaction: &mut Transaction, payload: &str, fault: &str) -> Result<bool, DbError> {
    let Ok(order) = serde_json::from_str::<ScoreOrder>(payload) else { return Ok(false) };
    store_fault(transaction, order, fault).await?;
    log_event(transaction, order, "score not sent", fault).await?;
    Ok(true)
}

/// Writes an entry about a score into the course's audit log.
async fn log_event(transaction: &mut Transaction, order: ScoreOrder, kind: &str, text: &str) -> Result<(), DbError> {
    let statement = "INSERT INTO event (happened_at, kind, course, assignment, text)
        SELECT {now}, ?, assignment.course, assignment.id, account.login || ': ' || CAST(? AS TEXT)
        FROM platform_link JOIN assignment ON assignment.id = platform_link.assignment
        JOIN account ON account.id = ? WHERE platform_link.id = ?";
    transaction.execute(statement, values![kind, text, order.account, order.link]).await.map(drop)
}

/// The state of a link's column in the grade book.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum ColumnState {
    /// The column is known; the value is its URL.
    Known(String),
    /// The column is unknown, and the caller must create it. Other callers wait until then.
    Unclaimed,
    /// The column is unknown, and another caller is creating it.
    Claimed,
}

/// Returns the state of a link's column. A caller that receives [`ColumnState::Unclaimed`] must create the column soon.
pub(super) async fn find_column(
    transaction: &mut Transaction,
    link: i64,
    max_millis: i64,
) -> Result<ColumnState, DbError> {
    let statement = "UPDATE platform_link SET making_until = {now} + ?
        WHERE id = ? AND line_item IS NULL
           AND (coalesce(making_until, 0) < {now} OR making_until > {now} + ?)";
    let mine = transaction.execute(statement, values![max_millis, link, max_millis]).await?;
    if mine > 0 {
        return Ok(ColumnState::Unclaimed);
    }
    let row = transaction.one("SELECT line_item FROM platform_link WHERE id = ?", values![link]).await?;
    Ok(row.maybe_text("line_item")?.map_or(ColumnState::Claimed, ColumnState::Known))
}

/// Stores the URL of the column that was found or created for a link. With `None`, another caller may try.
pub(super) async fn keep_column(
    transaction: &mut Transaction,
    link: i64,
    address: Option<&str>,
) -> Result<(), DbError> {
    let statement =
        "UPDATE platform_link SET line_item = coalesce(line_item, CAST(? AS TEXT)), making_until = NULL WHERE id = ?";
    transaction.execute(statement, values![address, link]).await.map(drop)
}
