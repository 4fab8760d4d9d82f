//! Learning platforms, with their people and links.

pub(super) mod choice;
pub(super) mod launch;
pub(super) mod platform;
