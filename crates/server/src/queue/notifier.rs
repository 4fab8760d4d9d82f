//! A notifier that tells waiting workers to look at once. Only a convenience: nothing is told by it but that something
//! may have changed, and anybody who misses it looks again a little later anyway.
use crate::{
    db::{Address, Database, DbError, Dialect, Transaction, is_pooled, postgres_options},
    values,
};
use sqlx::postgres::{PgConnectOptions, PgListener, PgPoolOptions};
use std::{sync::Arc, time::Duration};
use tokio::sync::watch;

/// The channel of PostgreSQL's LISTEN and NOTIFY.
const CHANNEL: &str = "fosssim_queue";

/// How long a lost listener waits before it connects again.
const RECONNECT: Duration = Duration::from_secs(5);

/// The notifier of one process; on PostgreSQL it is heard by all processes.
#[derive(Debug, Clone, Default)]
pub struct Notifier {
    changes: Arc<watch::Sender<u64>>,
}

/// Somebody who waits for the notifier. Changes between two waits are not missed.
#[derive(Debug, Clone)]
pub struct Subscription(watch::Receiver<u64>);

impl Notifier {
    /// Commits, and wakes subscribers everywhere.
    ///
    /// # Errors
    /// An error of the database.
    pub async fn commit(&self, mut transaction: Transaction) -> Result<(), DbError> {
        Self::notify(&mut transaction).await?;
        transaction.commit().await?;
        self.wake();
        Ok(())
    }

    /// Wakes subscribers everywhere when the transaction is committed. On SQLite nobody is woken by that: call
    /// [`wake`](Self::wake) after the commit.
    ///
    /// # Errors
    /// An error of the database.
    pub async fn notify(transaction: &mut Transaction) -> Result<(), DbError> {
        if transaction.dialect() == Dialect::Postgres {
            transaction.rows("SELECT CAST(pg_notify(?, '') AS TEXT) AS notify", values![CHANNEL]).await?;
        }
        Ok(())
    }

    /// Wakes subscribers in this process.
    pub fn wake(&self) {
        self.changes.send_modify(|changes| *changes += 1);
    }

    /// Somebody who will hear of every change from now on.
    pub fn subscribe(&self) -> Subscription {
        Subscription(self.changes.subscribe())
    }

    /// Passes PostgreSQL's notifier on to this process, for ever; ends at once where there is none. It listens where
    /// `direct` says, or where the database is. Behind a pooler that gives every transaction another connection it
    /// does not: the wish to be told would stay in a connection that others get next. Then polling has to do.
    pub async fn listen(self, database: Database, direct: Option<Address>) {
        let options = match direct {
            Some(Address::Postgres(url)) => postgres_options(&url).ok(),
            _ => database.postgres_options().cloned(),
        };
        let Some(options) = options else { return };
        loop {
            match self.listen_once(&options).await {
                Ok(()) => return tracing::info!("behind a pooler workers look by the clock: --database-direct"),
                Err(error) => {
                    tracing::warn!(%error, "the database's notifier is not heard, so workers look by the clock")
                }
            }
            tokio::time::sleep(RECONNECT).await;
        }
    }

    /// Ends well behind a pooler only.
    async fn listen_once(&self, options: &PgConnectOptions) -> Result<(), sqlx::Error> {
        if is_pooled(options).await? {
            return Ok(());
        }
        let pool = PgPoolOptions::new().max_connections(1).connect_with(options.clone()).await?;
        let mut listener = PgListener::connect_with(&pool).await?;
        listener.listen(CHANNEL).await?;
        // An event whose message was lost is found by looking.
        self.wake();
        loop {
            listener.try_recv().await?;
            self.wake();
        }
    }
}

impl Subscription {
    /// Waits for a change, or until `patience` is over; whether there was one.
    pub async fn wait(&mut self, patience: Duration) -> bool {
        match tokio::time::timeout(patience, self.0.changed()).await {
            Ok(Ok(())) => true,
            Err(_) => false,
            // The notifier is gone, with everybody who could strike it: wait all the same, so that no caller spins.
            Ok(Err(_)) => {
                tokio::time::sleep(patience).await;
                false
            }
        }
    }
}
