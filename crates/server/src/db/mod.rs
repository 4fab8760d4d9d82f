//! The database: PostgreSQL or SQLite behind one type, with the same statements. This module only runs statements; its
//! callers write them.
//!
//! Every statement runs inside a transaction, and leaves nothing behind in the session, so that the service works
//! behind a pooler that gives every transaction another connection (PgBouncer). All times are milliseconds since 1970
//! by the database's clock, written as `{now}`; a worker's clock is never used.

mod address;
mod fault;
mod migrate;
mod statement;
mod transaction;
mod value;

pub use address::Address;
pub use fault::DbError;
pub use migrate::{MigrateError, NEWEST, migrate, read_version};
pub use transaction::Transaction;
use transaction::{Inner, LastFailure, Permit};
pub use value::{Column, FromRow, Row, Value};
pub(crate) use value::{from_row, read_row};

use sqlx::{
    ConnectOptions, Connection,
    postgres::{PgConnectOptions, PgPool, PgPoolOptions},
    sqlite::{SqliteConnectOptions, SqliteJournalMode, SqlitePool, SqlitePoolOptions, SqliteSynchronous},
};
use std::{
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    time::{Duration, Instant},
};
use tokio::sync::Semaphore;

/// The maximum time that a statement waits for a connection, or for SQLite's only writer.
const WAIT_LIMIT: Duration = Duration::from_secs(30);

/// The maximum number of connections to PostgreSQL per process.
const MAX_CONNECTIONS: u32 = 10;

/// The number of connections that are reserved for requests with priority.
const PRIORITY_CONNECTIONS: u32 = 3;

/// The statement that begins a transaction in PostgreSQL. A process that hangs in a transaction must not keep its
/// locks, and no statement may wait forever. The settings end with the transaction, as a pooler requires.
const BEGIN: &str = "BEGIN; SET LOCAL idle_in_transaction_session_timeout = '10s'; SET LOCAL lock_timeout = '20s'; \
                     SET LOCAL statement_timeout = '60s'";

/// Returns whether a connection can be used again; otherwise the pool closes it and opens a new one. A connection whose
/// COMMIT and ROLLBACK both failed, for example on a full disk, stays in a transaction forever. A connection that was
/// opened before the database's last failure may lead to a server that is now read-only or stopped.
fn is_reusable(connection: &impl Connection, faults: &LastFailure, age: Duration) -> bool {
    !connection.is_in_transaction() && faults.may_use(age)
}

/// Returns the options for connecting to PostgreSQL. A pooler rejects start-up settings that it does not know.
fn postgres_options(url: &str) -> Result<PgConnectOptions, DbError> {
    let options: PgConnectOptions = url.parse().map_err(DbError::from)?;
    Ok(options
        .extra_float_digits(None)
        .statement_cache_capacity(0)
        .application_name("fosssim-server")
        .disable_statement_logging())
}

/// An open database. Clones are cheap and share the connections.
#[derive(Debug, Clone)]
pub struct Database {
    engine: Engine,
    faults: LastFailure,
    /// Whether a newer program has changed the tables, so that nothing may be written.
    is_outdated: Arc<AtomicBool>,
    /// The permits that requests without priority need. They limit how many such requests use connections or wait for
    /// them.
    permits: Arc<Semaphore>,
    has_priority: bool,
}

#[derive(Debug, Clone)]
enum Engine {
    /// A SQLite database. It has only one writer, so a single connection writes; readers do not wait for it.
    Sqlite {
        writer: SqlitePool,
        readers: SqlitePool,
    },
    Postgres(PgPool),
}

/// The kind of database.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dialect {
    /// The embedded database, in a file next to the artifacts.
    Sqlite,
    /// The database of a separate server.
    Postgres,
}

impl Database {
    /// Opens a database, and creates a SQLite file if it does not exist; [`migrate()`] creates the tables.
    ///
    /// # Errors
    ///
    /// Fails if the database can't be reached within half a minute.
    pub async fn open(address: &Address) -> Result<Self, DbError> {
        let permits = match address {
            // The writer's queue stays short, so that a request with priority waits for at most one other.
            Address::Sqlite(_) => 1,
            Address::Postgres(_) => MAX_CONNECTIONS - PRIORITY_CONNECTIONS,
        };
        let faults = LastFailure::default();
        let good = faults.clone();
        let engine = match address {
            Address::Sqlite(file) => {
                // With `FULL`, a confirmed commit survives a power cut.
                let options = SqliteConnectOptions::new()
                    .filename(file)
                    .create_if_missing(true)
                    .journal_mode(SqliteJournalMode::Wal)
                    .synchronous(SqliteSynchronous::Full)
                    .foreign_keys(true)
                    // Overwrite removed rows, so that their data cannot be recovered.
                    .pragma("secure_delete", "ON")
                    .busy_timeout(WAIT_LIMIT)
                    .disable_statement_logging();
                let pool = |connections| {
                    let faults = good.clone();
                    SqlitePoolOptions::new()
                        .before_acquire(move |connection, about| {
                            Box::pin(std::future::ready(Ok(is_reusable(connection, &faults, about.age))))
                        })
                        .max_connections(connections)
                        .acquire_timeout(WAIT_LIMIT)
                        .idle_timeout(None)
                        .max_lifetime(None)
                };
                let writer = pool(1).connect_with(options.clone()).await?;
                Engine::Sqlite { writer, readers: pool(4).connect_lazy_with(options) }
            }
            Address::Postgres(url) => {
                let pool = PgPoolOptions::new()
                    .before_acquire(move |connection, about| {
                        Box::pin(std::future::ready(Ok(is_reusable(connection, &good, about.age))))
                    })
                    .max_connections(MAX_CONNECTIONS)
                    .acquire_timeout(WAIT_LIMIT)
                    .connect_with(postgres_options(url)?)
                    .await?;
                Engine::Postgres(pool)
            }
        };
        let permits = Arc::new(Semaphore::new(permits as usize));
        Ok(Self { engine, faults, is_outdated: Arc::default(), permits, has_priority: false })
    }

    /// Returns a handle to the same database with priority, for callers that must not wait, such as workers, whose
    /// leases expire. Even during many uploads, grades are stored and waiting jobs are claimed.
    pub fn with_priority(&self) -> Self {
        Self { has_priority: true, ..self.clone() }
    }

    /// Waits for a permit, if one is needed.
    async fn acquire_permit(&self) -> Result<Permit, sqlx::Error> {
        if self.has_priority {
            return Ok(None);
        }
        let permit = tokio::time::timeout(WAIT_LIMIT, self.permits.clone().acquire_owned()).await;
        Ok(permit.map_err(|_| sqlx::Error::PoolTimedOut)?.ok())
    }

    /// Returns the kind of database.
    pub fn dialect(&self) -> Dialect {
        match self.engine {
            Engine::Sqlite { .. } => Dialect::Sqlite,
            Engine::Postgres(_) => Dialect::Postgres,
        }
    }

    /// Begins a transaction that writes. The transaction sees earlier commits, and has no effect unless
    /// [`Transaction::commit`] succeeds.
    ///
    /// # Errors
    ///
    /// Fails if the database can't be reached, or is busy for half a minute.
    pub async fn begin(&self) -> Result<Transaction, DbError> {
        if self.is_outdated.load(Ordering::Relaxed) {
            return Err(DbError::Unavailable("a newer program has changed the database's tables".to_owned()));
        }
        match &self.engine {
            // A transaction that begins by reading cannot write if another transaction has committed in the meantime.
            Engine::Sqlite { writer, .. } => {
                self.limit_wait(Inner::Sqlite, || writer.begin_with("BEGIN IMMEDIATE"), true).await
            }
            Engine::Postgres(pool) => self.limit_wait(Inner::Postgres, || pool.begin_with(BEGIN), true).await,
        }
    }

    /// Begins a transaction that writes, and waits at most `timeout` for earlier ones.
    ///
    /// # Errors
    ///
    /// Fails like [`Database::begin`], after at most `timeout`.
    pub async fn begin_with_timeout(&self, timeout: Duration) -> Result<Transaction, DbError> {
        let begin = Instant::now();
        loop {
            let start = Instant::now();
            match self.begin().await {
                Err(error) if error.is_transient() && start.elapsed() >= WAIT_LIMIT && begin.elapsed() < timeout => {}
                other => return other,
            }
        }
    }

    /// Returns whether the database answers. If its tables are from a newer program, nothing is written from then on.
    pub async fn is_healthy(&self) -> bool {
        let version = read_version(self).await;
        if version.as_ref().is_ok_and(|version| *version > NEWEST) {
            self.is_outdated.store(true, Ordering::Relaxed);
        }
        version.is_ok()
    }

    /// Begins a transaction that only reads, and sees one consistent state.
    ///
    /// # Errors
    ///
    /// Fails if the database can't be reached.
    pub async fn read(&self) -> Result<Transaction, DbError> {
        match &self.engine {
            Engine::Sqlite { readers, .. } => self.limit_wait(Inner::Sqlite, || readers.begin(), false).await,
            Engine::Postgres(pool) => {
                let begin = "BEGIN ISOLATION LEVEL REPEATABLE READ, READ ONLY";
                self.limit_wait(Inner::Postgres, || pool.begin_with(begin), true).await
            }
        }
    }

    /// Begins a transaction, with a limited wait. Waits first for a permit, if permits are counted.
    async fn limit_wait<T, F: Future<Output = Result<T, sqlx::Error>>>(
        &self,
        make: fn(T) -> Inner,
        begin: impl FnOnce() -> F,
        needs_permit: bool,
    ) -> Result<Transaction, DbError> {
        let transaction = async {
            let permit = if needs_permit { self.acquire_permit().await? } else { None };
            Ok::<_, sqlx::Error>(Transaction::new(make(begin().await?), self.faults.clone(), permit))
        }
        .await;
        transaction.map_err(|error| self.faults.record(error))
    }

    /// Copies a SQLite database into a new file. The copy is consistent even while others write. PostgreSQL has its own
    /// tools for this.
    ///
    /// # Errors
    ///
    /// Fails if the file exists or can't be written, or the database is PostgreSQL.
    pub async fn copy_to(&self, file: &std::path::Path) -> Result<(), DbError> {
        match &self.engine {
            Engine::Sqlite { readers, .. } => {
                let text = file.to_str().ok_or_else(|| DbError::Other("the backup's path is not UTF-8".to_owned()))?;
                sqlx::query("VACUUM INTO ?").bind(text).execute(readers).await?;
                Ok(())
            }
            Engine::Postgres(_) => Err(DbError::Other("PostgreSQL is copied by pg_dump".to_owned())),
        }
    }

    /// Closes all connections after their transactions have ended.
    pub async fn close(&self) {
        match &self.engine {
            Engine::Sqlite { writer, readers } => {
                readers.close().await;
                writer.close().await;
            }
            Engine::Postgres(pool) => pool.close().await,
        }
    }
}
