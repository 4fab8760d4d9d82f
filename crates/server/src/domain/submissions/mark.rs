//! Decisions of staff about a student's work (other points, a comment, more time), and students' requests for a review.
use crate::domain::{
    Member, Staff,
    accounts::identity,
    view::{self, Assignment, LogEntry, Submission},
};
use crate::{
    calendar,
    db::{DbError, Row, Transaction, from_row},
    health,
    lti::score,
    problem::{Problem, ensure},
    task::format_points,
    values,
};

/// The maximum length of a comment, or of a request for a review.
const MAX_TEXT_LENGTH: usize = 2000;

/// A student's submissions to an assignment, and the student's own due date.
#[derive(Debug, Clone)]
pub struct StudentHistory {
    /// The login of the student's account.
    pub login: String,
    /// The student's name.
    pub name: String,
    /// All submissions of the student, newest first.
    pub submissions: Vec<Submission>,
    /// The student's own due date in milliseconds since 1970; `None` if the assignment's due date applies.
    pub extended_to: Option<i64>,
}

/// A student's unanswered request for a review.
#[derive(Debug, Clone)]
pub struct Request {
    /// The submission's ID.
    pub submission: i64,
    /// The submission's number among its owner's submissions to this assignment, starting at 1.
    pub number: i64,
    /// The login of the submission's owner.
    pub login: String,
    /// The student's question about the grade.
    pub text: String,
    /// The time of the request, in milliseconds since 1970.
    pub requested_at: i64,
}

/// The numbers that describe an assignment in its course's table.
#[derive(Debug, Clone)]
pub struct Overview {
    /// The number of students in the course.
    pub students: i64,
    /// The number of students who have submitted something.
    pub students_submitted: i64,
    /// The number of students with an accepted submission.
    pub students_accepted: i64,
    /// The number of submissions to the assignment.
    pub submissions: i64,
    /// The number of students' requests for a review that are not answered.
    pub requests: i64,
    /// The number of regrades on which staff have not decided yet.
    pub regrades: i64,
    /// The number of gradings that all workers of the server can run at the same time.
    pub slots: i64,
}

from_row! { Overview { students, students_submitted, students_accepted, submissions, requests, regrades, slots } }
from_row! { Request { submission, number, login, text = "request", requested_at } }

fn check_text(what: &str, text: &str, min: usize) -> Result<(), Problem> {
    let length = text.chars().count();
    let is_hidden = |c| identity::is_control(c) && !matches!(c, '\n' | '\r' | '\t');
    if let Some(hidden) = text.chars().find(|c| is_hidden(*c)) {
        let hidden = hidden.escape_unicode();
        return Err(Problem::invalid(format!("{what} must not contain the invisible character {hidden}")));
    }
    let is_fit = (min..=MAX_TEXT_LENGTH).contains(&length);
    ensure(is_fit, Problem::invalid(format!("{what} must have {min} to {MAX_TEXT_LENGTH} characters")))
}

impl Staff {
    /// Replaces the grader's points of a submission, or restores them, with a reason. If the student requested a
    /// review, this answers it.
    ///
    /// # Errors
    ///
    /// Fails if there is no such submission, the points are invalid, or the submission was marked after the time
    /// `seen_mark`.
    pub async fn mark(
        &self,
        id: i64,
        points: Option<&str>,
        comment: &str,
        seen_mark: Option<Option<i64>>,
    ) -> Result<Submission, Problem> {
        check_text("a comment", comment, 0)?;
        let bare = Problem::conflict("different points need a reason", "write the reason in the comment");
        ensure(points.is_none() || !comment.is_empty(), bare)?;
        let mut transaction = self.begin().await?;
        transaction.row("SELECT id FROM submission WHERE id = ? {for update}", values![id]).await?;
        let submission = self.find_submission(&mut transaction, id).await?;
        let marked_at = submission.mark.as_ref().and_then(|mark| mark.marked_at);
        if let Some(mark) = submission.mark.as_ref().filter(|_| seen_mark.is_some_and(|seen| seen != marked_at)) {
            let who = mark.by.as_deref().unwrap_or("somebody");
            return Err(Problem::changed(format!("{who} has marked it in the meantime: {}", mark.comment)));
        }
        let ungraded = Problem::conflict("the submission is not graded yet", "wait for its grade");
        ensure(points.is_none() || submission.grade.is_some(), ungraded)?;
        // If there is no maximum, the grader failed. Points that were given earlier are still allowed.
        let max = submission.grade.and_then(|grade| grade.outcome.max_points).unwrap_or_else(|| "1000000".to_owned());
        let is_number = |text: &str| {
            text.len() <= 30
                && text.bytes().all(|c| c.is_ascii_digit() || c == b'.')
                && text.parse().is_ok_and(|points| (0.0..=max.parse().unwrap_or(1e6)).contains(&points))
        };
        let number = format!("points must be a number between 0 and {}, such as 7.5", format_points(&max));
        let before = submission.mark.and_then(|mark| mark.points);
        if before.as_deref() != points {
            ensure(points.is_none_or(is_number), Problem::invalid(number))?;
            let what = if points.is_some() { "points by hand" } else { "the grader's points again" };
            let reason = if comment.is_empty() { what.to_owned() } else { format!("{what}: {comment}") };
            let statement =
                "INSERT INTO grade_change (submission, old_result, new_result, changed_by, reason, given, changed_at)
                SELECT submission, result, result, CAST(? AS {int}), CAST(? AS TEXT), CAST(? AS TEXT), {now}
                FROM grade WHERE submission = ?";
            transaction.execute(statement, values![self.account.id, reason, points, id]).await?;
        }
        let statement =
            "INSERT INTO mark (submission, points, comment, marked_by, marked_at) VALUES (?, ?, ?, ?, {now})
            ON CONFLICT (submission) DO UPDATE SET points = excluded.points, comment = excluded.comment,
               marked_by = excluded.marked_by, marked_at = excluded.marked_at";
        transaction.execute(statement, values![id, points, comment, self.account.id]).await?;
        let text = match points {
            Some(points) => format!("set {points} points: {comment}"),
            None => format!("restored the grader's points: {comment}"),
        };
        let entry = self.entry("marked", None, &text);
        view::log_event(&mut transaction, &LogEntry { submission: Some(id), ..entry }).await?;
        score::queue_changed_scores(&mut transaction, id).await?;
        self.app.0.notifier.commit(transaction).await?;
        self.submission(id).await
    }

    /// Returns the unanswered requests of students about an assignment, oldest first.
    ///
    /// # Errors
    /// Fails if there is no such assignment.
    pub async fn requests(&self, slug: &str) -> Result<Vec<Request>, Problem> {
        let (mut transaction, assignment) = self.read_assignment(slug).await?;
        let statement =
            "SELECT mark.submission, submission.number, mark.request, mark.requested_at, account.login FROM mark
            JOIN submission ON submission.id = mark.submission JOIN account ON account.id = submission.account
            WHERE submission.assignment = ? AND mark.requested_at > coalesce(mark.marked_at, 0)
            ORDER BY mark.requested_at";
        Ok(transaction.all(statement, values![assignment.id]).await?)
    }

    /// Returns all submissions of a student to an assignment.
    ///
    /// # Errors
    ///
    /// Fails if the person is not a member and has no submissions.
    pub async fn student_history(&self, slug: &str, login: &str) -> Result<StudentHistory, Problem> {
        let (mut transaction, assignment) = self.read_assignment(slug).await?;
        let account = self.student(&mut transaction, &assignment, login).await?;
        Ok(StudentHistory {
            login: login.to_owned(),
            name: account.text("name")?,
            submissions: view::submissions_of(&mut transaction, assignment.id, account.int("id")?).await?,
            extended_to: extension(&mut transaction, assignment.id, account.int("id")?).await?,
        })
    }

    async fn student(
        &self,
        transaction: &mut Transaction,
        assignment: &Assignment,
        login: &str,
    ) -> Result<Row, Problem> {
        let statement = "SELECT id, name FROM account WHERE login = ?
            AND (EXISTS (SELECT 1 FROM member WHERE member.account = account.id AND member.course = ?)
                OR EXISTS (SELECT 1 FROM submission
                    WHERE submission.account = account.id AND submission.assignment = ?))";
        let row = transaction.row(statement, values![login, self.course, assignment.id]).await?;
        row.ok_or_else(|| Problem::not_found("member"))
    }

    /// Sets a student's own due date, or removes it.
    ///
    /// # Errors
    ///
    /// Fails if there is no such student, or the date was changed after the event `since`.
    pub async fn extend(
        &self,
        slug: &str,
        login: &str,
        due_at: Option<i64>,
        since: Option<i64>,
    ) -> Result<(), Problem> {
        identity::check_slug("a login", login)?;
        let wrong = "due_at must be milliseconds since 1970, or a date such as 2026-12-01T23:59:00+01:00";
        ensure(due_at.is_none_or(calendar::is_plausible), Problem::invalid(wrong))?;
        let mut transaction = self.begin().await?;
        let assignment = self.find_assignment(&mut transaction, slug).await?;
        let is_later = due_at.zip(assignment.settings.due_at).is_none_or(|(extended, due)| extended > due);
        ensure(is_later, Problem::invalid("an extension must end after the assignment's due date"))?;
        let account = self.student(&mut transaction, &assignment, login).await?.int("id")?;
        let beginning = format!("{login} ");
        self.check_last_event(&mut transaction, ("extension", Some(assignment.id)), &beginning, since).await?;
        let statement = "DELETE FROM extension WHERE assignment = ? AND account = ?";
        transaction.execute(statement, values![assignment.id, account]).await?;
        if let Some(due) = due_at {
            let statement =
                "INSERT INTO extension (assignment, account, due_at, set_by, set_at) VALUES (?, ?, ?, ?, {now})";
            transaction.execute(statement, values![assignment.id, account, due, self.account.id]).await?;
        }
        let statement = "SELECT max(id) AS id FROM submission WHERE assignment = ? AND account = ?";
        if let Some(last) = transaction.one(statement, values![assignment.id, account]).await?.maybe_int("id")? {
            score::queue_changed_scores(&mut transaction, last).await?;
        }
        let time = due_at.map(calendar::format_minute);
        let change = time.map_or("lost the extension".to_owned(), |time| format!("got an extension until {time} UTC"));
        let text = format!("{login} {change}");
        self.log_event(&mut transaction, "extension", Some(assignment.id), &text).await?;
        Ok(self.app.0.notifier.commit(transaction).await?)
    }
}

impl Member {
    /// Sends the member's request that staff review one of the member's submissions.
    ///
    /// # Errors
    ///
    /// Fails if the submission is not the member's, or the request is empty.
    pub async fn request(&self, id: i64, text: &str) -> Result<(), Problem> {
        check_text("a request", text, 1)?;
        let mut transaction = self.app.0.database.begin().await?;
        let submission = self.find_submission(&mut transaction, id).await?;
        ensure(
            submission.account == self.account.id,
            Problem::not_allowed("only the person who submitted it can do this"),
        )?;
        let before = submission.mark.and_then(|mark| mark.request).unwrap_or_default();
        ensure(
            before.chars().count() + text.chars().count() <= 5 * MAX_TEXT_LENGTH,
            Problem::conflict("your requests exceed the total length limit", "talk to the course's staff"),
        )?;
        let text = if before.is_empty() { text.to_owned() } else { format!("\n\n{text}") };
        let statement = "INSERT INTO mark (submission, comment, request, requested_at) VALUES (?, '', ?, {now})
            ON CONFLICT (submission) DO UPDATE SET request = coalesce(mark.request, '') || excluded.request,
               requested_at = excluded.requested_at";
        transaction.execute(statement, values![id, text]).await?;
        Ok(transaction.commit().await?)
    }

    /// Returns the numbers that describe an assignment to staff; `None` for students.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn overview(&self, assignment: &Assignment) -> Result<Option<Overview>, Problem> {
        if !self.is_staff {
            return Ok(None);
        }
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT count(DISTINCT member.account) AS students_submitted, count(*) AS submissions,
            count(DISTINCT CASE WHEN result.code = 'AC' THEN member.account END) AS students_accepted,
            (SELECT count(*) FROM member WHERE member.course = ? AND member.role = 'student') AS students,
            (SELECT count(*) FROM mark JOIN submission AS asked ON asked.id = mark.submission
                WHERE asked.assignment = ? AND mark.requested_at > coalesce(mark.marked_at, 0)) AS requests,
            (SELECT count(*) FROM campaign WHERE campaign.assignment = ? AND state = 'open') AS regrades,
            (SELECT CAST(coalesce(sum(slots), 0) AS {int}) FROM worker
                WHERE seen_at > {now} - ? AND seen_at <= {now} + ?) AS slots
            FROM submission LEFT JOIN member ON member.account = submission.account AND member.course = ?
               AND member.role = 'student'
            LEFT JOIN grade ON grade.submission = submission.id LEFT JOIN result ON result.id = grade.result
            WHERE submission.assignment = ?";
        let (recent, id) = (health::worker_timeout_millis(&self.app.0.policy), assignment.id);
        Ok(transaction.find(statement, values![self.course, id, id, recent, recent, self.course, id]).await?)
    }

    /// Returns the member's due date for an assignment.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn due_date(&self, assignment: &Assignment) -> Result<Option<i64>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        Ok(due_date(&mut transaction, assignment, self.account.id).await?)
    }
}

async fn extension(transaction: &mut Transaction, assignment: i64, account: i64) -> Result<Option<i64>, DbError> {
    let statement = "SELECT due_at FROM extension WHERE assignment = ? AND account = ?";
    let row = transaction.row(statement, values![assignment, account]).await?;
    row.map(|row| row.int("due_at")).transpose()
}

/// Returns an account's due date. An extension can only move it to a later time.
pub(in crate::domain) async fn due_date(
    transaction: &mut Transaction,
    assignment: &Assignment,
    account: i64,
) -> Result<Option<i64>, DbError> {
    match assignment.settings.due_at {
        None => Ok(None),
        Some(due) => Ok(extension(transaction, assignment.id, account).await?.max(Some(due))),
    }
}
