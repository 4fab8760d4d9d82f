//! The people in a course.
use crate::domain::{
    Staff,
    accounts::identity::{self, Link, SignInMethod},
};
use crate::{
    db::{DbError, Transaction, from_row},
    problem::{Problem, ensure},
    values,
};
use serde::Serialize;
use utoipa::ToSchema;

/// A member of a course.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct MemberInfo {
    /// The login of the member's account.
    pub login: String,
    /// The member's name.
    pub name: String,
    /// The member's role: `student` or `staff`.
    pub role: String,
    /// Whether the account belongs to this course alone. Then staff may change its name, and make links for a student.
    pub is_ours: bool,
}

/// The number of people that a page shows.
pub(in crate::domain) const PEOPLE_PER_PAGE: i64 = 200;

from_row! { MemberInfo { login, name, role, is_ours } }

/// Checks the login, the name and the role of a member, and describes all errors.
pub(in crate::domain) fn check_member(login: &str, name: &str, role: &str) -> Result<(), Problem> {
    let is_role = matches!(role, "student" | "staff");
    let role = ensure(is_role, Problem::invalid("a role must be student or staff"));
    let checks = [identity::check_slug("a login", login), identity::check_title("a name", name), role];
    let errors: Vec<String> = checks.into_iter().filter_map(|check| Some(check.err()?.detail)).collect();
    ensure(errors.is_empty(), Problem::invalid(errors.join("; ")))
}

impl Staff {
    /// Returns the course's members.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn members(&self) -> Result<Vec<MemberInfo>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT account.login, account.name, member.role,
               CAST(CASE WHEN account.managed_by = member.course THEN 1 ELSE 0 END AS {int}) AS is_ours FROM member
            JOIN account ON account.id = member.account WHERE member.course = ? ORDER BY account.login";
        Ok(transaction.all(statement, values![self.course]).await?)
    }

    /// Makes a person a member, or changes their role. A missing account is created, with a sign-in link. A member
    /// whose account belongs to this course alone gets the new name; administrators can rename all members. Only an
    /// administrator may add an account that another course's staff made, because that course's staff can sign in as
    /// this account.
    ///
    /// # Errors
    ///
    /// Fails if a name is invalid, or the member was changed after the event `since`.
    pub async fn set_member(&self, login: &str, name: &str, role: &str, since: Option<i64>) -> Result<Link, Problem> {
        check_member(login, name, role)?;
        let mut transaction = self.app.0.database.begin().await?;
        self.check_last_event(&mut transaction, ("member", None), &format!("{login} "), since).await?;
        let link = self.add_member(&mut transaction, login, name, role).await?;
        transaction.commit().await?;
        Ok(Link { link })
    }

    /// Returns the ID of the course's newest event. With this ID, a later request detects changes that were
    /// made in between.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn last_event(&self) -> Result<i64, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT coalesce(max(id), 0) AS id FROM event WHERE course = ?";
        Ok(transaction.one(statement, values![self.course]).await?.int("id")?)
    }

    /// Rejects a change if another person has changed the same thing after the event `since`. The error names
    /// that person and their change. A later event counts if it has the same kind and assignment, and its text begins
    /// with `beginning`.
    pub(in crate::domain) async fn check_last_event(
        &self,
        transaction: &mut Transaction,
        (kind, assignment): (&str, Option<i64>),
        beginning: &str,
        since: Option<i64>,
    ) -> Result<(), Problem> {
        let Some(seen) = since else { return Ok(()) };
        let statement = "SELECT account.login, event.text FROM event LEFT JOIN account ON account.id = event.actor
            WHERE event.course = ? AND event.id > ? AND event.kind = ? AND coalesce(event.assignment, 0) = ?
               AND {strpos}(event.text, ?) = 1
            ORDER BY event.id DESC LIMIT 1";
        let values = values![self.course, seen, kind, assignment.unwrap_or(0), beginning];
        let Some(row) = transaction.row(statement, values).await? else { return Ok(()) };
        let (who, what) = (row.maybe_text("login")?.unwrap_or_default(), row.text("text")?);
        Err(Problem::changed(format!("{who} has changed it in the meantime: {what}")))
    }

    pub(in crate::domain) async fn add_member(
        &self,
        transaction: &mut Transaction,
        login: &str,
        name: &str,
        role: &str,
    ) -> Result<Option<String>, Problem> {
        let course = self.course;
        let statement = "INSERT INTO account (login, name, managed_by, created_at) VALUES (?, ?, ?, {now})
            ON CONFLICT (login) DO NOTHING RETURNING id";
        let created = transaction.row(statement, values![login, name, course]).await?;
        if let Some(made) = created {
            let account = made.int("id")?;
            self.write_member(transaction, account, login, role).await?;
            return Ok(self.create_link(transaction, account, self.sign_in_method()).await?);
        }
        let found = transaction
            .one("SELECT id, name, managed_by FROM account WHERE login = ? {for update}", values![login])
            .await?;
        let (account, managed_by) = (found.int("id")?, found.maybe_int("managed_by")?);
        let is_admin = self.account.is_admin;
        let statement = "SELECT role FROM member WHERE course = ? AND account = ?";
        let old_role = transaction.row(statement, values![course, account]).await?;
        let old_role = old_role.map(|row| row.text("role")).transpose()?;
        if old_role.is_some() && found.text("name")? != name && (is_admin || managed_by == Some(course)) {
            transaction.execute("UPDATE account SET name = ? WHERE id = ?", values![name, account]).await?;
            self.log_event(transaction, "member", None, &format!("{login} was renamed")).await?;
        }
        if old_role.as_deref() == Some(role) {
            return Ok(None);
        }
        self.check_remaining(transaction, login, role).await?;
        let is_managed_elsewhere = managed_by.is_some_and(|other| other != course);
        if is_managed_elsewhere && !is_admin {
            let detail = format!("{login} is an account of another course; ask an administrator to add it");
            return Err(Problem::not_allowed(detail));
        }
        let ends_access = is_admin && role == "staff" && !identity::is_trusted(transaction, account).await?;
        if ends_access {
            identity::end_all_access(transaction, account).await?;
        } else if is_managed_elsewhere {
            identity::end_staff_access(transaction, account).await?;
        }
        self.write_member(transaction, account, login, role).await?;
        let needs_link = ends_access || is_managed_elsewhere;
        if needs_link { Ok(self.create_link(transaction, account, SignInMethod::Own).await?) } else { Ok(None) }
    }

    /// Checks that the course still has a member of staff if this person's role ends.
    async fn check_remaining(&self, transaction: &mut Transaction, login: &str, role: &str) -> Result<(), Problem> {
        let statement = "SELECT count(*) AS n FROM member WHERE course = ? AND role = 'staff' AND account <> ?";
        let leaves_staff = login == self.account.login && role != "staff" && !self.account.is_admin;
        if leaves_staff && transaction.one(statement, values![self.course, self.account.id]).await?.int("n")? == 0 {
            return Err(Problem::conflict("you are the last of the course's staff", "make another member staff first"));
        }
        Ok(())
    }

    /// Returns the sign-in method of links that this person creates.
    fn sign_in_method(&self) -> SignInMethod {
        if self.account.is_admin { SignInMethod::Own } else { SignInMethod::ByStaff }
    }

    /// Creates a sign-in link for a person. It works once.
    async fn create_link(
        &self,
        transaction: &mut Transaction,
        account: i64,
        method: SignInMethod,
    ) -> Result<Option<String>, DbError> {
        let secret = identity::new_link(transaction, account, Some(self.account.id), method).await?;
        Ok(Some(self.app.welcome_address(&secret)))
    }

    async fn write_member(
        &self,
        transaction: &mut Transaction,
        account: i64,
        login: &str,
        role: &str,
    ) -> Result<(), DbError> {
        let statement = "INSERT INTO member (course, account, role, created_at) VALUES (?, ?, ?, {now})
            ON CONFLICT (course, account) DO UPDATE SET role = excluded.role, platform = NULL";
        transaction.execute(statement, values![self.course, account, role]).await?;
        self.log_event(transaction, "member", None, &format!("{login} became {role}")).await
    }

    /// Removes a person from the course; their submissions stay.
    ///
    /// # Errors
    ///
    /// Fails if the person is not a member, or was changed after the event `since`.
    pub async fn remove_member(&self, login: &str, since: Option<i64>) -> Result<(), Problem> {
        let mut transaction = self.app.0.database.begin().await?;
        self.check_last_event(&mut transaction, ("member", None), &format!("{login} "), since).await?;
        self.check_remaining(&mut transaction, login, "out").await?;
        let statement = "DELETE FROM member WHERE course = ? AND account = (SELECT id FROM account WHERE login = ?)";
        let removed = transaction.execute(statement, values![self.course, login]).await?;
        ensure(removed > 0, Problem::not_found("member"))?;
        self.log_event(&mut transaction, "member", None, &format!("{login} was removed")).await?;
        Ok(transaction.commit().await?)
    }

    /// Returns a new sign-in link for a student. It works once. Staff can create it only for accounts that belong to
    /// this course alone: this course created them, and they are in no other course and not connected to a provider or
    /// a platform. Otherwise staff could act as a person with rights elsewhere.
    ///
    /// # Errors
    ///
    /// Fails if the account does not belong to this course alone, or is not a member.
    pub async fn new_link(&self, login: &str) -> Result<Link, Problem> {
        let mut transaction = self.app.0.database.begin().await?;
        let statement = "SELECT account.id, account.is_admin, account.managed_by, member.role
            FROM account JOIN member ON member.account = account.id
            WHERE account.login = ? AND member.course = ? AND account.disabled_at IS NULL";
        let row = transaction.row(statement, values![login, self.course]).await?;
        let Some(row) = row else { return Err(Problem::not_found("member")) };
        let is_ours = row.maybe_int("managed_by")? == Some(self.course) && row.text("role")? == "student";
        if row.flag("is_admin")? || !(is_ours || self.account.is_admin) {
            let detail = "this account is not only a student of this course: it has other rights, or signs in at a \
                provider";
            return Err(Problem::not_allowed(detail));
        }
        let link = self.create_link(&mut transaction, row.int("id")?, self.sign_in_method()).await?;
        self.log_event(&mut transaction, "link", None, &format!("created a sign-in link for {login}")).await?;
        transaction.commit().await?;
        Ok(Link { link })
    }
}
