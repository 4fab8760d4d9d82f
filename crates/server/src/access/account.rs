//! Somebody's account.
use crate::db::{DbError, Row};
use serde::Serialize;
use utoipa::ToSchema;

/// Somebody's account.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Account {
    /// Its number.
    #[serde(skip)]
    pub(crate) id: i64,
    /// What it is called in addresses and tables.
    pub login: String,
    /// What its owner is called.
    pub name: String,
    /// Whether it may do everything.
    pub is_admin: bool,
}

impl Account {
    pub(super) fn read(row: &Row) -> Result<Self, DbError> {
        Ok(Self {
            id: row.int("id")?,
            login: row.text("login")?,
            name: row.text("name")?,
            is_admin: row.flag("is_admin")?,
        })
    }
}
