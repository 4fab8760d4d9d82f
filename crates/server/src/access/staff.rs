//! The staff of a course.
use super::{
    Member, Settings, bulk, identity,
    view::{self, Assignment, Event, Queue, Submission},
};
use crate::{
    db::{DbError, FromRow, Transaction},
    lti::score,
    problem::Problem,
    values,
};
use serde::Serialize;
use std::{
    collections::{BTreeMap, BTreeSet},
    ops::Deref,
    path::Path,
};
use utoipa::ToSchema;

/// Somebody of a course's staff.
pub struct Staff(pub(super) Member);

/// How a student stands in an assignment.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Standing {
    /// The name of their account.
    pub login: String,
    /// Their name.
    pub name: String,
    /// How often they handed in.
    pub submissions: usize,
    /// The submission that counts: the one with the most points, the later one of equals; the last one while none has
    /// points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub counts: Option<Submission>,
}

impl Deref for Staff {
    type Target = Member;

    fn deref(&self) -> &Member {
        &self.0
    }
}

impl Staff {
    /// Writes into the course's audit log.
    pub(super) async fn note(
        &self,
        transaction: &mut Transaction,
        kind: &'static str,
        assignment: Option<i64>,
        text: &str,
    ) -> Result<(), DbError> {
        view::note(transaction, &self.entry(kind, assignment, text)).await
    }

    /// Makes an assignment, or changes it. Groups that another suite may hide were not meant when those of the last one
    /// were published: they are withheld.
    ///
    /// # Errors
    /// When something in it makes no sense.
    pub async fn set_assignment(
        &self,
        slug: &str,
        title: &str,
        visible: Option<bool>,
        settings: Option<&Settings>,
    ) -> Result<Assignment, Problem> {
        self.change_assignment(slug, title, visible, settings, true).await
    }

    /// The same; another suite is known to hide groups or not to.
    async fn change_assignment(
        &self,
        slug: &str,
        title: &str,
        visible: Option<bool>,
        settings: Option<&Settings>,
        hides: bool,
    ) -> Result<Assignment, Problem> {
        identity::check_slug("an assignment's name", slug)?;
        identity::check_title("a title", title)?;
        let mut transaction = self.app.0.database.begin().await?;
        let statement = "SELECT visible, settings, published_at FROM assignment WHERE course = ? AND slug = ?";
        let before = transaction.row(statement, values![self.course, slug]).await?;
        let was_visible = before.as_ref().map(|row| row.flag("visible")).transpose()?;
        let was_published = before.as_ref().map(|row| row.maybe_int("published_at")).transpose()?.flatten().is_some();
        let visible = visible.or(was_visible).unwrap_or_default();
        let before = before.map(|row| row.text("settings")).transpose()?;
        let before = before.and_then(|text| Settings::read(&text).ok()).unwrap_or_default();
        let settings = settings.unwrap_or(&before).checked(&self.app.suites)?;
        if let Some(digest) = settings.suite_archive.as_ref().and_then(|digest| digest.parse().ok())
            && !self.app.0.store.has(&digest).await?
        {
            return Err(Problem::conflict(
                "suite_archive: nothing of this digest was uploaded",
                "upload the archive first",
            ));
        }
        let statement = "INSERT INTO assignment (course, slug, title, visible, settings, created_at)
            VALUES (?, ?, ?, ?, ?, {now})
            ON CONFLICT (course, slug) DO UPDATE SET title = excluded.title, visible = excluded.visible,
               settings = excluded.settings, published_at = CASE WHEN ? = 0 THEN assignment.published_at END
            RETURNING id, slug, title, visible, settings, published_at";
        let is_same_suite = (&before.suite, &before.suite_archive) == (&settings.suite, &settings.suite_archive);
        let withholds = was_published && hides && !is_same_suite;
        let values = values![self.course, slug, title, visible, settings.text(), withholds];
        let assignment = Assignment::from_row(&transaction.one(statement, values).await?)?;
        // Late submissions may be worth something else now, and platforms hear of what is shown.
        if withholds || before.late_policy() != settings.late_policy() {
            score::send_all(&mut transaction, assignment.id, false).await?;
        }
        // A job that waits because nothing could be graded is tried by the new settings.
        bulk::resume(&mut transaction, &assignment).await?;
        let mut text = format!("{slug} ({title}), {}", if visible { "visible" } else { "hidden" });
        let changes = settings.changes(&before);
        if !changes.is_empty() {
            text = format!("{text}: {changes}");
        }
        if withholds {
            text.push_str("; hidden groups are withheld");
        }
        self.note(&mut transaction, "assignment", Some(assignment.id), &text).await?;
        transaction.commit().await?;
        if withholds {
            self.app.0.notifier.wake();
        }
        Ok(assignment)
    }

    /// Shows students what the suite hides, or withholds it again; platforms are told what is shown.
    ///
    /// # Errors
    /// When there is no such assignment.
    pub async fn publish(&self, slug: &str, published: bool) -> Result<Assignment, Problem> {
        let mut transaction = self.begin().await?;
        let assignment = self.find_assignment(&mut transaction, slug).await?;
        let statement = "UPDATE assignment SET published_at = CASE WHEN ? = 1 THEN {now} END WHERE id = ?
            RETURNING id, slug, title, visible, settings, published_at";
        let row = transaction.one(statement, values![published, assignment.id]).await?;
        let text = format!("hidden groups of {slug} are {}", if published { "published" } else { "withheld" });
        self.note(&mut transaction, "assignment", Some(assignment.id), &text).await?;
        score::send_all(&mut transaction, assignment.id, false).await?;
        self.app.0.notifier.commit(transaction).await?;
        Ok(Assignment::from_row(&row)?)
    }

    /// Stores an archive with a suite and makes it the assignment's. Submissions from now on are graded by it.
    ///
    /// # Errors
    /// When there is no such assignment, or the store fails.
    pub async fn set_suite(&self, slug: &str, archive: &Path, hides: bool) -> Result<Assignment, Problem> {
        let assignment = self.assignment(slug).await?;
        let artefact = self.app.0.store.put_file(archive).await?;
        let settings = Settings { suite_archive: Some(artefact.digest.to_string()), ..assignment.settings };
        self.change_assignment(slug, &assignment.title, None, Some(&settings), hides).await
    }

    /// Whether something that was handed in to an assignment was graded by a suite that hides groups.
    ///
    /// # Errors
    /// When the database does not answer.
    pub async fn hides(&self, assignment: &Assignment) -> Result<bool, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        // Of what older versions graded nobody may have looked yet.
        let statement = "SELECT result.id FROM submission JOIN result ON result.submission = submission.id
            WHERE submission.assignment = ? AND coalesce(result.shown, 'unknown') <> '' AND result.code <> 'JE'
            LIMIT 1";
        Ok(transaction.row(statement, values![assignment.id]).await?.is_some())
    }

    /// How all students stand in an assignment.
    ///
    /// # Errors
    /// When there is no such assignment.
    pub async fn standings(&self, assignment: &str) -> Result<Vec<Standing>, Problem> {
        let (mut transaction, assignment) = self.read_at(assignment).await?;
        let statement = "SELECT account.login, account.name, member.role FROM member
            JOIN account ON account.id = member.account WHERE member.course = ?";
        let rows = transaction.rows(statement, values![self.course]).await?;
        let (mut standings, mut others) = (BTreeMap::new(), BTreeSet::new());
        let empty = |login: String, name: String| Standing { login, name, submissions: 0, counts: None };
        for row in rows {
            let (login, name) = (row.text("login")?, row.text("name")?);
            if row.text("role")? == "student" {
                standings.insert(login.clone(), empty(login, name));
            } else {
                others.insert(login);
            }
        }
        let points = |submission: &Submission| {
            let points = submission.grade.as_ref()?.points.as_ref()?;
            points.parse::<f64>().ok()
        };
        let mut after = 0;
        loop {
            let page = view::submissions_after(&mut transaction, assignment.id, after).await?;
            let Some(last) = page.last() else { break };
            after = last.id;
            // Staff tries assignments, too.
            for submission in page.into_iter().filter(|one| !others.contains(&one.login)) {
                let standing = standings
                    .entry(submission.login.clone())
                    .or_insert_with(|| empty(submission.login.clone(), submission.name.clone()));
                standing.submissions += 1;
                let best = standing.counts.as_ref().and_then(points);
                if best.is_none() || points(&submission) >= best {
                    standing.counts = Some(submission);
                }
            }
        }
        Ok(standings.into_values().collect())
    }

    /// Submissions to an assignment of the course behind the one of this number, oldest first: a page of them, none
    /// behind the last.
    ///
    /// # Errors
    /// When the database does not answer.
    pub async fn submissions_after(&self, assignment: i64, after: i64) -> Result<Vec<Submission>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        Ok(view::submissions_after(&mut transaction, assignment, after).await?)
    }

    /// The events of the course before the one of this number, latest first; with `None` up to now.
    ///
    /// # Errors
    /// When the database does not answer.
    pub async fn audit(&self, before: Option<i64>) -> Result<Vec<Event>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT event.id, happened_at, kind, account.login, submission, text FROM event
            LEFT JOIN account ON account.id = event.actor
            WHERE event.course = ? AND event.id < ? ORDER BY event.id DESC LIMIT 200";
        Ok(transaction.all(statement, values![self.course, before.unwrap_or(i64::MAX)]).await?)
    }

    /// The queue and the workers.
    ///
    /// # Errors
    /// When the database does not answer.
    pub async fn queue(&self) -> Result<Queue, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        Ok(view::queue(&mut transaction, &self.app).await?)
    }

    pub(super) async fn begin(&self) -> Result<Transaction, Problem> {
        Ok(self.app.0.database.begin().await?)
    }
}
