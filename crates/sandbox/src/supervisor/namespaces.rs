//! Namespaces for one run: processes, network, messages and mounts.
//!
//! The supervisor itself moves into them. It forks once into a new process namespace, where it is process 1, so the
//! kernel ends all its descendants when it dies for any reason. The process outside, the *guardian*, only waits. Root
//! needs no user namespace. An ordinary user gets a user namespace in which it keeps its identity and has rights only
//! over the new namespaces. The rights end when the program is executed.
//!
//! A supervisor that serves many runs ([`keeper`](super::keeper)) moves in once, and creates a process namespace,
//! mounts and messages for each run inside.

use super::view;
use crate::{
    mounts,
    sys::{self, Fork},
    wire::{Failure, RunOrder, failure_at},
};

/// The process in which [`enter`] returns.
pub(super) enum Side {
    /// The process inside the namespaces, which continues.
    Inside,
    /// The process outside, after the process inside has ended with this code.
    Outside(u8),
}

/// Moves into new namespaces in which only the files and processes of the order are visible.
///
/// # Errors
///
/// Fails with the name of the step that failed. The process is then between the namespaces and must end.
pub(super) fn enter(order: &RunOrder) -> Result<Side, Failure> {
    match fork_into_namespaces()? {
        Fork::Parent(inside) => Ok(Side::Outside(sys::wait_for(inside).map_err(failure_at("wait"))?)),
        Fork::Child => {
            let rest = libc::CLONE_NEWNS | libc::CLONE_NEWNET | libc::CLONE_NEWIPC | libc::CLONE_NEWUTS;
            mounts::unshare(rest).map_err(failure_at("make namespaces"))?;
            view::build(order)?;
            Ok(Side::Inside)
        }
    }
}

/// Forks into a new process namespace, for an ordinary user within a new user namespace. The child dies with the
/// guardian.
///
/// # Errors
///
/// Fails like [`enter`].
pub(super) fn fork_into_namespaces() -> Result<Fork, Failure> {
    let (user, group) = (sys::user_id(), sys::group_id());
    if user == 0 {
        mounts::unshare(libc::CLONE_NEWPID).map_err(failure_at("make a process namespace"))?;
    } else {
        mounts::unshare(libc::CLONE_NEWUSER | libc::CLONE_NEWPID).map_err(failure_at("make a user namespace"))?;
        // The kernel requires an ordinary user to give up supplementary groups before it sets a group.
        for (file, text) in [
            ("/proc/self/setgroups", "deny".to_string()),
            ("/proc/self/uid_map", format!("{user} {user} 1")),
            ("/proc/self/gid_map", format!("{group} {group} 1")),
        ] {
            std::fs::write(file, text).map_err(failure_at("name the user in its namespace"))?;
        }
    }
    let side = sys::fork().map_err(failure_at("fork"))?;
    if matches!(side, Fork::Child) {
        sys::die_with_parent().map_err(failure_at("bind the supervisor's life to its guardian's"))?;
    }
    Ok(side)
}
