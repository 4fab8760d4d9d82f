//! Learning platforms, and the people and links that come from them.

pub(super) mod choice;
pub(super) mod launch;
pub(super) mod platform;
