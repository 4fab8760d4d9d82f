//! Visitors of the service, who may or may not be signed in.
use crate::domain::{
    App, NewSecret,
    accounts::identity::{self, SignInMethod},
    accounts::throttle,
};
use crate::problem::{Problem, ensure};
use std::{net::IpAddr, time::Instant};

/// The secrets that a request contains.
#[derive(Clone, Default)]
pub struct Secrets {
    /// The token from the request's `Authorization` header.
    pub bearer: Option<String>,
    /// The secret of a session, from a cookie.
    pub session: Option<String>,
    /// The secret of a sign-in at a learning platform, which the browser keeps in a cookie.
    pub platform_secret: Option<String>,
    /// The secret of a sign-in at a provider, which the browser keeps in a cookie.
    pub provider_secret: Option<String>,
    /// The address of the client that sent the request; `None` if it is unknown.
    pub address: Option<IpAddr>,
}

/// Someone who may or may not be signed in.
pub struct Visitor {
    pub(crate) app: App,
    pub(in crate::domain) secrets: Secrets,
}

/// The maximum number of sign-ins by link or token from one IP address per minute; a whole lecture hall may share an
/// address.
const MAX_SIGN_INS: u32 = 600;

impl Visitor {
    fn count_sign_in(&self) -> Result<(), Problem> {
        let bucket = throttle::bucket_id(self.secrets.address, "sign-in");
        let passes = self.app.0.throttle.try_acquire(bucket, MAX_SIGN_INS, Instant::now());
        ensure(passes, Problem::too_many("too many people are signing in from your IP address"))
    }

    /// Signs in with a link, which cannot be used again.
    ///
    /// # Errors
    ///
    /// Fails if the link is unknown, used or too old.
    pub async fn sign_in_by_link(&self, link: &str) -> Result<NewSecret, Problem> {
        self.count_sign_in()?;
        let unknown = || Problem::unknown_secret("link", "ask the course's staff for a new one");
        // Only requests with a valid link may take the write lock.
        ensure(self.link_owner(link).await?.is_some(), unknown())?;
        let mut transaction = self.app.0.database.begin().await?;
        let (account, way) = identity::use_link(&mut transaction, link).await?.ok_or_else(unknown)?;
        let session = identity::begin_session(&mut transaction, account, way).await?;
        transaction.commit().await?;
        Ok(session)
    }

    /// Returns the name and the courses of a link's owner, if the link can still be used.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn link_owner(&self, link: &str) -> Result<Option<(String, Option<String>)>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        Ok(identity::link_owner(&mut transaction, link).await?)
    }

    /// Signs in with a person's token. The session ends when the token is revoked.
    ///
    /// # Errors
    ///
    /// Fails if the token is unknown or revoked.
    pub async fn sign_in_by_token(&self, token: &str) -> Result<NewSecret, Problem> {
        self.count_sign_in()?;
        let mut transaction = self.app.0.database.read().await?;
        let (account, token) = identity::find_token_owner(&mut transaction, token).await?;
        drop(transaction);
        let mut transaction = self.app.0.database.begin().await?;
        let session = identity::begin_session(&mut transaction, account.id, SignInMethod::Token(token)).await?;
        transaction.commit().await?;
        Ok(session)
    }

    /// Ends the session of the request.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn sign_out(&self) -> Result<(), Problem> {
        if let Some(session) = &self.secrets.session {
            let mut transaction = self.app.0.database.read().await?;
            if identity::find_session_account(&mut transaction, session).await?.is_none() {
                return Ok(());
            }
            drop(transaction);
            let mut transaction = self.app.0.database.begin().await?;
            identity::end_session(&mut transaction, session).await?;
            transaction.commit().await?;
        }
        Ok(())
    }

    /// Checks that the database and the store can be written, so that requests can be served.
    ///
    /// # Errors
    ///
    /// Fails if one of them cannot be written.
    pub async fn check_ready(&self) -> Result<(), Problem> {
        self.app.0.storage.check_writable().await
    }

    /// Returns the metrics in Prometheus' text format. If the database does not answer, they contain only what the
    /// process itself counts.
    ///
    /// # Errors
    ///
    /// Fails if the metrics can't be written as text.
    pub async fn metrics(&self) -> Result<String, Problem> {
        let parts = &self.app.0;
        let queue = parts.counts.read(&parts.database, &parts.policy).await;
        let queue = queue.inspect_err(|error| tracing::warn!(%error, "the queue can't be counted")).ok();
        parts.instruments.show(&parts.storage, queue.as_ref()).map_err(|error| {
            tracing::error!(%error, "the metrics can't be written");
            Problem::fault()
        })
    }
}
