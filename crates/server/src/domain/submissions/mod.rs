//! Submissions: uploading, grading again, marks and standings.

pub(super) mod attempt_changes;
pub(super) mod bulk_enqueue;
pub(super) mod campaign;
pub(super) mod mark;
pub(super) mod regrade;
pub(super) mod repeated_grading;
pub(super) mod standings;
pub(super) mod submit;
