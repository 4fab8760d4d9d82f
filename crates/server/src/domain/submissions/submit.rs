//! Uploading. After the bytes are safely stored, the submission, its job and its event are written in one transaction.
use crate::domain::{
    Member,
    submissions::mark,
    view::{self, Assignment, LogEntry, Submission},
};
use crate::{
    calendar,
    db::Transaction,
    lti::score,
    problem::{Problem, ensure},
    queue::{self, JobKind, JobOwner, NewJob},
    store::{Artifact, digest_of_file},
    task::{Form, Input},
    values,
};
use std::{
    path::Path,
    time::{Duration, Instant},
};

/// The maximum time that an upload waits for earlier ones. It is long, so that no upload is rejected only because many
/// arrive before a deadline.
const CROWD_TIMEOUT: Duration = Duration::from_secs(240);

const MINUTE: i64 = 60 * 1000;
const HOUR: i64 = 60 * MINUTE;

/// An upload that is not a submission yet.
#[derive(Debug, Clone)]
pub struct Upload<'a> {
    /// The form of the submission: a program, sources or traces.
    pub form: Form,
    /// The upload's name: a file name without folders.
    pub name: &'a str,
    /// The file with the upload's bytes.
    pub file: &'a Path,
    /// The sender's key for the upload. Two uploads with the same key are one submission.
    pub key: Option<&'a str>,
    /// The time at which the request arrived, in milliseconds since 1970 by the database's clock. It counts for due
    /// dates and limits.
    pub arrived_at: i64,
}

/// The result of an upload.
#[derive(Debug, Clone)]
pub struct SubmitResult {
    /// The new submission, or the earlier one with the same key.
    pub submission: Submission,
    /// Whether an earlier upload with the same key had already created the submission.
    pub repeated: bool,
}

impl Member {
    /// Submits an upload.
    ///
    /// # Errors
    ///
    /// Fails if the assignment does not accept the upload, or the server can't store it. After an error, there is
    /// either no submission, or another upload with the same key finds it.
    pub async fn submit(&self, assignment: &str, upload: &Upload<'_>) -> Result<SubmitResult, Problem> {
        let (_, assignment) = self.read_assignment(assignment).await?;
        if !assignment.settings.accepts_form(upload.form) {
            let (accepted, found) = (assignment.settings.describe_forms(), upload.form.describe());
            let detail = format!("this assignment accepts {accepted}, but the file is {found}");
            return Err(assignment.settings.reject_file(detail));
        }
        // Simultaneous uploads of an account are checked one after another. Otherwise an upload could be stored
        // although an earlier one has used up the limit.
        let _turn = self.app.limits.wait(self.account.id).await?;
        // Check before storing, so that the bytes of a rejected or repeated upload are not stored.
        let artifact = digest_of_file(upload.file).await?;
        let mut transaction = self.app.0.database.read().await?;
        if let Some(submission) = self.admit_upload(&mut transaction, &assignment, upload, &artifact).await? {
            return Ok(SubmitResult { submission, repeated: true });
        }
        drop(transaction);
        let artifact = self.app.0.store.put_file(upload.file).await?;
        let mut transaction = self.app.0.database.begin_with_timeout(CROWD_TIMEOUT).await?;
        // Uploads of one student are handled one after another, because their numbers are assigned and limits are
        // counted here.
        transaction.one("SELECT id FROM account WHERE id = ? {for update}", values![self.account.id]).await?;
        if let Some(submission) = self.admit_upload(&mut transaction, &assignment, upload, &artifact).await? {
            return Ok(SubmitResult { submission, repeated: true });
        }
        let submission = self.write_submission(&mut transaction, &assignment, upload, &artifact).await?;
        self.app.0.notifier.commit(transaction).await?;
        Ok(SubmitResult { submission: self.submission(submission).await?, repeated: false })
    }

    /// Returns the time at which an upload's request arrived, by the database's clock. If the request announces the
    /// upload's key and size, this also checks whether the upload is allowed, before the body is sent.
    ///
    /// # Errors
    ///
    /// Fails if the upload is not allowed.
    pub async fn check_announcement(
        &self,
        assignment: &str,
        announced: Option<(Option<&str>, u64)>,
        since: Instant,
    ) -> Result<i64, Problem> {
        let (mut transaction, assignment) = self.read_assignment(assignment).await?;
        let now = transaction.one("SELECT {now} AS now", values![]).await?.int("now")?;
        let arrived_at = now - queue::millis(since.elapsed());
        let Some((key, size)) = announced else { return Ok(arrived_at) };
        if let Some(key) = key {
            let statement = "SELECT word FROM upload_key WHERE account = ? AND word = ?";
            // The same upload may have been stored before.
            if transaction.row(statement, values![self.account.id, key]).await?.is_some() {
                return Ok(arrived_at);
            }
        }
        if !self.is_staff {
            self.check_limits(&mut transaction, &assignment, arrived_at).await?;
        }
        self.check_quota(&mut transaction, size).await?;
        Ok(arrived_at)
    }

    /// Returns the earlier submission with the same key; `None` if there is none and a new submission is allowed.
    async fn admit_upload(
        &self,
        transaction: &mut Transaction,
        assignment: &Assignment,
        upload: &Upload<'_>,
        artifact: &Artifact,
    ) -> Result<Option<Submission>, Problem> {
        if let Some(key) = upload.key
            && let Some(submission) = self.find_upload_by_key(transaction, key, assignment, artifact).await?
        {
            return Ok(Some(submission));
        }
        if !self.is_staff {
            self.check_limits(transaction, assignment, upload.arrived_at).await?;
        }
        self.check_quota(transaction, artifact.size).await?;
        Ok(None)
    }

    async fn find_upload_by_key(
        &self,
        transaction: &mut Transaction,
        key: &str,
        assignment: &Assignment,
        artifact: &Artifact,
    ) -> Result<Option<Submission>, Problem> {
        let statement = "SELECT assignment, digest, submission FROM upload_key WHERE account = ? AND word = ?";
        let row = transaction.row(statement, values![self.account.id, key]).await?;
        let Some(row) = row else { return Ok(None) };
        if row.int("assignment")? != assignment.id || row.text("digest")? != artifact.digest.as_str() {
            let detail = "this key was already used for another upload";
            return Err(Problem::conflict(detail, "use a different key for every upload"));
        }
        Ok(Some(self.find_submission(transaction, row.int("submission")?).await?))
    }

    async fn check_limits(
        &self,
        transaction: &mut Transaction,
        assignment: &Assignment,
        arrived_at: i64,
    ) -> Result<(), Problem> {
        let settings = &assignment.settings;
        // A failure of the grader does not count as an attempt.
        let statement = "SELECT {now} AS now, count(*) AS n,
               count(CASE WHEN submission.created_at > ? AND submission.created_at <= {now} THEN 1 END) AS recent,
               min(CASE WHEN submission.created_at > ? THEN submission.created_at END) AS oldest
            FROM submission
            LEFT JOIN grade ON grade.submission = submission.id
            LEFT JOIN result ON result.id = grade.result
            WHERE submission.assignment = ? AND submission.account = ? AND coalesce(result.code, '') <> 'JE'";
        let values = values![arrived_at - HOUR, arrived_at - HOUR, assignment.id, self.account.id];
        let row = transaction.one(statement, values).await?;
        let due = mark::due_date(transaction, assignment, self.account.id).await?;
        if due.is_some_and(|due| arrived_at > settings.late_policy().closes_at(due)) {
            return Err(Problem::conflict("the due date has passed", "ask the course's staff"));
        }
        ensure(
            settings.attempts == 0 || row.int("n")? < settings.attempts.into(),
            Problem::conflict(
                format!("all {} submissions to this assignment are used up", settings.attempts),
                "ask the course's staff",
            ),
        )?;
        if settings.per_hour > 0 && row.int("recent")? >= settings.per_hour.into() {
            // The next submission is allowed when the oldest one of the last hour is an hour old.
            let again = row.int("oldest")? + HOUR;
            let detail = format!(
                "at most {} submissions in an hour: the next one is possible from {} UTC",
                settings.per_hour,
                calendar::format_minute(again + MINUTE - 1)
            );
            let wait = (again - row.int("now")?).max(0).unsigned_abs().div_ceil(1000);
            return Err(Problem { wait: Some(wait), ..Problem::too_many(detail) });
        }
        Ok(())
    }

    async fn write_submission(
        &self,
        transaction: &mut Transaction,
        assignment: &Assignment,
        upload: &Upload<'_>,
        artifact: &Artifact,
    ) -> Result<i64, Problem> {
        let input = Input { form: upload.form, name: upload.name.to_owned(), artifact: artifact.clone() };
        let task = assignment.settings.task(input);
        // The highest number so far is stored, so that it is not assigned again after a removal.
        let statement = "INSERT INTO numbering (assignment, account, last) VALUES (?, ?, 1)
            ON CONFLICT (assignment, account) DO UPDATE SET last = numbering.last + 1 RETURNING last AS number";
        let number = transaction.one(statement, values![assignment.id, self.account.id]).await?.int("number")?;
        let statement =
            "INSERT INTO submission (assignment, account, number, form, file_name, digest, size, created_at)
            VALUES (?, ?, ?, ?, ?, ?, ?, ?) RETURNING id";
        let (account, digest) = (self.account.id, artifact.digest.as_str());
        let size = i64::try_from(artifact.size).unwrap_or(i64::MAX);
        let (form, arrived_at, owner) = (upload.form.name(), upload.arrived_at, JobOwner::Student(account));
        let values = values![assignment.id, account, number, form, upload.name, digest, size, arrived_at];
        let submission = transaction.one(statement, values).await?.int("id")?;
        let payload = &serde_json::to_string(&task).map_err(|_| Problem::fault())?;
        let job = NewJob { kind: JobKind::Grading, submission: Some(submission), regrade_id: None, owner, payload };
        queue::enqueue(transaction, &job).await?;
        score::queue_changed_scores(transaction, submission).await?;
        if let Some(key) = upload.key {
            let statement =
                "INSERT INTO upload_key (account, word, assignment, digest, submission) VALUES (?, ?, ?, ?, ?)";
            transaction.execute(statement, values![account, key, assignment.id, digest, submission]).await?;
        }
        let entry = self.entry("submitted", Some(assignment.id), upload.name);
        view::log_event(transaction, &LogEntry { submission: Some(submission), ..entry }).await?;
        Ok(submission)
    }
}
