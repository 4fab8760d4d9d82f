//! The exit codes of all commands. Only the drop-in for the original has the original's exit codes.

/// Everything was accepted, or the command did its work.
pub const ACCEPTED: u8 = 0;
/// A submission is not accepted, two traces differ, or recordings are not as expected.
pub const NOT_ACCEPTED: u8 = 1;
/// Wrong usage, an unusable input, or an error of this program. This is never a verdict on a submission.
pub const FAULT: u8 = 2;
/// The program was interrupted by SIGINT or SIGTERM. No output is incomplete.
pub const INTERRUPTED: u8 = 130;
