//! Functions that find the role of a request's sender, from the secrets in the request.
use crate::domain::{
    Admin, App, Member, Person, RemoteWorker, Secrets, Staff, Visitor,
    accounts::identity::{self, SessionState},
    view::Account,
};
use crate::{
    db::read_row,
    problem::{Problem, ensure},
    values,
};
use std::time::Instant;

impl App {
    /// Returns the account that the secrets belong to.
    async fn find_account(&self, secrets: &Secrets) -> Result<(Account, Option<SessionState>), Problem> {
        let (account, state) = match secrets {
            Secrets { bearer: Some(token), .. } => {
                let mut transaction = self.0.database.read().await?;
                (identity::find_token_owner(&mut transaction, token).await?.0, None)
            }
            Secrets { session: Some(session), .. } => {
                let mut transaction = self.0.database.read().await?;
                let found = identity::find_session_account(&mut transaction, session).await?;
                drop(transaction);
                let (account, state) = found.ok_or_else(|| Problem::unknown_secret("session", "sign in again"))?;
                if state.is_stale {
                    let mut transaction = self.0.database.begin().await?;
                    identity::extend_session(&mut transaction, session).await?;
                    transaction.commit().await?;
                }
                (account, Some(state))
            }
            _ => return Err(Problem::not_signed_in()),
        };
        if !self.0.throttle.try_acquire(account.id, self.requests_per_minute, Instant::now()) {
            let limit = self.requests_per_minute;
            return Err(Problem::too_many(format!("an account may send {limit} requests in a minute")));
        }
        Ok((account, state))
    }

    /// Returns the request's sender as a visitor. A visitor need not be signed in.
    pub fn visitor(&self, secrets: Secrets) -> Visitor {
        Visitor { app: self.clone(), secrets }
    }

    /// Returns the person who is signed in.
    ///
    /// # Errors
    ///
    /// Fails if the request is not signed in, or there are too many requests.
    pub async fn person(&self, secrets: &Secrets) -> Result<Person, Problem> {
        let (account, session) = self.find_account(secrets).await?;
        Ok(Person { account, session, app: self.clone() })
    }

    /// Returns the worker to which a token belongs. The worker itself chooses its name.
    ///
    /// # Errors
    ///
    /// Fails if the token does not belong to a worker, or is no longer valid.
    pub async fn authenticate_worker(&self, token: &str, name: &str) -> Result<RemoteWorker, Problem> {
        let mut transaction = self.0.database.read().await?;
        let statement = "SELECT id, name FROM token WHERE digest = ? AND account IS NULL AND revoked_at IS NULL";
        let row = transaction.row(statement, values![identity::digest(token)]).await?;
        let Some(row) = row else {
            return Err(Problem::unknown_secret("worker token", "ask the server's administrator for a new token"));
        };
        Ok(RemoteWorker::new(self.clone(), row.int("id")?, &row.text("name")?, name))
    }
}

impl Person {
    /// Returns whether the session was extended. The browser's cookie must then be extended as well.
    pub fn is_renewed(&self) -> bool {
        self.session.as_ref().is_some_and(|session| session.is_stale)
    }

    /// Returns the person as a member of a course.
    ///
    /// # Errors
    ///
    /// Fails if the person is not a member, or if the course does not exist. Both give the same error, so that
    /// outsiders do not learn whether a course exists.
    pub async fn into_member(self, slug: &str) -> Result<Member, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT course.id, course.slug, course.title, member.role FROM course
            LEFT JOIN member ON member.course = course.id AND member.account = ?
            WHERE course.slug = ?";
        let row = transaction.row(statement, values![self.account.id, slug]).await?;
        let Some(row) = row else { return Err(Problem::not_found("course")) };
        let role = row.maybe_text("role")?;
        ensure(role.is_some() || self.account.is_admin, Problem::not_found("course"))?;
        let row = &row;
        Ok(read_row!(row => Member {
            course = "id", slug, title;
            is_staff: self.account.is_admin || role.as_deref() == Some("staff"),
            account: self.account,
            app: self.app,
        }))
    }

    /// Returns the person as an administrator.
    ///
    /// # Errors
    ///
    /// Fails if the person is not an administrator.
    pub fn admin(self) -> Result<Admin, Problem> {
        ensure(self.account.is_admin, Problem::not_allowed("only administrators can do this"))?;
        Ok(Admin { account: self.account, app: self.app })
    }
}

impl Member {
    /// Returns the person as staff of the course.
    ///
    /// # Errors
    ///
    /// Fails if the person is not staff.
    pub fn into_staff(self) -> Result<Staff, Problem> {
        if self.is_staff { Ok(Staff(self)) } else { Err(Problem::not_allowed("only the course's staff can do this")) }
    }
}
