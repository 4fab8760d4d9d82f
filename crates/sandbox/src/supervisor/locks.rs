//! Locks files on behalf of build tools, only in the working folder.
//!
//! Locking a file does not require the right to write it. Every program that may read a file of the system could
//! therefore block the whole machine with a lock. Submissions must not lock files. Locks of build tools are announced,
//! and are allowed if the open file is below the working folder. (If a thread replaces the descriptor between the check
//! and the lock, it gets a harmless lock for the duration of the build.)

use std::path::Path;

use super::filter::LOCK_COMMANDS;
use crate::sys::PendingCall;

/// Returns whether the call can lock a file. Of the commands of `fcntl`, only those that lock files are announced.
pub(super) fn is_lock_call(call: i64) -> bool {
    call == libc::SYS_flock || call == libc::SYS_fcntl
}

/// Returns whether the announced call locks a file below `root`.
pub(super) fn is_inside(announced: &PendingCall, root: &Path) -> bool {
    let is_lock_call =
        announced.call == libc::SYS_flock || LOCK_COMMANDS.contains(&(announced.arguments[1] & 0xffff_ffff));
    let entry = format!("/proc/{}/fd/{}", announced.thread, announced.arguments[0] as i32);
    is_lock_call && std::fs::read_link(entry).is_ok_and(|target| target.starts_with(root))
}
