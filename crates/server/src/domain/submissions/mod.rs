//! Submissions: uploading, grading again, marks and standings.

pub(super) mod again;
pub(super) mod bulk;
pub(super) mod campaign;
pub(super) mod failed;
pub(super) mod mark;
pub(super) mod regrade;
pub(super) mod standings;
pub(super) mod submit;
