//! The values in statements and in their results. There are two types of values: integers (numbers, times, booleans)
//! and text (names, digests, JSON). Points are text, too, so that they stay exact.
use super::DbError;
use sqlx::{Row as _, postgres::PgRow, sqlite::SqliteRow};

/// A value for a statement's next `?`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Value {
    /// An integer or NULL.
    Int(Option<i64>),
    /// Text or NULL.
    Text(Option<String>),
}

macro_rules! from {
    ($($from:ty => $make:expr;)*) => {
        $(impl From<$from> for Value {
            fn from(value: $from) -> Self {
                let make: fn($from) -> Self = $make;
                make(value)
            }
        })*
    };
}

from! {
    i64 => |value| Self::Int(Some(value));
    Option<i64> => Self::Int;
    u32 => |value| Self::Int(Some(value.into()));
    bool => |value| Self::Int(Some(value.into()));
    &str => |value| Self::Text(Some(value.to_owned()));
    &String => |value| Self::Text(Some(value.clone()));
    String => |value| Self::Text(Some(value));
    Option<String> => Self::Text;
    Option<&str> => |value| Self::Text(value.map(str::to_owned));
}

/// Lists the values of a statement, in the order of its `?`.
#[macro_export]
macro_rules! values {
    ($($value:expr),* $(,)?) => { &[$($crate::db::Value::from($value)),*] };
}

/// A row of a statement's result. Columns are read by name. If a column is missing or has another type, the statement
/// is wrong ([`DbError::Other`]).
#[derive(Debug)]
pub struct Row(pub(super) Inner);

#[derive(Debug)]
pub(super) enum Inner {
    Sqlite(SqliteRow),
    Postgres(PgRow),
}

impl Row {
    /// Reads an integer.
    ///
    /// # Errors
    ///
    /// Fails if the column is NULL or has another type.
    pub fn int(&self, column: &str) -> Result<i64, DbError> {
        self.maybe_int(column)?.ok_or_else(|| DbError::Other(format!("{column} is empty")))
    }

    /// Reads an integer, or `None` for NULL.
    ///
    /// # Errors
    ///
    /// Fails if the column has another type.
    pub fn maybe_int(&self, column: &str) -> Result<Option<i64>, DbError> {
        Ok(match &self.0 {
            Inner::Sqlite(row) => row.try_get(column)?,
            Inner::Postgres(row) => row.try_get(column)?,
        })
    }

    /// Reads text.
    ///
    /// # Errors
    ///
    /// Fails if the column is NULL or has another type.
    pub fn text(&self, column: &str) -> Result<String, DbError> {
        self.maybe_text(column)?.ok_or_else(|| DbError::Other(format!("{column} is empty")))
    }

    /// Reads text, or `None` for NULL.
    ///
    /// # Errors
    ///
    /// Fails if the column has another type.
    pub fn maybe_text(&self, column: &str) -> Result<Option<String>, DbError> {
        Ok(match &self.0 {
            Inner::Sqlite(row) => row.try_get(column)?,
            Inner::Postgres(row) => row.try_get(column)?,
        })
    }

    /// Reads a boolean, stored as 1 or 0.
    ///
    /// # Errors
    ///
    /// Fails if the column has another type.
    pub fn flag(&self, column: &str) -> Result<bool, DbError> {
        Ok(self.int(column)? != 0)
    }
}

/// A Rust type that a column's value can be read as.
pub trait Column: Sized {
    /// Reads the value of a column.
    ///
    /// # Errors
    ///
    /// Fails if the column has another type.
    fn read(row: &Row, column: &str) -> Result<Self, DbError>;
}

macro_rules! columns {
    ($($type:ty => $read:ident;)*) => {
        $(impl Column for $type {
            fn read(row: &Row, column: &str) -> Result<Self, DbError> {
                row.$read(column)
            }
        })*
    };
}

columns! {
    i64 => int;
    Option<i64> => maybe_int;
    String => text;
    Option<String> => maybe_text;
    bool => flag;
}

/// A type that is read from a whole row.
pub trait FromRow: Sized {
    /// Reads the value from a row.
    ///
    /// # Errors
    ///
    /// Fails if a column is missing or has another type.
    fn from_row(row: &Row) -> Result<Self, DbError>;
}

/// Implements [`FromRow`] for types whose fields are named like their columns. Other column names can be given.
macro_rules! from_row {
    ($($type:ty { $($field:ident $(= $column:literal)?),* $(,)? })*) => {
        $(impl $crate::db::FromRow for $type {
            fn from_row(row: &$crate::db::Row) -> Result<Self, $crate::db::DbError> {
                Ok($crate::db::read_row!(row => Self { $($field $(= $column)?),*; }))
            }
        })*
    };
}
pub(crate) use from_row;

/// Reads the fields of a struct from a row, from columns of the same names or of the given names. Fields after the
/// semicolon have expressions.
macro_rules! read_row {
    ($row:ident => $type:ident { $($field:ident $(= $column:literal)?),* $(,)?; $($rest:tt)* }) => {
        $type { $($field: $crate::db::read_row!(@ $row $field $($column)?),)* $($rest)* }
    };
    (@ $row:ident $field:ident) => { $crate::db::Column::read($row, stringify!($field))? };
    (@ $row:ident $field:ident $column:literal) => { $crate::db::Column::read($row, $column)? };
}
pub(crate) use read_row;
