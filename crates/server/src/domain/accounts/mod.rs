//! Accounts: how people sign in, and their limits on the server.

pub(super) mod identity;
pub(super) mod limits;
pub(super) mod newcomer;
pub(super) mod pending_sign_in;
pub(super) mod provider;
pub(super) mod throttle;
