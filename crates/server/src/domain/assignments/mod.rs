//! Assignments: their settings and suites.

pub(super) mod settings;
pub(super) mod suites;
