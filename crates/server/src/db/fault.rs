//! The errors of a database that callers distinguish.
use thiserror::Error;

/// The reason why a statement failed.
#[derive(Debug, Error)]
pub enum DbError {
    /// The database can't be reached or is shutting down; a retry may succeed.
    #[error("the database can't be reached: {0}")]
    Unavailable(String),
    /// Another transaction blocks this one, or conflicts with it; a retry may succeed.
    #[error("the database is busy: {0}")]
    Busy(String),
    /// A row with the same key exists already. The statement's caller knows which row.
    #[error("a row with this key exists already: {0}")]
    Conflict(String),
    /// A statement is wrong, or a value has an unexpected form.
    #[error("the database rejected the statement: {0}")]
    Other(String),
}

impl DbError {
    /// Returns whether a retry may succeed.
    pub fn is_transient(&self) -> bool {
        matches!(self, Self::Unavailable(_) | Self::Busy(_))
    }
}

impl From<sqlx::Error> for DbError {
    fn from(error: sqlx::Error) -> Self {
        use sqlx::Error;
        let text = error.to_string();
        match &error {
            Error::Io(_) | Error::PoolTimedOut | Error::PoolClosed | Error::WorkerCrashed | Error::Protocol(_) => {
                Self::Unavailable(text)
            }
            Error::Database(refusal) => {
                if refusal.is_unique_violation() {
                    return Self::Conflict(text);
                }
                let code = refusal.code().unwrap_or_default();
                // SQLite's codes are numbers; the lower byte is the kind.
                let kind = if code.len() < 5 { code.parse::<u32>().ok().map(|code| code & 0xff) } else { None };
                match (kind, code.as_ref()) {
                    // SQLITE_BUSY and SQLITE_LOCKED.
                    (Some(5 | 6), _) => Self::Busy(text),
                    // SQLITE_READONLY, SQLITE_IOERR, SQLITE_FULL and SQLITE_CANTOPEN.
                    (Some(8 | 10 | 13 | 14), _) => Self::Unavailable(text),
                    // PostgreSQL: serialization failure, deadlock, lock not available.
                    (None, "40001" | "40P01" | "55P03") => Self::Busy(text),
                    // PostgreSQL: the database is read-only, for example during a failover, or a statement timed out.
                    (None, "25006" | "57014") => Self::Unavailable(text),
                    // PostgreSQL: the connection was lost; the server is shutting down, starting up, or out of disk
                    // space, memory or connections; a file is unusable; or an internal error occurred.
                    (None, code) if ["08", "53", "57P", "58", "XX"].iter().any(|class| code.starts_with(class)) => {
                        Self::Unavailable(text)
                    }
                    _ => Self::Other(text),
                }
            }
            _ => Self::Other(text),
        }
    }
}
