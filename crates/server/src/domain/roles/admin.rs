//! Administrators, and the actions that only they can perform.
use crate::domain::{
    App, NewSecret,
    accounts::identity::{self, Link, NewToken, SignInMethod, TokenInfo},
    courses::members::PEOPLE_PER_PAGE,
    view::{self, Account, Course, Event, EventQuery, LogEntry, Queue},
};
use crate::{
    db::{DbError, Transaction, from_row},
    problem::{Problem, ensure},
    values,
};

/// An administrator, who has all rights on the server.
pub struct Admin {
    pub(crate) account: Account,
    pub(crate) app: App,
}

/// A course, its size, and the logins of its staff.
pub struct CourseSize {
    pub(crate) slug: String,
    pub(crate) title: String,
    pub(crate) staff: Option<String>,
    pub(crate) students: i64,
    pub(crate) assignments: i64,
    pub(crate) submissions: i64,
}

/// An account in the list of all people.
pub struct ListedAccount {
    pub(crate) login: String,
    pub(crate) name: String,
    pub(crate) is_admin: bool,
    /// The courses of the person, with the role if it is staff; `None` if there are none.
    pub(crate) courses: Option<String>,
    /// The last visit in milliseconds since 1970; `None` without a session, because old sessions are removed.
    pub(crate) seen_at: Option<i64>,
}

from_row! { ListedAccount { login, name, is_admin, courses, seen_at } }
from_row! { CourseSize { slug, title, staff, students, assignments, submissions } }

/// Creates a course with a name and a title, and returns its ID.
pub(in crate::domain) async fn make_course(
    transaction: &mut Transaction,
    (slug, title): (&str, &str),
) -> Result<i64, Problem> {
    identity::check_slug("a course's name", slug)?;
    identity::check_title("a title", title)?;
    let statement = "INSERT INTO course (slug, title, created_at) VALUES (?, ?, {now})
        ON CONFLICT (slug) DO NOTHING RETURNING id";
    let created = transaction.row(statement, values![slug, title]).await?;
    let created = created.ok_or_else(|| Problem::conflict("a course with this name exists", "give it another name"))?;
    Ok(created.int("id")?)
}

impl Admin {
    /// Writes an entry into the audit log.
    pub(in crate::domain) async fn log_event(
        &self,
        transaction: &mut Transaction,
        kind: &'static str,
        text: &str,
    ) -> Result<(), DbError> {
        view::log_event(transaction, &LogEntry::new(kind, self.account.id, text)).await
    }

    /// Creates a course.
    ///
    /// # Errors
    ///
    /// Fails if its name is taken.
    pub async fn new_course(&self, slug: &str, title: &str) -> Result<Course, Problem> {
        let mut transaction = self.app.0.database.begin().await?;
        make_course(&mut transaction, (slug, title)).await?;
        self.log_event(&mut transaction, "course", &format!("{slug} ({title})")).await?;
        transaction.commit().await?;
        Ok(Course { slug: slug.to_owned(), title: title.to_owned() })
    }

    /// Returns all courses with their sizes.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn course_sizes(&self) -> Result<Vec<CourseSize>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT slug, title,
               (SELECT string_agg(login, ', ') FROM account JOIN member ON member.account = account.id
                   WHERE member.course = course.id AND role = 'staff') AS staff,
               (SELECT count(*) FROM member WHERE member.course = course.id AND role = 'student') AS students,
               (SELECT count(*) FROM assignment WHERE assignment.course = course.id) AS assignments,
               (SELECT count(*) FROM submission JOIN assignment ON assignment.id = submission.assignment
                   WHERE assignment.course = course.id) AS submissions
            FROM course ORDER BY slug";
        Ok(transaction.all(statement, values![]).await?)
    }

    /// Returns a page of the accounts whose login or name contains `search`, in the order of logins, from the first one
    /// after `after`. The flag is true if there are more.
    pub async fn accounts_page(&self, search: &str, after: &str) -> Result<(Vec<ListedAccount>, bool), Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT login, name, is_admin,
               (SELECT string_agg(slug || CASE role WHEN 'staff' THEN ' (staff)' ELSE '' END, ', ')
                   FROM (SELECT slug, role FROM course JOIN member ON member.course = course.id
                       WHERE member.account = account.id ORDER BY slug) AS own) AS courses,
               (SELECT max(seen_at) FROM session WHERE session.account = account.id) AS seen_at
            FROM account WHERE disabled_at IS NULL AND login > ?
               AND ({strpos}(lower(login || ' ' || name), ?) > 0 OR {strpos}(name, ?) > 0)
            ORDER BY login LIMIT ?";
        let (query, limit) = (search.trim(), PEOPLE_PER_PAGE + 1);
        let values = values![after, query.to_lowercase(), query, limit];
        let mut accounts: Vec<ListedAccount> = transaction.all(statement, values).await?;
        let has_more = accounts.len() as i64 == limit;
        accounts.truncate(PEOPLE_PER_PAGE as usize);
        Ok((accounts, has_more))
    }

    /// Returns all accounts.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn accounts(&self) -> Result<Vec<Account>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT id, login, name, is_admin FROM account WHERE disabled_at IS NULL ORDER BY login";
        Ok(transaction.all(statement, values![]).await?)
    }

    /// Creates an account, or gives or takes an administrator's rights. Returns a sign-in link. If the account was
    /// closed, it is opened again.
    ///
    /// # Errors
    ///
    /// Fails if a name is invalid.
    pub async fn set_account(&self, login: &str, name: &str, is_admin: bool) -> Result<Link, Problem> {
        identity::check_slug("a login", login)?;
        identity::check_title("a name", name)?;
        ensure(is_admin || login != self.account.login, Problem::own_account())?;
        let mut transaction = self.app.0.database.begin().await?;
        let statement = "SELECT id, login, name, is_admin FROM account WHERE login = ? {for update}";
        let before: Option<Account> = transaction.find(statement, values![login]).await?;
        let statement = "INSERT INTO account (login, name, is_admin, created_at) VALUES (?, ?, ?, {now})
            ON CONFLICT (login) DO UPDATE SET name = excluded.name, is_admin = excluded.is_admin,
               disabled_at = NULL
            RETURNING id";
        let account = transaction.one(statement, values![login, name, is_admin]).await?.int("id")?;
        if before.is_some_and(|account_before| account_before.is_admin != is_admin) {
            identity::end_all_access(&mut transaction, account).await?;
        }
        let link = identity::new_link(&mut transaction, account, Some(self.account.id), SignInMethod::Own).await?;
        let text = format!("saved {login}{}; created a sign-in link", if is_admin { " as administrator" } else { "" });
        self.log_event(&mut transaction, "account", &text).await?;
        transaction.commit().await?;
        Ok(Link { link: Some(self.app.welcome_address(&link)) })
    }

    /// Closes an account, so that nobody can sign in with it. Its submissions stay.
    ///
    /// # Errors
    ///
    /// Fails if the account does not exist, or is the administrator's own.
    pub async fn disable_account(&self, login: &str) -> Result<(), Problem> {
        ensure(login != self.account.login, Problem::own_account())?;
        let mut transaction = self.app.0.database.begin().await?;
        let statement = "UPDATE account SET disabled_at = {now} WHERE login = ? AND disabled_at IS NULL RETURNING id";
        let row = transaction.row(statement, values![login]).await?.ok_or_else(|| Problem::not_found("account"))?;
        identity::end_all_access(&mut transaction, row.int("id")?).await?;
        self.log_event(&mut transaction, "account", &format!("closed {login}")).await?;
        Ok(transaction.commit().await?)
    }

    /// Returns the tokens of workers.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn worker_tokens(&self) -> Result<Vec<TokenInfo>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement =
            "SELECT id, name, created_at FROM token WHERE account IS NULL AND revoked_at IS NULL ORDER BY id";
        Ok(transaction.all(statement, values![]).await?)
    }

    /// Creates a token for workers.
    ///
    /// # Errors
    ///
    /// Fails if its name is invalid, or a worker has it already.
    pub async fn new_worker_token(&self, name: &str) -> Result<NewToken, Problem> {
        let has_token = self.worker_tokens().await?.iter().any(|token| token.name == name);
        let conflict = Problem::conflict("this worker already has a token", "revoke it, or choose another name");
        ensure(!has_token, conflict)?;
        self.app.new_worker_token(name, self.account.id).await
    }

    /// Revokes a token of workers.
    ///
    /// # Errors
    ///
    /// Fails if there is no token with this ID.
    pub async fn revoke_worker_token(&self, id: i64) -> Result<(), Problem> {
        let mut transaction = self.app.0.database.begin().await?;
        let statement = "UPDATE token SET revoked_at = {now} WHERE id = ? AND account IS NULL AND revoked_at IS NULL
            RETURNING name";
        let row = transaction.row(statement, values![id]).await?.ok_or_else(|| Problem::not_found("token"))?;
        self.log_event(&mut transaction, "worker token", &format!("revoked {}", row.text("name")?)).await?;
        Ok(transaction.commit().await?)
    }

    /// Returns the state of the queue and of the workers.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn queue(&self) -> Result<Queue, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        Ok(view::queue(&mut transaction, &self.app).await?)
    }

    /// Returns the newest events that match the query, newest first.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn audit(&self, query: &EventQuery) -> Result<Vec<Event>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        Ok(view::events!(transaction, query, ""))
    }
}

impl App {
    async fn new_worker_token(&self, name: &str, creator: i64) -> Result<NewToken, Problem> {
        identity::check_slug("a worker's name", name)?;
        let mut transaction = self.0.database.begin().await?;
        let token = identity::new_token(&mut transaction, None, name, creator, SignInMethod::Own).await?;
        view::log_event(&mut transaction, &LogEntry::new("worker token", creator, &format!("created {name}"))).await?;
        transaction.commit().await?;
        Ok(token)
    }

    /// Creates a token for workers, in the name of the first administrator.
    ///
    /// # Errors
    /// Fails if the name is invalid, or the server was never started.
    pub async fn worker_token(&self, name: &str) -> Result<NewToken, Problem> {
        let statement = "SELECT id FROM account WHERE is_admin = 1 ORDER BY id LIMIT 1";
        let first = self.0.database.read().await?.row(statement, values![]).await?;
        self.new_worker_token(name, first.ok_or_else(|| Problem::not_found("administrator"))?.int("id")?).await
    }

    /// Returns the sign-in link for the first administrator of a new server; `None` after an administrator has signed
    /// in.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn first_link(&self) -> Result<Option<NewSecret>, Problem> {
        let mut transaction = self.0.database.begin().await?;
        let statement =
            "INSERT INTO account (login, name, is_admin, created_at) VALUES ('admin', 'Administrator', 1, {now})
            ON CONFLICT (login) DO NOTHING";
        if transaction.execute(statement, values![]).await? > 0 {
            let text = "created the first administrator, admin; printed a sign-in link";
            view::log_event(&mut transaction, &LogEntry::new("account", None, text)).await?;
        }
        let statement = "SELECT account.id FROM account JOIN sign_in_link ON sign_in_link.account = account.id
            WHERE account.is_admin = 1 AND sign_in_link.used_at IS NOT NULL";
        if transaction.row(statement, values![]).await?.is_some() {
            return Ok(None);
        }
        let statement = "SELECT id FROM account WHERE login = 'admin' AND is_admin = 1";
        let account = transaction.one(statement, values![]).await?.int("id")?;
        // Another server that started at the same time has also printed a link, so both must stay valid.
        let link = identity::create_link(&mut transaction, account, None, SignInMethod::Own).await?;
        transaction.commit().await?;
        Ok(Some(link))
    }

    /// Returns a new link for an administrator who can run programs on the server and has lost the link.
    ///
    /// # Errors
    ///
    /// Fails if there is no such administrator.
    pub async fn admin_link(&self, login: &str) -> Result<NewSecret, Problem> {
        let mut transaction = self.0.database.begin().await?;
        let statement = "SELECT id FROM account WHERE login = ? AND is_admin = 1 AND disabled_at IS NULL";
        let row =
            transaction.row(statement, values![login]).await?.ok_or_else(|| Problem::not_found("administrator"))?;
        let link = identity::new_link(&mut transaction, row.int("id")?, None, SignInMethod::Own).await?;
        transaction.commit().await?;
        Ok(link)
    }
}
