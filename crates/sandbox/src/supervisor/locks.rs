//! Locks of files on behalf of build tools: in the working folder only.
//!
//! A lock needs no right to write, so that every program that may read a file of the system could hold it against the
//! whole machine. Submissions lock nothing. Locks of build tools are announced, and allowed if the open file is beneath
//! the working folder. (A thread that exchanges the descriptor between check and lock gains a lock without effect, for
//! the length of the build.)

use std::path::Path;

use super::filter::LOCK_COMMANDS;
use crate::sys::PendingCall;

/// Returns whether the call locks a file. Other commands for descriptors are never announced.
pub(super) fn concerns(call: i64) -> bool {
    call == libc::SYS_flock || call == libc::SYS_fcntl
}

/// Returns whether the announced lock is of a file beneath `root`.
pub(super) fn is_inside(announced: &PendingCall, root: &Path) -> bool {
    let known = announced.call == libc::SYS_flock || LOCK_COMMANDS.contains(&(announced.arguments[1] & 0xffff_ffff));
    let entry = format!("/proc/{}/fd/{}", announced.thread, announced.arguments[0] as i32);
    known && std::fs::read_link(entry).is_ok_and(|place| place.starts_with(root))
}
