//! Sign-ins that another service must confirm: a learning platform, or a provider. The data that the answer needs are
//! signed instead of stored, so any number of sign-ins may begin. Each sign-in can be answered once, in the same
//! browser, within a time limit.
use crate::{
    db::{DbError, Transaction},
    domain::{
        App, NewSecret, Secrets,
        accounts::{identity, throttle},
    },
    problem::{Problem, ensure},
    secret::{random_hex, to_hex},
    values,
};
use base64::{Engine, prelude::BASE64_URL_SAFE_NO_PAD as URL_SAFE_NO_PAD};
use ring::hmac;
use std::time::Instant;

/// The maximum duration of a sign-in, in milliseconds.
const LOGIN_LIFETIME: i64 = 10 * 60 * 1000;

/// The maximum number of sign-ins that one IP address may begin per minute at one service. All people in a lecture hall
/// may share an address.
const MAX_LOGINS: u32 = 3000;

/// The message for a sign-in that began elsewhere, was already answered, or took too long.
pub(in crate::domain) const UNKNOWN_SIGN_IN: &str = "this sign-in is unknown, used or too old";

/// A started sign-in, with the secrets that the answer must contain.
pub(in crate::domain) struct StartedSignIn {
    /// The signed state, which the service returns.
    pub(in crate::domain) state: String,
    /// A secret that the browser keeps, and sends when it returns.
    pub(in crate::domain) browser: String,
}

/// A sign-in whose browser has returned from the other service.
pub(in crate::domain) struct PendingSignIn {
    state: String,
    expires_at: i64,
    /// The service that confirms the sign-in: a platform's ID, or a provider.
    pub(in crate::domain) service: String,
    /// The account that is being connected; 0 if a person signs in instead.
    pub(in crate::domain) account: i64,
    /// The path of the page that opens after the sign-in.
    pub(in crate::domain) path: String,
}

impl App {
    /// Begins a sign-in at a service. The browser may have other pending sign-ins there.
    pub(in crate::domain) async fn begin_sign_in(
        &self,
        service: &str,
        (secrets, known): (&Secrets, Option<&String>),
        (account, to): (i64, &str),
    ) -> Result<StartedSignIn, Problem> {
        ensure(
            self.0.throttle.try_acquire(throttle::bucket_id(secrets.address, service), MAX_LOGINS, Instant::now()),
            Problem::too_many("too many people are signing in from your IP address"),
        )?;
        // All windows of a browser share one secret.
        let is_secret = |value: &&String| value.len() == 64 && value.bytes().all(|c| c.is_ascii_hexdigit());
        let browser = known.filter(is_secret).cloned().unwrap_or_else(|| NewSecret::new("").reveal().to_owned());
        let key = self.find_signing_key().await?;
        let now = self.0.database.read().await?.one("SELECT {now} AS now", values![]).await?.int("now")?;
        let (expires_at, browser_digest, to) =
            (now + LOGIN_LIFETIME, identity::digest(&browser), URL_SAFE_NO_PAD.encode(to));
        let content = format!("{service}.{expires_at}.{browser_digest}.{account}.{to}.{}", random_hex());
        let state = format!("{content}.{}", URL_SAFE_NO_PAD.encode(hmac::sign(&key, content.as_bytes())));
        Ok(StartedSignIn { state, browser })
    }

    /// Returns a secret for a sign-in. Only this service can compute it from the state.
    pub(in crate::domain) async fn compute_secret(&self, kind: &str, state: &str) -> Result<String, Problem> {
        let key = self.find_signing_key().await?;
        Ok(to_hex(hmac::sign(&key, format!("{kind} {state}").as_bytes()).as_ref()))
    }

    /// Returns the sign-in with a state, if this browser began it.
    ///
    /// # Errors
    ///
    /// Fails if the state is unknown, used or too old, or comes from another browser.
    pub(in crate::domain) async fn pending_sign_in(
        &self,
        state: &str,
        browser: Option<&String>,
        reject: fn(&'static str) -> Problem,
    ) -> Result<PendingSignIn, Problem> {
        let key = self.find_signing_key().await?;
        let (pending, browser_digest) = parse_state(&key, state).ok_or_else(|| reject(UNKNOWN_SIGN_IN))?;
        let statement = "SELECT 1 AS n WHERE CAST(? AS {int}) > {now}
            AND NOT EXISTS (SELECT 1 FROM platform_login WHERE state = ?)";
        let values = values![pending.expires_at, identity::digest(state)];
        let fresh = self.0.database.read().await?.row(statement, values).await?;
        ensure(fresh.is_some(), reject(UNKNOWN_SIGN_IN))?;
        let browser = browser.ok_or_else(|| reject("your browser did not send the cookie of this sign-in"))?;
        // If the sign-in began in another browser, the owner of that browser may try to sign this one in as somebody
        // else.
        ensure(browser_digest == identity::digest(browser), reject("this sign-in began in another browser"))?;
        Ok(pending)
    }

    /// Returns the key for the service's signatures, which all servers of a database share.
    async fn find_signing_key(&self) -> Result<hmac::Key, Problem> {
        let found = self.0.signing_key.get_or_try_init(async || {
            let mut transaction = self.0.database.begin().await?;
            let statement =
                "INSERT INTO server_secret (name, value) VALUES ('signing', ?) ON CONFLICT (name) DO NOTHING";
            transaction.execute(statement, values![NewSecret::new("").reveal()]).await?;
            let statement = "SELECT value FROM server_secret WHERE name = 'signing'";
            let value = transaction.one(statement, values![]).await?.text("value")?;
            transaction.commit().await?;
            Ok::<_, DbError>(value)
        });
        Ok(hmac::Key::new(hmac::HMAC_SHA256, found.await?.as_bytes()))
    }
}

impl PendingSignIn {
    /// Marks the sign-in as used; returns whether it was unused.
    pub(in crate::domain) async fn mark_used(&self, transaction: &mut Transaction) -> Result<bool, DbError> {
        let expired = "DELETE FROM platform_login
            WHERE state IN (SELECT state FROM platform_login WHERE expires_at < {now} {skip locked})";
        transaction.execute(expired, values![]).await?;
        let statement = "INSERT INTO platform_login (state, expires_at) VALUES (?, ?) ON CONFLICT (state) DO NOTHING";
        Ok(transaction.execute(statement, values![identity::digest(&self.state), self.expires_at]).await? > 0)
    }
}

/// Reads a signed state. Returns the sign-in, and the digest of the browser's secret; `None` if the signature is wrong.
fn parse_state(key: &hmac::Key, state: &str) -> Option<(PendingSignIn, String)> {
    let (content, tag) = state.rsplit_once('.')?;
    hmac::verify(key, content.as_bytes(), &URL_SAFE_NO_PAD.decode(tag).ok()?).ok()?;
    let mut parts = content.split('.');
    let (at, expires_at) = (parts.next()?.to_owned(), parts.next()?.parse().ok()?);
    let (browser, account) = (parts.next()?.to_owned(), parts.next()?.parse().ok()?);
    let to = String::from_utf8(URL_SAFE_NO_PAD.decode(parts.next()?).ok()?).ok()?;
    Some((PendingSignIn { state: state.to_owned(), expires_at, service: at, account, path: to }, browser))
}
