//! A transaction, the only way to run statements.
use super::{DbError, Dialect, FromRow, Row, Value, statement, value};
use sqlx::{AssertSqlSafe, Postgres, Sqlite};
use std::{
    sync::{Arc, Mutex, PoisonError},
    time::{Duration, Instant},
};
use tokio::sync::OwnedSemaphorePermit;

/// A transaction. Dropping it without [`commit`](Self::commit) rolls it back. Without priority it holds a permit until
/// it ends ([`Database::with_priority`](super::Database::with_priority)).
#[derive(Debug)]
pub struct Transaction {
    inner: Inner,
    faults: LastFailure,
    #[expect(dead_code, reason = "held until the transaction ends")]
    permit: Permit,
}

/// The time of the last failure that a broken connection may have caused. Connections from before that time are closed.
#[derive(Debug, Clone, Default)]
pub(super) struct LastFailure(Arc<Mutex<Option<Instant>>>);

impl LastFailure {
    /// Returns whether a connection of this age was opened after the last failure.
    pub(super) fn may_use(&self, age: Duration) -> bool {
        let last = *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        last.is_none_or(|last| last.elapsed() > age)
    }

    /// Records the time of a failure, and returns the error that callers see. The failure is ignored if it only means
    /// that all connections are in use.
    pub(super) fn record(&self, error: sqlx::Error) -> DbError {
        let is_pool_error = matches!(error, sqlx::Error::PoolTimedOut | sqlx::Error::PoolClosed);
        let error = DbError::from(error);
        if matches!(error, DbError::Unavailable(_)) && !is_pool_error {
            *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
        }
        error
    }
}

/// A request's permit; `None` if the request has priority and needs no permit.
pub(super) type Permit = Option<OwnedSemaphorePermit>;

#[derive(Debug)]
pub(super) enum Inner {
    Sqlite(sqlx::Transaction<'static, Sqlite>),
    Postgres(sqlx::Transaction<'static, Postgres>),
}

/// Creates a query with its values, in the engine's own type. The query is not prepared, because a prepared statement
/// would remain in the session.
macro_rules! query {
    ($database:ty, $text:expr, $values:expr) => {{
        let mut query = sqlx::query::<$database>(AssertSqlSafe($text)).persistent(false);
        for value in $values {
            query = match value {
                Value::Int(value) => query.bind(*value),
                Value::Text(value) => query.bind(value.clone()),
            };
        }
        query
    }};
}

impl Transaction {
    pub(super) fn new(inner: Inner, faults: LastFailure, permit: Permit) -> Self {
        Self { inner, faults, permit }
    }

    /// Returns the kind of database, PostgreSQL or SQLite.
    pub fn dialect(&self) -> Dialect {
        match self.inner {
            Inner::Sqlite(_) => Dialect::Sqlite,
            Inner::Postgres(_) => Dialect::Postgres,
        }
    }

    /// Runs a statement and returns the number of rows that it changed.
    ///
    /// # Errors
    /// Fails if the database rejects the statement or does not answer.
    pub async fn execute(&mut self, statement: &'static str, values: &[Value]) -> Result<u64, DbError> {
        let text = statement::render_statement(statement, self.dialect());
        let done = match &mut self.inner {
            Inner::Sqlite(inner) => {
                query!(Sqlite, text, values).execute(&mut **inner).await.map(|done| done.rows_affected())
            }
            Inner::Postgres(inner) => {
                query!(Postgres, text, values).execute(&mut **inner).await.map(|done| done.rows_affected())
            }
        };
        done.map_err(|error| self.faults.record(error))
    }

    /// Runs a statement and returns its rows.
    ///
    /// # Errors
    /// Fails if the database rejects the statement or does not answer.
    pub async fn rows(&mut self, statement: &'static str, values: &[Value]) -> Result<Vec<Row>, DbError> {
        let text = statement::render_statement(statement, self.dialect());
        let rows = match &mut self.inner {
            Inner::Sqlite(inner) => {
                let rows = query!(Sqlite, text, values).fetch_all(&mut **inner).await;
                rows.map(|rows| rows.into_iter().map(|row| Row(value::Inner::Sqlite(row))).collect())
            }
            Inner::Postgres(inner) => {
                let rows = query!(Postgres, text, values).fetch_all(&mut **inner).await;
                rows.map(|rows| rows.into_iter().map(|row| Row(value::Inner::Postgres(row))).collect())
            }
        };
        rows.map_err(|error| self.faults.record(error))
    }

    /// Runs a statement and reads its rows.
    ///
    /// # Errors
    ///
    /// Fails if the database rejects the statement or does not answer, or if a row cannot be read.
    pub async fn all<T: FromRow>(&mut self, statement: &'static str, values: &[Value]) -> Result<Vec<T>, DbError> {
        self.rows(statement, values).await?.iter().map(T::from_row).collect()
    }

    /// Runs a statement with at most one row, and reads it.
    ///
    /// # Errors
    ///
    /// Fails if the database rejects the statement or does not answer, or if the row cannot be read.
    pub async fn find<T: FromRow>(&mut self, statement: &'static str, values: &[Value]) -> Result<Option<T>, DbError> {
        self.row(statement, values).await?.as_ref().map(T::from_row).transpose()
    }

    /// Runs a statement with at most one row.
    ///
    /// # Errors
    ///
    /// Fails if the database rejects the statement or does not answer.
    pub async fn row(&mut self, statement: &'static str, values: &[Value]) -> Result<Option<Row>, DbError> {
        Ok(self.rows(statement, values).await?.into_iter().next())
    }

    /// Runs a statement with exactly one row.
    ///
    /// # Errors
    ///
    /// Fails if the database rejects the statement, does not answer, or returns no row.
    pub async fn one(&mut self, statement: &'static str, values: &[Value]) -> Result<Row, DbError> {
        self.row(statement, values).await?.ok_or_else(|| DbError::Other(format!("the result is empty: {statement}")))
    }

    /// Runs several statements that are separated by semicolons and take no values, such as definitions of tables.
    pub(super) async fn script(&mut self, script: &str) -> Result<(), DbError> {
        let script = statement::join_parts(script, self.dialect());
        let text = AssertSqlSafe(statement::render_statement(&script, self.dialect()));
        match &mut self.inner {
            Inner::Sqlite(inner) => sqlx::raw_sql(text).execute(&mut **inner).await.map(|_| ())?,
            Inner::Postgres(inner) => sqlx::raw_sql(text).execute(&mut **inner).await.map(|_| ())?,
        }
        Ok(())
    }

    /// Commits the transaction. After an error it is unknown whether the transaction was committed.
    ///
    /// # Errors
    ///
    /// Fails if the database rejects the commit or does not answer.
    pub async fn commit(self) -> Result<(), DbError> {
        let committed = match self.inner {
            Inner::Sqlite(inner) => inner.commit().await,
            Inner::Postgres(inner) => inner.commit().await,
        };
        committed.map_err(|error| self.faults.record(error))
    }
}
