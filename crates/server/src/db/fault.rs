//! The errors of a database, as far as callers act on them.
use thiserror::Error;

/// Why a statement failed.
#[derive(Debug, Error)]
pub enum DbError {
    /// The database can't be reached or is going away: the same may succeed a moment later.
    #[error("the database can't be reached: {0}")]
    Unavailable(String),
    /// Another transaction was in the way: the same may succeed a moment later.
    #[error("the database is busy: {0}")]
    Busy(String),
    /// Something like it is there already; the statement's author knows what.
    #[error("it is there already: {0}")]
    Conflict(String),
    /// The disk is full, a statement is wrong, a value is not what it should be.
    #[error("the database refused: {0}")]
    Other(String),
}

impl DbError {
    /// Whether the same may succeed a moment later.
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
                match refusal.code().as_deref() {
                    // SQLite: BUSY and LOCKED with their extended codes.
                    Some("5" | "6" | "261" | "262" | "517" | "773") => Self::Busy(text),
                    // PostgreSQL: serialization failure, deadlock, lock not available.
                    Some("40001" | "40P01" | "55P03") => Self::Busy(text),
                    // PostgreSQL: connection lost, shutting down, starting up, too many connections.
                    Some(code) if code.starts_with("08") || code.starts_with("57P") || code == "53300" => {
                        Self::Unavailable(text)
                    }
                    _ => Self::Other(text),
                }
            }
            _ => Self::Other(text),
        }
    }
}
