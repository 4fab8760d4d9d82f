//! Submissions: uploading, grading again, marks and standings.

pub(super) mod attempt_changes;
pub(super) mod bulk_enqueue;
pub(super) mod mark;
pub(super) mod regrade;
pub(super) mod regrade_steps;
pub(super) mod repeated_grading;
pub(super) mod standings;
pub(super) mod submit;
