//! A person who is signed in.
use crate::domain::{
    App,
    accounts::identity::{self, NewToken, SessionState, SignInMethod, TokenInfo},
    view::{Account, Course},
};
use crate::{
    db::{DbError, FromRow, Row},
    problem::{Problem, ensure},
    values,
};
use serde::Serialize;
use utoipa::ToSchema;

/// A course, and the role of a person in it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct CourseMembership {
    /// The course of which the person is a member.
    #[serde(flatten)]
    pub course: Course,
    /// The person's role in the course: `student`, `staff`, or `admin`.
    pub role: String,
}

/// A person who is signed in.
#[derive(Clone)]
pub struct Person {
    pub(crate) account: Account,
    /// The browser's session; `None` for a token.
    pub(in crate::domain) session: Option<SessionState>,
    pub(crate) app: App,
}

impl Person {
    /// Returns whether the person signed in with a token, directly or at the beginning of the session.
    pub fn uses_token(&self) -> bool {
        self.session.as_ref().is_none_or(|session| session.started_by_token)
    }

    /// Returns the session if the person uses a browser. Requests with a token get an error, because a token must not
    /// create rights that outlive it.
    pub(in crate::domain) fn require_browser(&self) -> Result<&SessionState, Problem> {
        let session = self.session.as_ref().filter(|_| !self.uses_token());
        session.ok_or_else(|| {
            Problem::sign_in_again("this is not possible with a token, or in a session started with one")
        })
    }

    /// Returns the session if the person signed in recently, so that somebody who finds an open browser cannot create
    /// further ways to sign in.
    pub(in crate::domain) fn require_recent_browser(&self) -> Result<&SessionState, Problem> {
        let session = self.require_browser()?;
        ensure(session.is_recent, Problem::sign_in_again("you signed in more than twelve hours ago"))?;
        Ok(session)
    }

    /// Returns the courses that the person may see.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn courses(&self) -> Result<Vec<CourseMembership>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let all: i64 = self.account.is_admin.into();
        let statement = "SELECT course.slug, course.title, coalesce(member.role, 'admin') AS role FROM course
            LEFT JOIN member ON member.course = course.id AND member.account = ?
            WHERE member.role IS NOT NULL OR ? = 1
            ORDER BY course.slug";
        let rows = transaction.rows(statement, values![self.account.id, all]).await?;
        let read = |row: &Row| Ok(CourseMembership { course: Course::from_row(row)?, role: row.text("role")? });
        Ok(rows.iter().map(read).collect::<Result<_, DbError>>()?)
    }

    /// Returns the person's tokens.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn tokens(&self) -> Result<Vec<TokenInfo>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT id, name, created_at FROM token WHERE account = ? AND revoked_at IS NULL ORDER BY id";
        Ok(transaction.all(statement, values![self.account.id]).await?)
    }

    /// Creates a token.
    ///
    /// # Errors
    ///
    /// Fails if its name is invalid or taken, there are too many, or the person did not sign in recently.
    pub async fn new_token(&self, name: &str) -> Result<NewToken, Problem> {
        identity::check_title("a token's name", name)?;
        let way =
            if self.require_recent_browser()?.from_staff_link { SignInMethod::ByStaff } else { SignInMethod::Own };
        let mut transaction = self.app.0.database.begin().await?;
        let statement = "SELECT count(*) AS n, count(CASE WHEN name = ? THEN 1 END) AS with_name FROM token
            WHERE account = ? AND revoked_at IS NULL";
        let count = transaction.one(statement, values![name, self.account.id]).await?;
        let name_conflict =
            Problem::conflict("you already have a token with this name", "choose another name, or revoke that token");
        ensure(count.int("with_name")? == 0, name_conflict)?;
        ensure(count.int("n")? < 50, Problem::conflict("an account has at most 50 tokens", "revoke unused ones"))?;
        let token = identity::new_token(&mut transaction, Some(self.account.id), name, self.account.id, way).await?;
        transaction.commit().await?;
        Ok(token)
    }

    /// Revokes a token of the person.
    ///
    /// # Errors
    ///
    /// Fails if the person has no token with this ID.
    pub async fn revoke_token(&self, id: i64) -> Result<(), Problem> {
        let mut transaction = self.app.0.database.begin().await?;
        let statement = "UPDATE token SET revoked_at = {now} WHERE id = ? AND account = ? AND revoked_at IS NULL";
        let revoked = transaction.execute(statement, values![id, self.account.id]).await?;
        transaction.commit().await?;
        if revoked == 0 { Err(Problem::not_found("token")) } else { Ok(()) }
    }
}
