//! The staff of a course, and the actions that only they can perform.
use crate::domain::{
    Member, Settings,
    accounts::identity,
    assignments::suites::{SuiteGroup, UploadedSuite, read_suites},
    view::{self, Assignment, Event, EventQuery, Queue, Submission},
};
use crate::{
    db::{DbError, FromRow, Transaction},
    lti::score,
    problem::{Problem, ensure},
    values,
};
use std::{ops::Deref, path::Path};

/// A member of a course who belongs to its staff.
pub struct Staff(pub(in crate::domain) Member);

/// A change of an assignment. Parts that are `None` stay as they are.
#[derive(Debug, Clone, Copy, Default)]
pub struct AssignmentChange<'a> {
    /// The assignment's title.
    pub title: Option<&'a str>,
    /// Whether students see the assignment.
    pub visible: Option<bool>,
    /// The revision on which the change is based. The change is rejected if there is a later revision.
    pub revision: Option<i64>,
    /// A new suite for the assignment, which was just uploaded.
    pub suite: Option<&'a NewSuite>,
}

/// A suite that was just uploaded, and not yet given to an assignment.
#[derive(Debug, Clone, Default)]
pub struct NewSuite {
    /// The digest of the suite's archive.
    pub digest: String,
    /// The suite's name.
    pub name: String,
    /// The suite's groups.
    pub groups: Vec<SuiteGroup>,
}

/// Rejects a change if another person has changed the assignment since `revision`. The error names that person and
/// their change.
async fn check_revision(
    transaction: &mut Transaction,
    assignment: &Assignment,
    revision: Option<i64>,
) -> Result<(), Problem> {
    if revision.is_none_or(|revision| revision == assignment.revision) {
        return Ok(());
    }
    let statement = "SELECT account.login, event.text FROM event LEFT JOIN account ON account.id = event.actor
        WHERE event.assignment = ? AND event.kind IN ('assignment', 'regrade') ORDER BY event.id DESC LIMIT 1";
    let last = transaction.row(statement, values![assignment.id]).await?;
    let last = last.map(|row| Ok::<_, DbError>((row.maybe_text("login")?.unwrap_or_default(), row.text("text")?)));
    let (who, what) = last.transpose()?.unwrap_or_default();
    Err(Problem::changed(format!("{who} has changed it in the meantime: {what}")))
}

impl Deref for Staff {
    type Target = Member;

    fn deref(&self) -> &Member {
        &self.0
    }
}

impl Staff {
    /// Writes an entry into the course's audit log.
    pub(in crate::domain) async fn log_event(
        &self,
        transaction: &mut Transaction,
        kind: &'static str,
        assignment: Option<i64>,
        text: &str,
    ) -> Result<(), DbError> {
        view::log_event(transaction, &self.entry(kind, assignment, text)).await
    }

    /// Creates or changes an assignment. If the suite changes, the groups that the new suite hides are withheld, even
    /// if groups of the old suite were published.
    ///
    /// # Errors
    ///
    /// Fails if a part of the change is invalid, or the assignment was changed after `revision`.
    pub async fn set_assignment(
        &self,
        slug: &str,
        change: AssignmentChange<'_>,
        settings: impl FnOnce(&Settings) -> Result<Settings, Problem>,
    ) -> Result<Assignment, Problem> {
        identity::check_slug("an assignment's name", slug)?;
        let mut transaction = self.app.0.database.begin().await?;
        let statement = "SELECT id, slug, title, visible, settings, published_at, revision FROM assignment
            WHERE course = ? AND slug = ? {for update}";
        let before: Option<Assignment> = transaction.find(statement, values![self.course, slug]).await?;
        if let Some(before) = &before {
            check_revision(&mut transaction, before, change.revision).await?;
        }
        let title = change.title.or(before.as_ref().map(|before| before.title.as_str())).unwrap_or(slug);
        identity::check_title("a title", title)?;
        let was_published = before.as_ref().is_some_and(|before| before.published_at.is_some());
        let visible = change.visible.or(before.as_ref().map(|before| before.visible)).unwrap_or_default();
        let before = before.as_ref().map(|before| before.settings.clone()).unwrap_or_default();
        let settings = settings(&before)?.validate(&self.app.suites)?;
        if let Some(NewSuite { digest, name, groups }) = change.suite {
            let statement = "INSERT INTO suite (course, digest, name, parts, uploaded_at) VALUES (?, ?, ?, ?, {now})
                ON CONFLICT (course, digest) DO UPDATE SET name = excluded.name, parts = excluded.parts,
                   uploaded_at = excluded.uploaded_at";
            let groups = serde_json::to_string(groups).unwrap_or_default();
            transaction.execute(statement, values![self.course, digest, name, groups]).await?;
        }
        let suite = self.check_suite(&mut transaction, &settings).await?;
        let statement = "INSERT INTO assignment (course, slug, title, visible, settings, created_at)
            VALUES (?, ?, ?, ?, ?, {now})
            ON CONFLICT (course, slug) DO UPDATE SET title = excluded.title, visible = excluded.visible,
               settings = excluded.settings, revision = assignment.revision + 1,
               published_at = CASE WHEN ? = 0 THEN assignment.published_at END
            RETURNING id, slug, title, visible, settings, published_at, revision";
        // A suite whose groups are unknown may also hide some.
        let hides_groups = change.suite.is_none_or(|suite| suite.groups.iter().any(|group| group.is_hidden));
        let withholds_groups = was_published && hides_groups && !before.has_suite_of(&settings);
        let values = values![self.course, slug, title, visible, settings.to_json(), withholds_groups];
        let assignment = Assignment::from_row(&transaction.one(statement, values).await?)?;
        // A new rule for late work can change the points of late submissions, and platforms receive the shown points.
        if withholds_groups || before.late_policy() != settings.late_policy() {
            score::send_all(&mut transaction, assignment.id, false).await?;
        }
        let mut text = format!("saved {slug} ({title}), {}", if visible { "visible" } else { "hidden" });
        let changes = settings.describe_changes(&before, &suite);
        if !changes.is_empty() {
            text = format!("{text}: {changes}");
        }
        if withholds_groups {
            text.push_str("; withheld hidden groups");
        }
        self.log_event(&mut transaction, "assignment", Some(assignment.id), &text).await?;
        transaction.commit().await?;
        if withholds_groups {
            self.app.0.notifier.wake();
        }
        Ok(assignment)
    }

    /// Checks that an archive in settings is a suite of this course, because a digest alone must not give
    /// access. Returns its name.
    pub(in crate::domain) async fn check_suite(
        &self,
        transaction: &mut Transaction,
        settings: &Settings,
    ) -> Result<String, Problem> {
        let Some(digest) = &settings.suite_archive else { return Ok(String::new()) };
        let statement = "SELECT name FROM suite WHERE course = ? AND digest = ?";
        let suite = transaction.row(statement, values![self.course, digest]).await?;
        let is_stored = match digest.parse() {
            Ok(digest) if suite.is_some() => self.app.0.store.has(&digest).await?,
            _ => false,
        };
        ensure(
            is_stored,
            Problem::conflict("suite_archive: no suite of this digest was uploaded to this course", "upload it"),
        )?;
        Ok(suite.map_or(Ok(String::new()), |row| row.text("name"))?)
    }

    /// Publishes the groups that the suite hides, or withholds them again. Platforms then receive the points that
    /// students see.
    ///
    /// # Errors
    ///
    /// Fails if there is no such assignment.
    pub async fn publish(&self, slug: &str, published: bool) -> Result<Assignment, Problem> {
        let mut transaction = self.begin().await?;
        let assignment = self.find_assignment(&mut transaction, slug).await?;
        let statement =
            "UPDATE assignment SET published_at = CASE WHEN ? = 1 THEN {now} END, revision = revision + 1 WHERE id = ?
            RETURNING id, slug, title, visible, settings, published_at, revision";
        let row = transaction.one(statement, values![published, assignment.id]).await?;
        let text = format!("{} the hidden groups of {slug}", if published { "published" } else { "withheld" });
        self.log_event(&mut transaction, "assignment", Some(assignment.id), &text).await?;
        score::send_all(&mut transaction, assignment.id, false).await?;
        self.app.0.notifier.commit(transaction).await?;
        Ok(Assignment::from_row(&row)?)
    }

    /// Stores an archive with a suite, and makes it the assignment's suite. It grades later submissions.
    ///
    /// # Errors
    ///
    /// Fails if there is no such assignment, it was changed after `revision`, or the store fails.
    pub async fn set_suite(
        &self,
        slug: &str,
        archive: &Path,
        suite: NewSuite,
        revision: Option<i64>,
    ) -> Result<Assignment, Problem> {
        self.assignment(slug).await?;
        let suite = NewSuite { digest: self.app.0.store.put_file(archive).await?.digest.to_string(), ..suite };
        let change = AssignmentChange { revision, suite: Some(&suite), ..AssignmentChange::default() };
        let settings = |before: &Settings| Ok(Settings { suite_archive: Some(suite.digest.clone()), ..before.clone() });
        self.set_assignment(slug, change, settings).await
    }

    /// Returns the suites that were uploaded to the course, newest first.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn suites(&self) -> Result<Vec<UploadedSuite>, Problem> {
        Ok(read_suites(&mut self.app.0.database.read().await?, self.course).await?)
    }

    /// Returns whether the suite that graded any submission to an assignment hides groups. Only results that count
    /// are considered.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn is_hidden(&self, assignment: &Assignment) -> Result<bool, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        // Results of older versions may contain the hidden parts, too.
        let statement = "SELECT result.id FROM submission JOIN grade ON grade.submission = submission.id
            JOIN result ON result.id = grade.result
            WHERE submission.assignment = ? AND coalesce(result.shown, 'unknown') <> '' AND result.code <> 'JE'
            LIMIT 1";
        Ok(transaction.row(statement, values![assignment.id]).await?.is_some())
    }

    /// Returns a page of the submissions to an assignment, oldest first, from the first one after the ID `after`.
    /// The page after the last submission is empty.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn submissions_after(&self, assignment: i64, after: i64) -> Result<Vec<Submission>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        Ok(view::submissions_after(&mut transaction, assignment, after).await?)
    }

    /// Returns the newest events of the course that match the query, newest first.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn audit(&self, query: &EventQuery) -> Result<Vec<Event>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        Ok(view::events!(transaction, query, "AND event.course = ?", self.course))
    }

    /// Returns the state of the queue and of the workers.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn queue(&self) -> Result<Queue, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        Ok(view::queue(&mut transaction, &self.app).await?)
    }

    pub(in crate::domain) async fn begin(&self) -> Result<Transaction, Problem> {
        Ok(self.app.0.database.begin().await?)
    }
}
