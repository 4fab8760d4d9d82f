//! Somebody's account.
use crate::db::from_row;
use serde::Serialize;
use utoipa::ToSchema;

/// Somebody's account.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Account {
    /// Its number.
    #[serde(skip)]
    pub(crate) id: i64,
    /// The name in addresses and tables.
    pub login: String,
    /// The name of its owner.
    pub name: String,
    /// Whether it may do everything.
    pub is_admin: bool,
}

from_row! { Account { id, login, name, is_admin } }
