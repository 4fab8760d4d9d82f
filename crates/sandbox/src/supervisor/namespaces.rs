//! Namespaces of its own for one run: processes, network, messages and mounts.
//!
//! The supervisor itself moves in. It forks once into a new process namespace, where it is process 1: when it dies,
//! whatever the reason, the kernel ends everything below it immediately. The process that stays outside, the
//! *guardian*, only waits. Root needs no user namespace; an ordinary user gets one in which it is itself, with rights
//! over the new namespaces only. These rights end with the execution of the program.
//!
//! A supervisor that serves many runs ([`keeper`](super::keeper)) moves in once, and gives each run a process
//! namespace, mounts and messages of its own within.

use super::view;
use crate::{
    mounts,
    sys::{self, Fork},
    wire::{Failure, RunOrder, stage},
};

/// The process in which [`enter`] returns.
pub(super) enum Side {
    /// Inside: go on.
    Inside,
    /// Outside, after the process inside has ended with this code.
    Outside(u8),
}

/// Moves into namespaces of its own, in which only what the order needs is visible.
///
/// # Errors
///
/// The step that failed. The process is then between the namespaces and must end.
pub(super) fn enter(order: &RunOrder) -> Result<Side, Failure> {
    match leave()? {
        Fork::Parent(inside) => Ok(Side::Outside(sys::wait_for(inside).map_err(stage("wait"))?)),
        Fork::Child => {
            let rest = libc::CLONE_NEWNS | libc::CLONE_NEWNET | libc::CLONE_NEWIPC | libc::CLONE_NEWUTS;
            mounts::unshare(rest).map_err(stage("make namespaces"))?;
            view::build(order)?;
            Ok(Side::Inside)
        }
    }
}

/// Forks into a new process namespace, an ordinary user's with a user namespace around it. The child dies with the
/// guardian.
///
/// # Errors
///
/// As for [`enter`].
pub(super) fn leave() -> Result<Fork, Failure> {
    let (user, group) = (sys::user(), sys::group());
    if user == 0 {
        mounts::unshare(libc::CLONE_NEWPID).map_err(stage("make a process namespace"))?;
    } else {
        mounts::unshare(libc::CLONE_NEWUSER | libc::CLONE_NEWPID).map_err(stage("make a user namespace"))?;
        // The kernel wants the groups given up before an ordinary user names its own.
        for (file, text) in [
            ("/proc/self/setgroups", "deny".to_string()),
            ("/proc/self/uid_map", format!("{user} {user} 1")),
            ("/proc/self/gid_map", format!("{group} {group} 1")),
        ] {
            std::fs::write(file, text).map_err(stage("name the user in its namespace"))?;
        }
    }
    let side = sys::fork().map_err(stage("fork"))?;
    if matches!(side, Fork::Child) {
        sys::die_with_parent().map_err(stage("bind the supervisor's life to its guardian's"))?;
    }
    Ok(side)
}
