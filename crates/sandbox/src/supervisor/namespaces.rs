//! Creates the namespaces of a run, for processes, network, messages and mounts.
//!
//! The supervisor itself moves into them. It forks once into a new process namespace, where it is process 1, so the
//! kernel kills all its descendants when it ends for any reason. The process outside, the *guardian*, only waits. Root
//! needs no user namespace. A user without privileges gets a user namespace in which it keeps its identity and has
//! rights only over the new namespaces. The rights end when the program is executed.
//!
//! A supervisor that serves many runs ([`keeper`](super::keeper)) moves into namespaces once. For each run it creates
//! new ones inside, for processes, mounts and messages.

use super::file_view;
use crate::{
    mounts,
    sys::{self, Fork},
    wire::{Failure, RunOrder, failure_at},
};

/// The process in which [`enter`] returns: inside or outside of the namespaces.
pub(super) enum NamespaceSide {
    /// The process inside the namespaces. It continues with the run.
    Inside,
    /// The process outside. The process inside has ended with this exit code.
    Outside(u8),
}

/// Moves into new namespaces in which only the files and processes of the order are visible.
///
/// # Errors
///
/// Fails with the name of the step that failed. The process has then moved only partly, and must end.
pub(super) fn enter(order: &RunOrder) -> Result<NamespaceSide, Failure> {
    match fork_into_namespaces()? {
        Fork::Parent(inside) => Ok(NamespaceSide::Outside(sys::wait_for_exit(inside).map_err(failure_at("wait"))?)),
        Fork::Child => {
            let rest = libc::CLONE_NEWNS | libc::CLONE_NEWNET | libc::CLONE_NEWIPC | libc::CLONE_NEWUTS;
            mounts::unshare(rest).map_err(failure_at("make namespaces"))?;
            file_view::build(order)?;
            Ok(NamespaceSide::Inside)
        }
    }
}

/// Forks into a new process namespace. A user without privileges also gets a new user namespace. The child ends when
/// the guardian ends.
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
        // Before a user without privileges sets a group, the kernel requires that it gives up its supplementary groups.
        for (file, text) in [
            ("/proc/self/setgroups", "deny".to_string()),
            ("/proc/self/uid_map", format!("{user} {user} 1")),
            ("/proc/self/gid_map", format!("{group} {group} 1")),
        ] {
            std::fs::write(file, text).map_err(failure_at("map the user into its namespace"))?;
        }
    }
    let side = sys::fork().map_err(failure_at("fork"))?;
    if matches!(side, Fork::Child) {
        sys::die_with_parent().map_err(failure_at("make the supervisor end with its guardian"))?;
    }
    Ok(side)
}
