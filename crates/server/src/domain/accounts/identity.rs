//! Tokens, sessions and sign-in links. Each is a secret of 256 random bits; the database stores only its digest.
use crate::domain::view::Account;
use crate::{
    db::{DbError, FromRow, Transaction, from_row},
    problem::{Problem, ensure},
    secret::{random_hex, to_hex},
    values,
};
use serde::Serialize;
use sha2::{Digest as _, Sha256};
use std::fmt;
use utoipa::ToSchema;

/// The lifetime of a session after its last use, in milliseconds.
const SESSION_LIFETIME: i64 = 14 * 24 * 3600 * 1000;

/// The maximum number of sessions of an account. A further session ends the oldest one.
const MAX_SESSIONS: i64 = 50;

/// The lifetime of a sign-in link, in milliseconds.
const LINK_LIFETIME: i64 = 7 * 24 * 3600 * 1000;

/// The age in milliseconds up to which a session may create further ways to sign in, such as tokens.
const RECENT_AGE: i64 = 12 * 3600 * 1000;

/// The time between two updates of a session's last use, in milliseconds.
const SEEN_INTERVAL: i64 = 300 * 1000;

/// The prefix of people's tokens, by which people and secret scanners recognize such a token.
pub(in crate::domain) const PERSON_PREFIX: &str = "fso_";
pub(in crate::domain) const WORKER_PREFIX: &str = "fsw_";

/// A new secret, which is shown to its owner once.
#[derive(Clone, PartialEq, Eq)]
pub struct NewSecret(String);

impl NewSecret {
    pub(in crate::domain) fn new(prefix: &str) -> Self {
        Self(format!("{prefix}{}{}", random_hex(), random_hex()))
    }

    /// Returns the secret, for its owner.
    pub fn reveal(&self) -> &str {
        &self.0
    }

    pub(in crate::domain) fn digest(&self) -> String {
        digest(&self.0)
    }
}

impl fmt::Debug for NewSecret {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("NewSecret(...)")
    }
}

/// A token, without its secret.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct TokenInfo {
    /// The token's ID, with which it is revoked.
    pub id: i64,
    /// The token's name, given by its owner.
    pub name: String,
    /// The time of creation, in milliseconds since 1970.
    pub created_at: i64,
}

from_row! { TokenInfo { id, name, created_at } }

/// A new token with its secret, which is shown once.
#[derive(Serialize, ToSchema)]
pub struct NewToken {
    #[serde(flatten)]
    pub(in crate::domain) info: TokenInfo,
    /// The token's secret, which the owner sends with requests.
    pub token: String,
}

/// A sign-in link of an account. It works once, within a week.
#[derive(Serialize, ToSchema)]
pub struct Link {
    /// The link's URL; `None` if the account existed already.
    pub link: Option<String>,
}

/// The method with which a person signed in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::domain) enum SignInMethod {
    /// The person signed in through a provider or a learning platform, or with a link from the server or an
    /// administrator.
    Own,
    /// The person signed in with a link from a course's staff, who may have used it themselves.
    ByStaff,
    /// The person signed in with a token; the value is its ID. The session ends with the token.
    Token(i64),
}

/// The state of a session, for a request.
#[derive(Debug, Clone)]
pub(in crate::domain) struct SessionState {
    /// Whether the session was started with a link from a course's staff.
    pub(in crate::domain) from_staff_link: bool,
    /// Whether the session was started with a token.
    pub(in crate::domain) started_by_token: bool,
    /// Whether the session is young enough to create further ways to sign in.
    pub(in crate::domain) is_recent: bool,
    /// Whether the stored time of the session's last use must be updated.
    pub(in crate::domain) is_stale: bool,
}

/// Returns the digest of a secret, as the database stores it. The secret is random, so it can't be guessed from the
/// digest.
pub(in crate::domain) fn digest(secret: &str) -> String {
    to_hex(&Sha256::digest(secret))
}

/// Returns the owner of a token, and the token's ID.
pub(in crate::domain) async fn find_token_owner(
    transaction: &mut Transaction,
    token: &str,
) -> Result<(Account, i64), Problem> {
    let statement = "SELECT account.id, account.login, account.name, account.is_admin, token.id AS token FROM token
        JOIN account ON account.id = token.account
        WHERE token.digest = ? AND token.revoked_at IS NULL AND account.disabled_at IS NULL";
    let row = transaction.row(statement, values![digest(token)]).await?;
    match row {
        Some(row) => Ok((Account::from_row(&row)?, row.int("token")?)),
        None => {
            Err(Problem::unknown_secret("token", "sign in with a link from the course's staff, and create a new one"))
        }
    }
}

/// Returns the account of a session and the session's state; `None` if the session is unknown or has ended. A session
/// that was started with a token ends with the token.
pub(in crate::domain) async fn find_session_account(
    transaction: &mut Transaction,
    session: &str,
) -> Result<Option<(Account, SessionState)>, Problem> {
    let statement = "SELECT account.id, account.login, account.name, account.is_admin, session.vouched,
           session.token, session.created_at, session.seen_at, {now} AS now
        FROM session JOIN account ON account.id = session.account
        LEFT JOIN token ON token.id = session.token
        WHERE session.digest = ? AND session.expires_at > {now} AND account.disabled_at IS NULL
           AND token.revoked_at IS NULL";
    let row = transaction.row(statement, values![digest(session)]).await?;
    let Some(row) = row else { return Ok(None) };
    let now = row.int("now")?;
    let state = SessionState {
        from_staff_link: row.flag("vouched")?,
        started_by_token: row.maybe_int("token")?.is_some(),
        is_recent: now - row.int("created_at")? < RECENT_AGE,
        is_stale: now - row.int("seen_at")? > SEEN_INTERVAL,
    };
    Ok(Some((Account::from_row(&row)?, state)))
}

/// Extends a session, so that its lifetime begins again now.
pub(in crate::domain) async fn extend_session(transaction: &mut Transaction, session: &str) -> Result<(), DbError> {
    let statement = "UPDATE session SET seen_at = {now}, expires_at = {now} + ? WHERE digest = ?";
    transaction.execute(statement, values![SESSION_LIFETIME, digest(session)]).await.map(drop)
}

/// Begins a session, and returns its secret for a cookie.
pub(in crate::domain) async fn begin_session(
    transaction: &mut Transaction,
    account: i64,
    method: SignInMethod,
) -> Result<NewSecret, DbError> {
    let secret = NewSecret::new("");
    let token = if let SignInMethod::Token(token) = method { Some(token) } else { None };
    let expired =
        "DELETE FROM session WHERE digest IN (SELECT digest FROM session WHERE expires_at < {now} {skip locked})";
    transaction.execute(expired, values![]).await?;
    let statement = "INSERT INTO session (digest, account, created_at, seen_at, expires_at, vouched, token)
        VALUES (?, ?, {now}, {now}, {now} + ?, ?, ?)";
    transaction
        .execute(statement, values![secret.digest(), account, SESSION_LIFETIME, method == SignInMethod::ByStaff, token])
        .await?;
    let statement = "DELETE FROM session WHERE account = ? AND digest NOT IN
        (SELECT digest FROM session WHERE account = ? ORDER BY created_at DESC, seen_at DESC LIMIT ?)";
    transaction.execute(statement, values![account, account, MAX_SESSIONS]).await?;
    Ok(secret)
}

/// Ends the session with this secret.
pub(in crate::domain) async fn end_session(transaction: &mut Transaction, session: &str) -> Result<(), DbError> {
    transaction.execute("DELETE FROM session WHERE digest = ?", values![digest(session)]).await.map(drop)
}

/// Creates a sign-in link that works once, and invalidates the account's unused links. `method` is the sign-in method
/// of the person who requests the link.
pub(in crate::domain) async fn new_link(
    transaction: &mut Transaction,
    account: i64,
    by: Option<i64>,
    method: SignInMethod,
) -> Result<NewSecret, DbError> {
    transaction.execute("DELETE FROM sign_in_link WHERE account = ? AND used_at IS NULL", values![account]).await?;
    create_link(transaction, account, by, method).await
}

/// Creates another sign-in link. Earlier links stay valid.
pub(in crate::domain) async fn create_link(
    transaction: &mut Transaction,
    account: i64,
    by: Option<i64>,
    method: SignInMethod,
) -> Result<NewSecret, DbError> {
    let secret = NewSecret::new("");
    let statement = "INSERT INTO sign_in_link (digest, account, created_by, created_at, expires_at, vouched)
        VALUES (?, ?, ?, {now}, {now} + ?, ?)";
    transaction
        .execute(statement, values![secret.digest(), account, by, LINK_LIFETIME, method == SignInMethod::ByStaff])
        .await?;
    Ok(secret)
}

/// Returns the name and the courses of a link's owner, if the link can still be used.
pub(in crate::domain) async fn link_owner(
    transaction: &mut Transaction,
    link: &str,
) -> Result<Option<(String, Option<String>)>, DbError> {
    let statement = "SELECT account.name,
           (SELECT string_agg(course.title, ', ') FROM course JOIN member ON member.course = course.id
               WHERE member.account = account.id) AS courses
        FROM sign_in_link JOIN account ON account.id = sign_in_link.account
        WHERE sign_in_link.digest = ? AND used_at IS NULL AND expires_at > {now}";
    let row = transaction.row(statement, values![digest(link)]).await?;
    row.map(|row| Ok((row.text("name")?, row.maybe_text("courses")?))).transpose()
}

/// Marks a link as used. Returns the link's owner, and the method by which the owner now signs in; `None` if the link
/// can't be used.
pub(in crate::domain) async fn use_link(
    transaction: &mut Transaction,
    link: &str,
) -> Result<Option<(i64, SignInMethod)>, DbError> {
    let statement =
        "UPDATE sign_in_link SET used_at = {now} WHERE digest = ? AND used_at IS NULL AND expires_at > {now}
        RETURNING account, vouched";
    let row = transaction.row(statement, values![digest(link)]).await?;
    let Some(row) = row else { return Ok(None) };
    let (account, way) =
        (row.int("account")?, if row.flag("vouched")? { SignInMethod::ByStaff } else { SignInMethod::Own });
    // Staff may have connected the account with another person at the provider, in a session from a staff link.
    if way == SignInMethod::Own {
        end_staff_connections(transaction, account).await?;
    }
    let row = transaction.row("SELECT id FROM account WHERE id = ? AND disabled_at IS NULL", values![account]).await?;
    Ok(row.map(|_| (account, way)))
}

/// Ends all sessions of an account.
pub(in crate::domain) async fn end_sessions(transaction: &mut Transaction, account: i64) -> Result<(), DbError> {
    transaction.execute("DELETE FROM session WHERE account = ?", values![account]).await.map(drop)
}

/// Disconnects the account from providers to which it was connected in a session from a staff link.
async fn end_staff_connections(transaction: &mut Transaction, account: i64) -> Result<(), DbError> {
    let statement = "DELETE FROM platform_account WHERE account = ? AND vouched = 1";
    transaction.execute(statement, values![account]).await.map(drop)
}

/// Ends all sessions, links and tokens of an account. This is called when the account gets more rights or is closed.
pub(in crate::domain) async fn end_all_access(transaction: &mut Transaction, account: i64) -> Result<(), DbError> {
    end_sessions(transaction, account).await?;
    transaction.execute("UPDATE account SET managed_by = NULL WHERE id = ?", values![account]).await?;
    transaction.execute("DELETE FROM sign_in_link WHERE account = ? AND used_at IS NULL", values![account]).await?;
    end_staff_connections(transaction, account).await?;
    let statement = "UPDATE token SET revoked_at = {now} WHERE account = ? AND revoked_at IS NULL";
    transaction.execute(statement, values![account]).await.map(drop)
}

/// Makes sure that only the person can use the account. Sessions and tokens from staff links end, because staff may
/// have used these links.
pub(in crate::domain) async fn end_staff_access(transaction: &mut Transaction, account: i64) -> Result<(), DbError> {
    transaction.execute("UPDATE account SET managed_by = NULL WHERE id = ?", values![account]).await?;
    end_staff_connections(transaction, account).await?;
    transaction.execute("DELETE FROM session WHERE account = ? AND vouched = 1", values![account]).await?;
    let statement = "DELETE FROM sign_in_link WHERE account = ? AND vouched = 1 AND used_at IS NULL";
    transaction.execute(statement, values![account]).await?;
    let statement = "UPDATE token SET revoked_at = {now} WHERE account = ? AND vouched = 1 AND revoked_at IS NULL";
    transaction.execute(statement, values![account]).await.map(drop)
}

/// Returns whether an account has more rights than a student's in some course. Staff can't sign in as such an account.
pub(in crate::domain) async fn is_trusted(transaction: &mut Transaction, account: i64) -> Result<bool, DbError> {
    let statement = "SELECT is_admin, (SELECT count(*) FROM member
           WHERE member.account = account.id AND member.role = 'staff') AS staff
        FROM account WHERE id = ?";
    let row = transaction.one(statement, values![account]).await?;
    Ok(row.flag("is_admin")? || row.int("staff")? > 0)
}

/// Creates a token for an account or a worker.
pub(in crate::domain) async fn new_token(
    transaction: &mut Transaction,
    account: Option<i64>,
    name: &str,
    by: i64,
    method: SignInMethod,
) -> Result<NewToken, DbError> {
    let secret = NewSecret::new(if account.is_some() { PERSON_PREFIX } else { WORKER_PREFIX });
    let statement = "INSERT INTO token (account, name, digest, created_by, created_at, vouched)
        VALUES (?, ?, ?, ?, {now}, ?) RETURNING id, name, created_at";
    let row = transaction
        .one(statement, values![account, name, secret.digest(), by, method == SignInMethod::ByStaff])
        .await?;
    Ok(NewToken { info: TokenInfo::from_row(&row)?, token: secret.reveal().to_owned() })
}

/// Returns whether a character is invisible, or changes the direction of the text around it.
pub(in crate::domain) fn is_control(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{ad}' | '\u{115f}' | '\u{1160}' | '\u{180e}' | '\u{200b}'..='\u{200f}'
            | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{3164}' | '\u{feff}' | '\u{ffa0}'
            | '\u{e0000}'..='\u{e0fff}')
}

/// Checks a name that a person chose, because pages, logs and tables show it.
pub(in crate::domain) fn check_title(what: &str, text: &str) -> Result<(), Problem> {
    let length = text.chars().count();
    let is_fit = (1..=200).contains(&length) && !text.chars().any(is_control) && text.trim() == text;
    let rule = "must have 1 to 200 characters, without invisible characters and spaces at its ends";
    ensure(is_fit, Problem::invalid(format!("{what} {rule}")))
}

/// Checks a name that becomes a part of URLs.
pub(in crate::domain) fn check_slug(what: &str, text: &str) -> Result<(), Problem> {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || matches!(c, '-' | '_' | '.');
    let is_fit = (1..=60).contains(&text.len()) && text.chars().all(plain) && !text.starts_with(['-', '.', '_']);
    let rule = "must have 1 to 60 small letters, digits, dots, dashes or underscores, and begin with a letter or digit";
    ensure(is_fit, Problem::invalid(format!("{what} {rule}")))
}
