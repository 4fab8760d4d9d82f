//! Accounts: how people sign in, and what shares of the server they have.

pub(super) mod identity;
pub(super) mod limits;
pub(super) mod newcomer;
pub(super) mod pending;
pub(super) mod provider;
pub(super) mod throttle;
pub(super) mod turns;
