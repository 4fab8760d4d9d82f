//! The values that the service shows in the API, on pages and in exports.
use super::{
    App, Settings,
    assignments::suites::{UploadedSuite, describe_suite},
};
use crate::{
    db::{DbError, FromRow, Row, Transaction, from_row, read_row},
    health,
    late_policy::Lateness,
    queue::{self, JobKind, Progress},
    store::Artifact,
    task::{Outcome, OutputFile, Suite, Task},
    values,
    visible_grade::{VisibleGrade, round_to_hour},
};
use serde::{Deserialize, Serialize};
use std::ops::Deref;
use utoipa::{IntoParams, ToSchema};

/// The account of a person who can sign in.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Account {
    /// The account's ID.
    #[serde(skip)]
    pub(crate) id: i64,
    /// The login: the account's name in URLs and tables.
    pub login: String,
    /// The name of the account's owner.
    pub name: String,
    /// Whether the account is an administrator's.
    pub is_admin: bool,
}

/// A course on this server.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Course {
    /// The short name of the course, which is used in URLs.
    pub slug: String,
    /// The full name of the course.
    pub title: String,
}

/// An assignment of a course.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Assignment {
    #[serde(skip)]
    pub(crate) id: i64,
    /// The short name of the assignment, which is used in URLs.
    pub slug: String,
    /// The full name of the assignment.
    pub title: String,
    /// Whether students see the assignment.
    pub visible: bool,
    /// The settings for grading and uploads.
    pub settings: Settings,
    /// The time at which the hidden groups were published, in milliseconds since 1970; null while students cannot see
    /// them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub published_at: Option<i64>,
    /// The number of changes of the assignment so far. A change that is based on an earlier revision is rejected.
    pub revision: i64,
}

/// A submission, and its result if there is one.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, ToSchema)]
pub struct Submission {
    /// The submission's ID.
    pub id: i64,
    /// The submission's number among its owner's submissions to this assignment, starting at 1.
    pub number: i64,
    /// The short name of the assignment, which is used in URLs.
    pub assignment: String,
    /// The assignment's title.
    pub title: String,
    /// The owner's login.
    pub login: String,
    /// The owner's name.
    pub name: String,
    /// The submission's form: `program`, `sources` or `traces`.
    pub form: String,
    /// The name of the uploaded file.
    pub file_name: String,
    /// The SHA-256 digest of the uploaded file.
    pub digest: String,
    /// The size of the uploaded file in bytes.
    pub size: i64,
    /// The time of the upload, in milliseconds since 1970.
    pub created_at: i64,
    /// The time when the upload and the reports were removed; the grade and its history stay.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub removed_at: Option<i64>,
    /// The submission's state: `waiting`, `running`, `done`, `buried` (the grader failed too often) or `cancelled`.
    pub state: String,
    /// The number of jobs ahead in the queue, while the submission waits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ahead: Option<i64>,
    /// The expected number of seconds until the grade is ready. Present while the submission is graded, or while it
    /// waits and a worker is connected.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expected_seconds: Option<u64>,
    /// Whether the submission waits although no worker is connected that could grade it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub lacks_worker: bool,
    /// The progress of the grading; null if no grading is running.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub progress: Option<Progress>,
    /// The result that counts; null until the submission is graded.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grade: Option<ResultView>,
    /// The delay for which a late submission loses points. Points that staff set are not reduced.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub late: Option<Lateness>,
    /// The points and the comment of staff, and the owner's request for a review.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mark: Option<Mark>,
    /// Whether groups that the suite hides are left out of the grade, its history and its reports until staff publish
    /// them.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_withheld: bool,
    /// Whether staff have published the assignment's hidden groups.
    #[serde(skip)]
    pub(super) is_published: bool,
    /// The last error of the grader on this submission. Only staff see it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fault: Option<String>,
    #[serde(skip)]
    job: Option<i64>,
    #[serde(skip)]
    pub(super) account: i64,
}

/// The points and the comment of staff on a submission, and the request of the submission's owner.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Mark {
    /// The points that count instead of the grader's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub points: Option<String>,
    /// The grader's points, less the deduction for being late.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grader_points: Option<String>,
    /// The reason for the points that staff set, or another comment on the submission.
    pub comment: String,
    /// The login of the member of staff who last wrote the mark.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by: Option<String>,
    /// The time at which staff wrote the mark, in milliseconds since 1970.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub marked_at: Option<i64>,
    /// The question with which the submission's owner requests a review.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub request: Option<String>,
    /// The time of the request, in milliseconds since 1970.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub requested_at: Option<i64>,
}

/// The result of one grading of a submission.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct ResultView {
    #[serde(skip)]
    pub(crate) result: i64,
    /// The verdict, the points and the reports.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// The time of the grading, in milliseconds since 1970; rounded to the hour while hidden groups are withheld.
    pub created_at: i64,
}

impl Deref for ResultView {
    type Target = Outcome;

    fn deref(&self) -> &Outcome {
        &self.outcome
    }
}

/// A change of the result that counts for a submission.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct History {
    /// The time of the change, in milliseconds since 1970; rounded to the hour while hidden groups are withheld.
    pub changed_at: i64,
    /// The reason for the change, as students read it.
    pub reason: String,
    /// The person who requested the change; `None` for the grader.
    pub by: Option<String>,
    /// The code of the verdict before the change.
    pub old_code: Option<String>,
    /// The points before the change.
    pub old_points: Option<String>,
    /// The maximum of the points before the change.
    pub old_max_points: Option<String>,
    /// The code of the verdict after the change.
    pub new_code: String,
    /// The points after the change.
    pub new_points: Option<String>,
    /// The maximum of the points after the change.
    pub new_max_points: Option<String>,
    /// The ID of the result that counts after the change.
    pub result: i64,
    /// The grader's version.
    pub version: String,
    /// The SHA-256 of the grader, if it is known.
    pub grader: String,
    /// The suite and the rules, in one line.
    #[serde(rename = "by_what")]
    pub task_summary: String,
    /// The complete task (rules, suite, digests), with which the grading can be repeated. Only for staff.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub task: String,
}

/// An entry of the audit log.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Event {
    /// The event's ID; later events have larger IDs.
    pub id: i64,
    /// The time of the event, in milliseconds since 1970.
    pub happened_at: i64,
    /// The event's kind.
    pub kind: String,
    /// The person who caused the event; `None` for the service.
    pub actor: Option<String>,
    /// The short name of the event's course.
    pub course: Option<String>,
    /// The short name of the event's assignment.
    pub assignment: Option<String>,
    /// The ID of the event's submission.
    pub submission: Option<i64>,
    /// The submission's number among its owner's submissions to this assignment, starting at 1.
    pub number: Option<i64>,
    /// The login of the submission's owner.
    pub owner: Option<String>,
    /// The event as a sentence.
    pub text: String,
}

impl Event {
    /// Returns whether the same person caused both events within a second, such as an import that adds two members.
    /// Their texts may differ in the first word only. Results of a regrade are similar if they are at most a minute
    /// apart.
    pub(crate) fn is_similar(&self, other: &Self) -> bool {
        let end = |event: &Self| event.text.split_once(' ').map(|(_, end)| end.to_owned());
        let subject = |event: &Self| (event.actor.clone(), event.course.clone(), event.kind.clone(), end(event));
        let distance = self.happened_at.abs_diff(other.happened_at);
        let is_of_regrade = self.kind == other.kind && ["previewed", "grade changed"].contains(&self.kind.as_str());
        match is_of_regrade {
            true => distance < 60_000 && (&self.course, &self.assignment) == (&other.course, &other.assignment),
            false => distance < 1000 && self.actor.is_some() && subject(self) == subject(other),
        }
    }
}

/// A filter for events of the audit log. An empty part allows all events.
#[derive(Debug, Clone, Default, Deserialize, IntoParams)]
#[serde(default)]
#[into_params(parameter_in = Query)]
pub struct EventQuery {
    /// Only events with an ID below this one.
    pub(crate) before: Option<u64>,
    /// Only events with these words in the text, in the login of the person who caused them, or in the owner's login.
    pub(crate) who: String,
    /// Only events of this kind.
    pub(crate) kind: String,
}

/// Selects events by an [`EventQuery`] and further values. The second argument is the end of the statement.
macro_rules! events {
    ($transaction:ident, $query:ident, $which:literal $(, $value:expr)*) => {{
        let statement = concat!(
            "SELECT event.id, event.happened_at, event.kind, actor.login, event.submission, event.text,
                course.slug AS course, assignment.slug AS assignment, submission.number, owner.login AS owner FROM event
             LEFT JOIN account AS actor ON actor.id = event.actor
             LEFT JOIN course ON course.id = event.course
             LEFT JOIN assignment ON assignment.id = event.assignment
             LEFT JOIN submission ON submission.id = event.submission
             LEFT JOIN account AS owner ON owner.id = submission.account
             WHERE event.id < ? AND (? = '' OR event.kind = ?) AND
                {strpos}(lower(coalesce(actor.login, '') || ' ' || coalesce(owner.login, '') || ' ' || event.text), ?)
                > 0 ",
            $which,
            " ORDER BY event.id DESC LIMIT 200"
        );
        let before = $query.before.map_or(i64::MAX, |before| i64::try_from(before).unwrap_or(i64::MAX));
        let (kind, who) = (&$query.kind, $query.who.trim().to_lowercase());
        $transaction.all(statement, values![before, kind, kind, who $(, $value)*]).await?
    }};
}
pub(super) use events;

/// The numbers of jobs in the queue, and the workers.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Queue {
    /// The number of waiting uploads.
    pub waiting: i64,
    /// The number of waiting jobs of regrades.
    pub regrades: i64,
    /// The number of running jobs.
    pub running: i64,
    /// The number of jobs that were given up and that staff must check.
    pub buried: i64,
    /// The workers that have reported recently.
    pub workers: Vec<QueueWorker>,
}

/// A worker and its state.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct QueueWorker {
    /// The worker's name.
    pub name: String,
    /// The worker's version.
    pub version: String,
    /// The maximum number of parallel gradings of the worker.
    pub slots: i64,
    /// The number of jobs that the worker runs at present.
    pub running: i64,
    /// The time of the worker's last report, in milliseconds since 1970.
    pub seen_at: i64,
    /// The time since which the worker claims no jobs because it can't grade, in milliseconds since 1970; null if it
    /// claims jobs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub aside_since: Option<i64>,
    /// The number of the worker's faults since its last result.
    pub faults: i64,
    /// The description of the worker's last fault.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fault: Option<String>,
    /// The time of the worker's last fault, in milliseconds since 1970.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fault_at: Option<i64>,
}

from_row! {
    Account { id, login, name, is_admin }
    Course { slug, title }
    Mark { points = "mark_points", grader_points = "points", comment, by = "marker", marked_at, request, requested_at }
    Event { id, happened_at, kind, actor = "login", course, assignment, submission, number, owner, text }
    QueueWorker { name, version, slots, running, seen_at, aside_since, faults, fault, fault_at }
}

/// Selects submissions. The argument is the end of the statement.
macro_rules! submissions {
    ($rest:literal) => {
        concat!(
            "SELECT submission.id, submission.number, submission.form, submission.file_name, submission.digest,
                submission.size, submission.created_at, submission.removed_at, submission.account,
                assignment.slug AS assignment,
                assignment.title, assignment.published_at, account.login, account.name, job.id AS job, job.state,
                job.scenes_done, job.scenes,
                job.last_fault, grade.result, result.verdict,
                result.code, result.points, result.max_points, result.summary, result.version, result.seconds,
                result.grader, result.shown, result.created_at AS graded_at,
                assignment.settings, extension.due_at AS own_due,
                mark.points AS mark_points, mark.comment, mark.marked_at, mark.request, mark.requested_at,
                marker.login AS marker
             FROM submission
             JOIN assignment ON assignment.id = submission.assignment
             JOIN account ON account.id = submission.account
             LEFT JOIN job ON job.submission = submission.id AND job.campaign IS NULL AND job.replaced = 0
             LEFT JOIN grade ON grade.submission = submission.id
             LEFT JOIN result ON result.id = grade.result
             LEFT JOIN extension ON extension.assignment = assignment.id AND extension.account = account.id
             LEFT JOIN mark ON mark.submission = submission.id
             LEFT JOIN account AS marker ON marker.id = mark.marked_by
             WHERE ",
            $rest
        )
    };
}

fn read_grade(row: &Row, result: i64) -> Result<ResultView, DbError> {
    let outcome = read_row!(row => Outcome {
        verdict, code, points, max_points, summary, version, grader, seconds, shown;
        ..Outcome::default()
    });
    Ok(ResultView { result, outcome, created_at: row.int("graded_at")? })
}

impl FromRow for Submission {
    fn from_row(row: &Row) -> Result<Self, DbError> {
        let mut submission = read_row!(row => Self {
            id, number, assignment, title, login, name, form, file_name, digest, size, created_at, removed_at, job,
            account, fault = "last_fault";
            state: row.maybe_text("state")?.unwrap_or_else(|| "cancelled".to_owned()),
            progress: read_progress(row)?,
            grade: row.maybe_int("result")?.map(|result| read_grade(row, result)).transpose()?,
            is_published: row.maybe_int("published_at")?.is_some(),
            late: Lateness::from_row(row)?,
            mark: row.maybe_text("comment")?.map(|_| Mark::from_row(row)).transpose()?,
            ..Self::default()
        });
        submission.apply_staff_points();
        Ok(submission)
    }
}

/// Returns the progress of a job, if it runs and its worker reports it.
fn read_progress(row: &Row) -> Result<Option<Progress>, DbError> {
    let is_running = row.maybe_text("state")?.as_deref() == Some("running");
    let read = |column| Ok::<_, DbError>(row.maybe_int(column)?.and_then(|number| u32::try_from(number).ok()));
    Ok(read("scenes_done")?.zip(read("scenes")?).filter(|_| is_running).map(|(done, all)| Progress { done, all }))
}

impl Submission {
    /// Shows the points that staff set, if any, instead of the grader's, which the mark keeps. The points of staff are
    /// not reduced for being late.
    pub(super) fn apply_staff_points(&mut self) {
        let Some(grade) = &mut self.grade else { return };
        let points = grade.outcome.points.take();
        let points = points.map(|points| self.late.map_or(points.clone(), |late| late.points_left(&points)));
        grade.outcome.points = match &mut self.mark {
            Some(mark) => {
                mark.grader_points = points;
                mark.points.clone().or_else(|| mark.grader_points.clone())
            }
            None => points,
        };
    }
}

/// Returns an account's submissions to an assignment, newest first.
pub(super) async fn submissions_of(
    transaction: &mut Transaction,
    assignment: i64,
    account: i64,
) -> Result<Vec<Submission>, DbError> {
    let statement = submissions!("submission.assignment = ? AND submission.account = ? ORDER BY submission.id DESC");
    transaction.all(statement, values![assignment, account]).await
}

/// The number of submissions that one statement reads.
const PAGE_SIZE: i64 = 500;

/// Returns a page of the submissions to an assignment, oldest first, from the first one after the ID `after`. The
/// page after the last submission is empty.
pub(super) async fn submissions_after(
    transaction: &mut Transaction,
    assignment: i64,
    after: i64,
) -> Result<Vec<Submission>, DbError> {
    let statement = submissions!("submission.assignment = ? AND submission.id > ? ORDER BY submission.id LIMIT ?");
    transaction.all(statement, values![assignment, after, PAGE_SIZE]).await
}

/// Returns the submissions with the given IDs.
pub(super) async fn submissions_named(transaction: &mut Transaction, ids: &[i64]) -> Result<Vec<Submission>, DbError> {
    let statement = submissions!("submission.id IN (SELECT CAST(wanted.value AS {int}) FROM {each})");
    transaction.all(statement, values![serde_json::to_string(ids).unwrap_or_default()]).await
}

/// Returns a submission of a course, with its position in the queue and its reports.
pub(super) async fn submission(
    transaction: &mut Transaction,
    app: &App,
    course: i64,
    id: i64,
) -> Result<Option<Submission>, DbError> {
    let statement = submissions!("submission.id = ? AND assignment.course = ?");
    let found: Option<Submission> = transaction.find(statement, values![id, course]).await?;
    let Some(mut submission) = found else { return Ok(None) };
    if let Some(job) = submission.job.filter(|_| submission.state == "running") {
        submission.expected_seconds = queue::find_time_left(transaction, JobKind::Grading, job).await?;
    } else if let Some(job) = submission.job
        && let Some(position) = queue::find_queue_position(transaction, &app.0.policy, JobKind::Grading, job).await?
    {
        submission.ahead = Some(position.ahead);
        submission.lacks_worker = !position.is_served;
        submission.expected_seconds = position.expected.map(|expected| expected.as_secs().max(1));
    }
    if let Some(grade) = &mut submission.grade {
        let statement = "SELECT name, media_type, digest, size FROM result_file WHERE result = ? ORDER BY name";
        let rows = transaction.rows(statement, values![grade.result]).await?;
        let read = |row: &Row| {
            let wrong = |what: &str| DbError::Other(format!("a report's {what} is invalid"));
            let digest = row.text("digest")?.parse().map_err(|_| wrong("digest"))?;
            let size = u64::try_from(row.int("size")?).map_err(|_| wrong("size"))?;
            Ok(read_row!(row => OutputFile { name, media_type; artifact: Artifact { digest, size } }))
        };
        if submission.removed_at.is_none() {
            grade.outcome.files = rows.iter().map(read).collect::<Result<_, DbError>>()?;
        }
    }
    Ok(Some(submission))
}

/// Returns the history of a grade. With `withheld`, hidden groups are left out. Only staff see the names of the suites
/// that were uploaded to the course; students pass `None`.
pub(super) async fn history(
    transaction: &mut Transaction,
    submission: i64,
    withheld: bool,
    uploaded: Option<&[UploadedSuite]>,
) -> Result<Vec<History>, DbError> {
    let statement = "SELECT grade_change.changed_at, grade_change.reason, account.login, old.code AS old_code,
           old.points AS old_points, old.max_points AS old_max_points, old.shown AS old_shown,
           new.shown AS new_shown, grade_change.old_result, grade_change.given, new.id AS result,
           new.code AS new_code, new.points AS new_points, new.max_points AS new_max_points, new.version,
           new.grader, new.task
        FROM grade_change
        JOIN result AS new ON new.id = grade_change.new_result
        LEFT JOIN result AS old ON old.id = grade_change.old_result
        LEFT JOIN account ON account.id = grade_change.changed_by
        WHERE grade_change.submission = ? ORDER BY grade_change.id";
    let rows = transaction.rows(statement, values![submission]).await?;
    // The code, the points and their maximum, as the reader may see them.
    let read_grade = |row: &Row, side: &str| {
        let column = |name: &str| row.maybe_text(&format!("{side}_{name}"));
        let visible_grade = column("shown")?.filter(|_| withheld).as_deref().and_then(VisibleGrade::from_text);
        Ok::<_, DbError>(match visible_grade {
            Some(visible_grade) => (Some(visible_grade.code), visible_grade.points, visible_grade.max_points),
            None => (column("code")?, column("points")?, column("max_points")?),
        })
    };
    let mut staff_points = None;
    let read = |row: &Row| {
        let (old_code, old_points, old_max_points) = read_grade(row, "old")?;
        let (new_code, new_points, new_max_points) = read_grade(row, "new")?;
        let old_points = staff_points.clone().or(old_points);
        // The points that staff set count instead of the grader's until staff remove them.
        if row.maybe_int("old_result")? == Some(row.int("result")?) {
            staff_points = row.maybe_text("given")?;
        }
        Ok(read_row!(row => History {
            reason, by = "login", result, version, grader;
            changed_at: if withheld { round_to_hour(row.int("changed_at")?) } else { row.int("changed_at")? },
            old_code,
            old_points,
            old_max_points,
            new_code: new_code.unwrap_or_default(),
            new_points: staff_points.clone().or(new_points),
            new_max_points,
            task_summary: describe_task(&row.text("task")?, uploaded),
            task: if uploaded.is_some() { row.text("task")? } else { String::new() },
        }))
    };
    rows.iter().map(read).collect()
}

/// Describes the suite and the rules of a task, in one line.
fn describe_task(task: &str, uploaded: Option<&[UploadedSuite]>) -> String {
    let Ok(task) = serde_json::from_str::<Task>(task) else { return String::new() };
    let suite = match (&task.suite, uploaded) {
        (Suite::Archive(_), None) => "of the course".to_owned(),
        (suite, uploaded) => describe_suite(suite, uploaded.unwrap_or_default()),
    };
    format!("suite {suite}, rules {}", task.rules.as_deref().unwrap_or("of the suite"))
}

impl FromRow for Assignment {
    fn from_row(row: &Row) -> Result<Self, DbError> {
        let settings = Settings::from_json(&row.text("settings")?)?;
        Ok(read_row!(row => Self { id, slug, title, visible, published_at, revision; settings }))
    }
}

/// An entry of the audit log.
pub(super) struct LogEntry<'a> {
    pub(super) kind: &'static str,
    /// The account of the person who caused the event; `None` for the server.
    pub(super) actor: Option<i64>,
    pub(super) course: Option<i64>,
    pub(super) assignment: Option<i64>,
    pub(super) submission: Option<i64>,
    pub(super) text: &'a str,
}

impl<'a> LogEntry<'a> {
    /// Creates an entry without a course or a submission.
    pub(super) fn new(kind: &'static str, actor: impl Into<Option<i64>>, text: &'a str) -> Self {
        Self { kind, actor: actor.into(), course: None, assignment: None, submission: None, text }
    }
}

/// Writes an entry into the audit log.
pub(super) async fn log_event(transaction: &mut Transaction, entry: &LogEntry<'_>) -> Result<(), DbError> {
    let statement = "INSERT INTO event (happened_at, kind, actor, course, assignment, submission, text)
        VALUES ({now}, ?, ?, ?, ?, ?, ?)";
    let LogEntry { kind, actor, course, assignment, submission, text } = *entry;
    transaction.execute(statement, values![kind, actor, course, assignment, submission, text]).await.map(drop)
}

/// Returns the state of the queue and of the workers, as staff see it.
pub(super) async fn queue(transaction: &mut Transaction, app: &App) -> Result<Queue, DbError> {
    // Each count uses a small index of its own, because few jobs are in these states.
    let statement = "SELECT
        (SELECT count(*) FROM job WHERE lane = 'grading' AND state = 'waiting' AND campaign IS NULL) AS waiting,
        (SELECT count(*) FROM job WHERE lane = 'grading' AND state = 'waiting' AND campaign IS NOT NULL) AS regrades,
        (SELECT count(*) FROM job WHERE lane = 'grading' AND state = 'running') AS running,
        (SELECT count(*) FROM job WHERE lane = 'grading' AND state = 'buried' AND replaced = 0) AS buried";
    let counts = &transaction.one(statement, values![]).await?;
    let recent = health::worker_timeout_millis(&app.0.policy);
    let statement = "SELECT name, version, slots, seen_at, aside_since, faults, fault, fault_at,
           (SELECT count(*) FROM job WHERE job.state = 'running' AND job.worker = worker.name) AS running
        FROM worker WHERE seen_at > {now} - ? AND seen_at <= {now} + ? ORDER BY name LIMIT 1000";
    let workers = transaction.all(statement, values![recent, recent]).await?;
    Ok(read_row!(counts => Queue { waiting, regrades, running, buried; workers }))
}
