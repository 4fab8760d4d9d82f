//! The exit codes of every command but the drop-in, whose codes are the original's.

/// Everything was accepted, or the command did its work.
pub const ACCEPTED: u8 = 0;
/// Graded and not accepted; two traces that differ; recordings that are not as expected.
pub const NOT_ACCEPTED: u8 = 1;
/// Wrong usage, an input that can't be used, or our own fault. Never a verdict on a submission.
pub const FAULT: u8 = 2;
/// Ended by SIGINT or SIGTERM; no output is left half-written.
pub const INTERRUPTED: u8 = 130;
