//! A member of a course. Students see only their own submissions; staff see all submissions of the course.
use crate::domain::{
    App,
    assignments::suites::{SuiteGroup, read_suites},
    view::{self, Account, Assignment, History, LogEntry, Submission},
};
use crate::{
    db::{DbError, Transaction},
    problem::Problem,
    store::{Artifact, Digest, OpenArtifact},
    task::OutputFile,
    values,
    visible_grade::{self, VisibleGrade},
    worker::{PUBLISHED_PAGE, STAFF_PAGE},
};
use futures_util::StreamExt;

/// The name of the report that students get. It leaves out the groups that the suite hides.
const STUDENT_PAGE: &str = "report.html";

/// A member of a course.
pub struct Member {
    pub(crate) account: Account,
    pub(in crate::domain) course: i64,
    pub(crate) slug: String,
    pub(crate) title: String,
    pub(crate) is_staff: bool,
    pub(crate) app: App,
}

impl Member {
    /// Creates an entry for the course's audit log, in this member's name.
    pub(in crate::domain) fn entry<'a>(
        &self,
        kind: &'static str,
        assignment: Option<i64>,
        text: &'a str,
    ) -> LogEntry<'a> {
        LogEntry { course: Some(self.course), assignment, ..LogEntry::new(kind, self.account.id, text) }
    }

    /// Returns the assignments that the member may see.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn assignments(&self) -> Result<Vec<Assignment>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT id, slug, title, visible, settings, published_at, revision FROM assignment
            WHERE course = ? AND (visible = 1 OR ? = 1) ORDER BY id";
        let assignments: Vec<Assignment> = transaction.all(statement, values![self.course, self.is_staff]).await?;
        Ok(assignments.into_iter().map(|assignment| self.hide_course_suite(assignment)).collect())
    }

    /// Returns an assignment as this member may see it. A suite that was uploaded to the course is hidden from
    /// students, with the name of the suite that it replaced.
    fn hide_course_suite(&self, mut assignment: Assignment) -> Assignment {
        if !self.is_staff && assignment.settings.suite_archive.take().is_some() {
            assignment.settings.suite.clear();
        }
        assignment
    }

    /// Returns an assignment of the member's course.
    ///
    /// # Errors
    ///
    /// Fails if the assignment does not exist.
    pub async fn assignment(&self, slug: &str) -> Result<Assignment, Problem> {
        Ok(self.hide_course_suite(self.read_assignment(slug).await?.1))
    }

    /// Returns the groups of an assignment's suite; empty if they are not known. Published groups are not hidden.
    ///
    /// # Errors
    ///
    /// Fails if the assignment does not exist.
    pub async fn suite_groups(&self, slug: &str) -> Result<Vec<SuiteGroup>, Problem> {
        let (mut transaction, assignment) = self.read_assignment(slug).await?;
        let Some(digest) = assignment.settings.suite_archive else {
            return Ok(self.app.suites.groups(&assignment.settings.suite).to_vec());
        };
        let statement = "SELECT parts FROM suite WHERE course = ? AND digest = ?";
        let row = transaction.row(statement, values![self.course, digest]).await?;
        let parts = row.map(|row| row.maybe_text("parts")).transpose()?.flatten();
        let mut groups: Vec<SuiteGroup> = parts.and_then(|parts| serde_json::from_str(&parts).ok()).unwrap_or_default();
        groups.iter_mut().for_each(|group| group.is_hidden &= assignment.published_at.is_none());
        Ok(groups)
    }

    /// Begins a transaction that reads, and finds the assignment.
    pub(in crate::domain) async fn read_assignment(&self, slug: &str) -> Result<(Transaction, Assignment), Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let assignment = self.find_assignment(&mut transaction, slug).await?;
        Ok((transaction, assignment))
    }

    pub(in crate::domain) async fn find_assignment(
        &self,
        transaction: &mut Transaction,
        slug: &str,
    ) -> Result<Assignment, Problem> {
        let statement = "SELECT id, slug, title, visible, settings, published_at, revision FROM assignment
            WHERE course = ? AND slug = ? AND (visible = 1 OR ? = 1)";
        let found = transaction.find(statement, values![self.course, slug, self.is_staff]).await?;
        found.ok_or_else(|| Problem::not_found("assignment"))
    }

    /// Returns the member's own submissions to an assignment, newest first.
    ///
    /// # Errors
    /// Fails if there is no such assignment.
    pub async fn submissions(&self, assignment: &str) -> Result<Vec<Submission>, Problem> {
        let (mut transaction, assignment) = self.read_assignment(assignment).await?;
        let mut submissions = view::submissions_of(&mut transaction, assignment.id, self.account.id).await?;
        for submission in &mut submissions {
            if !self.is_staff {
                submission.fault = None;
            }
            // In old results, the hidden parts are not stored separately yet. They can be separated only with the
            // files.
            if submission.grade.as_ref().is_some_and(|grade| !self.is_staff && grade.shown.is_none()) {
                *submission = self.find_submission(&mut transaction, submission.id).await?;
                submission.grade.iter_mut().for_each(|grade| grade.outcome.files.clear());
            } else {
                self.withhold(submission).await?;
            }
        }
        Ok(submissions)
    }

    /// Returns all submissions to the same assignment by the owner of a submission, newest first.
    ///
    /// # Errors
    ///
    /// Fails if the member does not see the assignment.
    pub async fn attempts(&self, submission: &Submission) -> Result<Vec<Submission>, Problem> {
        if !self.is_staff {
            return self.submissions(&submission.assignment).await;
        }
        let (mut transaction, assignment) = self.read_assignment(&submission.assignment).await?;
        Ok(view::submissions_of(&mut transaction, assignment.id, submission.account).await?)
    }

    /// Removes everything from a submission that the reader may not see: parts for staff, groups that the suite hides
    /// and that are not published, and report pages that show another part of the grade.
    async fn withhold(&self, submission: &mut Submission) -> Result<(), Problem> {
        let Some(grade) = submission.grade.as_mut() else { return Ok(()) };
        let files = &mut grade.outcome.files;
        files.retain(|file| self.is_staff || file.name != STAFF_PAGE);
        if self.is_staff || submission.is_published {
            // Students see the page without hidden groups.
            if files.iter().any(|file| file.name == PUBLISHED_PAGE) {
                files.retain(|file| file.name != STUDENT_PAGE);
            }
            return Ok(());
        }
        // Older versions did not separate the hidden parts.
        let text = match grade.outcome.shown.take() {
            Some(text) => text,
            None => visible_grade::read_texts(&self.app.0.store, &grade.outcome.files).await?.shown,
        };
        if let Some(visible_grade) = VisibleGrade::from_text(&text) {
            visible_grade.limit_to_students(&mut grade.outcome, STUDENT_PAGE);
            grade.created_at = visible_grade::round_to_hour(grade.created_at);
            submission.is_withheld = true;
            grade.outcome.shown = Some(text);
            submission.apply_staff_points();
        }
        Ok(())
    }

    pub(in crate::domain) async fn find_submission(
        &self,
        transaction: &mut Transaction,
        id: i64,
    ) -> Result<Submission, Problem> {
        let found = view::submission(transaction, &self.app, self.course, id).await?;
        let found = found.filter(|submission| self.is_staff || submission.account == self.account.id);
        let mut submission = found.ok_or_else(|| Problem::not_found("submission"))?;
        if !self.is_staff {
            submission.fault = None;
        }
        self.withhold(&mut submission).await?;
        Ok(submission)
    }

    /// Returns a submission by its ID. Students find only their own, staff all submissions of the course.
    ///
    /// # Errors
    ///
    /// Fails if the member can see no submission with this ID.
    pub async fn submission(&self, id: i64) -> Result<Submission, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        self.find_submission(&mut transaction, id).await
    }

    /// Returns the history of a submission's grade.
    ///
    /// # Errors
    ///
    /// Fails if the member can see no submission with this ID.
    pub async fn history(&self, id: i64) -> Result<Vec<History>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let submission = self.find_submission(&mut transaction, id).await?;
        let uploaded = if self.is_staff { Some(read_suites(&mut transaction, self.course).await?) } else { None };
        Ok(view::history(&mut transaction, id, submission.is_withheld, uploaded.as_deref()).await?)
    }

    /// Returns the report called `name` of the submission with the ID `id`.
    ///
    /// # Errors
    ///
    /// Fails if there is no report with this name.
    pub async fn report(&self, id: i64, name: &str) -> Result<OutputFile, Problem> {
        let submission = self.read_with_bytes(id).await?;
        submission
            .grade
            .and_then(|grade| grade.outcome.files.into_iter().find(|file| file.name == name))
            .ok_or_else(|| Problem::not_found("report"))
    }

    /// Returns a submission and its uploaded file.
    ///
    /// # Errors
    ///
    /// Fails if the member can see no submission with this ID.
    pub async fn upload(&self, id: i64) -> Result<(Submission, Artifact), Problem> {
        let submission = self.read_with_bytes(id).await?;
        let wrong = |what: &str| Problem::from(DbError::Other(format!("a submission's {what} is invalid")));
        let digest: Digest = submission.digest.parse().map_err(|_| wrong("digest"))?;
        let size = u64::try_from(submission.size).map_err(|_| wrong("size"))?;
        Ok((submission, Artifact { digest, size }))
    }

    /// Returns a submission whose uploaded file is still stored.
    async fn read_with_bytes(&self, id: i64) -> Result<Submission, Problem> {
        let submission = self.submission(id).await?;
        if submission.removed_at.is_some() { Err(Problem::removed()) } else { Ok(submission) }
    }

    /// Opens an artifact. The caller must have checked that the member may see it.
    ///
    /// # Errors
    ///
    /// Fails if the artifact cannot be read.
    pub async fn open(&self, artifact: &Artifact) -> Result<OpenArtifact, Problem> {
        Ok(self.app.0.store.open(&artifact.digest).await?)
    }

    /// Returns the first bytes of an artifact. The caller must have checked that the member may see it.
    ///
    /// # Errors
    ///
    /// Fails if the artifact cannot be read.
    pub async fn read_beginning(&self, artifact: &Artifact, max: usize) -> Result<Vec<u8>, Problem> {
        let mut pieces = self.open(artifact).await?.pieces;
        let mut bytes = Vec::new();
        while bytes.len() < max
            && let Some(piece) = pieces.next().await
        {
            bytes.extend_from_slice(&piece?);
        }
        bytes.truncate(max);
        Ok(bytes)
    }
}
