//! Courses and their members.

pub(super) mod example;
pub(super) mod import;
pub(super) mod members;
pub(super) mod removal;
