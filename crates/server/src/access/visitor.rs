//! Anybody.
use super::{
    House, Session,
    identity::{self, Way},
};
use crate::{db, problem::Problem};
use std::net::IpAddr;

/// Somebody who need not be signed in.
pub struct Visitor {
    pub(super) house: House,
    pub(super) session: Option<String>,
    pub(super) browser: Option<String>,
    pub(super) address: Option<IpAddr>,
}

/// What may be counted without knowing anybody.
#[derive(Debug, Clone, Default)]
pub struct Metrics {
    /// Jobs by state.
    pub jobs: Vec<(String, i64)>,
    /// Scores for learning platforms by state.
    pub scores: Vec<(String, i64)>,
    /// How long the oldest waiting job has waited, in milliseconds.
    pub oldest: i64,
    /// Workers that were seen lately.
    pub workers: i64,
    /// Their slots.
    pub slots: i64,
    /// Workers that take no jobs, because they can't grade.
    pub aside: i64,
    /// Workers that grade something.
    pub working: i64,
    /// Jobs of assignments by whose suite nothing can be graded; they wait for staff.
    pub paused: i64,
    /// Events by kind, of those kinds that somebody should look at.
    pub events: Vec<(String, i64)>,
    /// Submissions in all.
    pub submissions: i64,
    /// Scenes in which the reference is suspected and nobody has decided.
    pub suspicions: i64,
}

impl Visitor {
    /// The house.
    pub fn house(&self) -> &House {
        &self.house
    }

    /// What this browser showed of itself when it came from a learning platform.
    pub fn browser(&self) -> Option<&str> {
        self.browser.as_deref()
    }

    /// Signs in by a link, which is used up.
    ///
    /// # Errors
    /// When it is unknown, used or too old.
    pub async fn sign_in_by_link(&self, link: &str) -> Result<Session, Problem> {
        // Only who has a link keeps others from writing.
        let mut transaction = self.house.0.database.read().await?;
        if !identity::is_link(&mut transaction, link).await? {
            return Err(Problem::unknown_secret("link"));
        }
        drop(transaction);
        let mut transaction = self.house.0.database.begin().await?;
        let Some((account, way)) = identity::use_link(&mut transaction, link).await? else {
            return Err(Problem::unknown_secret("link"));
        };
        let session = identity::begin_session(&mut transaction, account, way).await?;
        transaction.commit().await?;
        Ok(session)
    }

    /// Signs in by a token of a person, until it is revoked.
    ///
    /// # Errors
    /// When it is unknown or revoked.
    pub async fn sign_in_by_token(&self, token: &str) -> Result<Session, Problem> {
        let mut transaction = self.house.0.database.read().await?;
        let (account, token) = identity::account_of_token(&mut transaction, token).await?;
        drop(transaction);
        let mut transaction = self.house.0.database.begin().await?;
        let session = identity::begin_session(&mut transaction, account.id, Way::Token(token)).await?;
        transaction.commit().await?;
        Ok(session)
    }

    /// Ends the session that the request shows.
    ///
    /// # Errors
    /// When the database does not answer.
    pub async fn sign_out(&self) -> Result<(), Problem> {
        if let Some(session) = &self.session {
            let mut transaction = self.house.0.database.read().await?;
            if identity::account_of_session(&mut transaction, session).await?.is_none() {
                return Ok(());
            }
            drop(transaction);
            let mut transaction = self.house.0.database.begin().await?;
            identity::end_session(&mut transaction, session).await?;
            transaction.commit().await?;
        }
        Ok(())
    }

    /// Whether requests can be served.
    ///
    /// # Errors
    /// When they can't.
    pub async fn ready(&self) -> Result<(), Problem> {
        if db::version(&self.house.0.database).await? != db::LATEST {
            return Err(Problem::unavailable("the tables are not those of this version"));
        }
        self.house.0.storage.prove().await
    }

    /// What the server counts about itself, in Prometheus' text format.
    ///
    /// # Errors
    /// When it can't be written as text.
    pub fn instruments(&self) -> Result<String, Problem> {
        let parts = &self.house.0;
        parts.instruments.show(&parts.database, &parts.storage).map_err(|error| {
            tracing::error!(%error, "the metrics can't be written");
            Problem::fault()
        })
    }

    /// Numbers for a monitor.
    ///
    /// # Errors
    /// When the database does not answer.
    pub async fn metrics(&self) -> Result<Metrics, Problem> {
        Ok(self.house.0.counts.of(&self.house.0.database, &self.house.0.policy).await?)
    }
}
