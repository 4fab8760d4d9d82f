//! Coming into a further course, or becoming its staff: its staff invites, the person accepts, and until then nothing
//! of theirs changes.
use super::{
    Person, identity,
    view::{self, Course, Entry},
};
use crate::{
    db::{DbError, FromRow, Row, Transaction},
    problem::Problem,
    values,
};
use serde::Serialize;
use utoipa::ToSchema;

/// An invitation into a course.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Invitation {
    /// The course.
    #[serde(flatten)]
    pub course: Course,
    /// `student` or `staff`.
    pub role: String,
    /// The one who invited.
    pub by: String,
}

/// An invitation as it is kept.
struct Kept {
    /// The digest of its link.
    digest: String,
    course: i64,
    invitation: Invitation,
}

impl Person {
    /// The invitations that wait for an answer.
    ///
    /// # Errors
    /// When the database does not answer.
    pub async fn invitations(&self) -> Result<Vec<Invitation>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let kept = self.kept(&mut transaction).await?;
        Ok(kept.into_iter().map(|kept| kept.invitation).collect())
    }

    /// The course to which a link invites.
    ///
    /// # Errors
    /// When there is no such invitation for this person.
    pub async fn invitation(&self, secret: &str) -> Result<Invitation, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        Ok(self.by_secret(&mut transaction, secret).await?.invitation)
    }

    /// Accepts by the link that the course's staff handed over.
    ///
    /// # Errors
    /// When there is no such invitation for this person, or a token asks.
    pub async fn accept_by_link(&self, secret: &str) -> Result<Course, Problem> {
        let mut transaction = self.app.0.database.begin().await?;
        let kept = self.by_secret(&mut transaction, secret).await?;
        let session = self.lately_at_browser()?.digest.clone();
        self.join(transaction, kept, &session).await
    }

    /// Accepts without the link, or declines. Anybody who came by a link of another course's staff, who may have used
    /// it themselves, accepts by the invitation's own link only.
    ///
    /// # Errors
    /// When there is no such invitation, or it is not certain that it is the person.
    pub async fn answer_invitation(&self, course: &str, accept: bool) -> Result<(), Problem> {
        let mut transaction = self.app.0.database.begin().await?;
        let mut kept = self.kept(&mut transaction).await?.into_iter();
        let kept = kept.find(|kept| kept.invitation.course.slug == course);
        let kept = kept.ok_or_else(|| Problem::not_found("invitation"))?;
        if accept {
            let session = self.lately_at_browser()?;
            if session.is_vouched {
                let detail =
                    "you signed in by a link of another course's staff: open the link of the invitation itself";
                return Err(Problem::not_allowed(detail));
            }
            let session = session.digest.clone();
            return self.join(transaction, kept, &session).await.map(drop);
        }
        self.at_browser()?;
        self.forget(&mut transaction, &kept).await?;
        self.note_answer(&mut transaction, &kept, "declined").await?;
        Ok(transaction.commit().await?)
    }

    async fn join(&self, mut transaction: Transaction, kept: Kept, session: &str) -> Result<Course, Problem> {
        self.forget(&mut transaction, &kept).await?;
        enrol(&mut transaction, kept.course, self.account.id, &kept.invitation.role).await?;
        identity::end_vouched(&mut transaction, self.account.id, Some(session)).await?;
        self.note_answer(&mut transaction, &kept, "accepted").await?;
        transaction.commit().await?;
        Ok(kept.invitation.course)
    }

    async fn forget(&self, transaction: &mut Transaction, kept: &Kept) -> Result<(), DbError> {
        let statement = "DELETE FROM invitation WHERE course = ? AND account = ?";
        transaction.execute(statement, values![kept.course, self.account.id]).await.map(drop)
    }

    async fn note_answer(&self, transaction: &mut Transaction, kept: &Kept, answer: &str) -> Result<(), DbError> {
        let text = format!("{} {answer}: {}", self.account.login, kept.invitation.role);
        let entry = Entry { course: Some(kept.course), ..Entry::new("member", self.account.id, &text) };
        view::note(transaction, &entry).await
    }

    async fn by_secret(&self, transaction: &mut Transaction, secret: &str) -> Result<Kept, Problem> {
        let digest = identity::digest(secret);
        let found = self.kept(transaction).await?.into_iter().find(|kept| kept.digest == digest);
        found.ok_or_else(|| Problem::not_found("invitation"))
    }

    /// Their invitations.
    async fn kept(&self, transaction: &mut Transaction) -> Result<Vec<Kept>, DbError> {
        let statement =
            "SELECT invitation.digest, invitation.course, invitation.role, course.slug, course.title, inviter.login
            FROM invitation JOIN course ON course.id = invitation.course
            JOIN account AS inviter ON inviter.id = invitation.invited_by
            WHERE invitation.account = ? ORDER BY course.slug";
        let rows = transaction.rows(statement, values![self.account.id]).await?;
        let read = |row: &Row| {
            let course = Course::from_row(row)?;
            let invitation = Invitation { course, role: row.text("role")?, by: row.text("login")? };
            Ok(Kept { digest: row.text("digest")?, course: row.int("course")?, invitation })
        };
        rows.iter().map(read).collect()
    }
}

/// Makes somebody a member, or changes what they are, by the word of people here.
pub(super) async fn enrol(transaction: &mut Transaction, course: i64, account: i64, role: &str) -> Result<(), DbError> {
    let statement = "INSERT INTO member (course, account, role, created_at) VALUES (?, ?, ?, {now})
        ON CONFLICT (course, account) DO UPDATE SET role = excluded.role, platform = NULL";
    transaction.execute(statement, values![course, account, role]).await.map(drop)
}
