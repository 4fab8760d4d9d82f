//! The system calls that create namespaces and mounts, each wrapped in a safe function.
//!
//! As in `sys.rs`, every function passes the kernel valid pointers to live values, converts its result into a `Result`,
//! and keeps no pointer. Only the new process of the supervisor calls them.

#![expect(unsafe_code, reason = "namespaces and mounts have no safe wrapper among the dependencies")]

use std::{
    ffi::CStr,
    io,
    os::fd::{AsRawFd, BorrowedFd, OwnedFd, RawFd},
};

use rustix::{
    fs::{CWD, StatVfsMountFlags},
    mount::{
        MountFlags, MountPropagationFlags, MoveMountFlags, OpenTreeFlags, UnmountFlags, mount_change, move_mount,
        open_tree, unmount,
    },
};

use crate::sys::{Fork, SingleThread, check, check_answer};

/// Files in the mount can be read but not changed.
pub(super) const READ_ONLY: u64 = 0x1;
/// Set-user bits have no effect (`nosuid`).
pub(super) const NO_SET_USER: u64 = 0x2;
/// Device files have no effect (`nodev`).
pub(super) const NO_DEVICES: u64 = 0x4;

const AT_RECURSIVE: u32 = 0x8000;

/// The kernel's `mount_attr`.
#[repr(C)]
struct MountAttributes {
    set: u64,
    clear: u64,
    propagation: u64,
    user_namespace: u64,
}

/// Moves this process into new namespaces (`CLONE_NEW*`).
pub(super) fn unshare(flags: i32) -> io::Result<()> {
    // SAFETY: an integer; nothing of ours depends on the namespaces that are left.
    check_answer(unsafe { libc::unshare(flags) })
}

/// Forks into new namespaces (`CLONE_NEW*`). The child is immediately in them, and is the first process of a new
/// process namespace.
pub(super) fn fork_into(_: &SingleThread, namespaces: i32) -> io::Result<Fork> {
    let flags = namespaces | libc::SIGCHLD;
    // SAFETY: without a stack of its own the child continues with a copy of ours, as after `fork`; the process has one
    // thread, so that the copy is consistent. The other arguments are for flags that are not set.
    match check(unsafe { libc::syscall(libc::SYS_clone, flags, 0, 0, 0, 0) })? {
        0 => Ok(Fork::Child),
        pid => Ok(Fork::Parent(pid as i32)),
    }
}

/// Stops mounts of this namespace from appearing elsewhere.
pub(super) fn make_mounts_private() -> io::Result<()> {
    Ok(mount_change(c"/", MountPropagationFlags::PRIVATE | MountPropagationFlags::REC)?)
}

/// Mounts a new file system of type `kind`. Set-user bits and devices have no effect in it; its files are executable
/// only if `executable`.
pub(super) fn mount(kind: &CStr, target: &CStr, options: &CStr, executable: bool) -> io::Result<()> {
    let limits = if executable { MountFlags::empty() } else { MountFlags::NOEXEC };
    Ok(rustix::mount::mount(kind, target, kind, MountFlags::NOSUID | MountFlags::NODEV | limits, options)?)
}

/// Returns a copy of the mounts at and below `path` that is not attached yet. A link at the end of `path` is not
/// followed.
pub(super) fn copy_of(path: &CStr) -> io::Result<OwnedFd> {
    let kind = OpenTreeFlags::OPEN_TREE_CLONE | OpenTreeFlags::OPEN_TREE_CLOEXEC;
    Ok(open_tree(CWD, path, kind | OpenTreeFlags::AT_RECURSIVE | OpenTreeFlags::AT_SYMLINK_NOFOLLOW)?)
}

/// Restricts every mount of a copy.
pub(super) fn restrict(tree: BorrowedFd<'_>, attributes: u64) -> io::Result<()> {
    set_attributes(tree.as_raw_fd(), c"", AT_RECURSIVE | libc::AT_EMPTY_PATH.cast_unsigned(), attributes)
}

/// Restricts only the mount at `path`.
pub(super) fn restrict_at(path: &CStr, attributes: u64) -> io::Result<()> {
    set_attributes(libc::AT_FDCWD, path, 0, attributes)
}

fn set_attributes(start: RawFd, path: &CStr, flags: u32, attributes: u64) -> io::Result<()> {
    let wanted = MountAttributes { set: attributes, clear: 0, propagation: 0, user_namespace: 0 };
    let size = size_of::<MountAttributes>();
    // SAFETY: path and structure outlive the call and the size is the structure's.
    let answer =
        unsafe { libc::syscall(libc::SYS_mount_setattr, start, path.as_ptr(), flags, &raw const wanted, size) };
    check(answer).map(drop)
}

/// Attaches a copy at `target`.
pub(super) fn attach(tree: BorrowedFd<'_>, target: &CStr) -> io::Result<()> {
    Ok(move_mount(tree, c"", CWD, target, MoveMountFlags::MOVE_MOUNT_F_EMPTY_PATH)?)
}

/// Makes the mount at `root` the root folder, and the old root a folder below it.
pub(super) fn change_root(root: &CStr, old: &CStr) -> io::Result<()> {
    rustix::process::pivot_root(root, old)?;
    std::env::set_current_dir("/")
}

/// Returns whether the open file is in a mount that forbids execution (`noexec`).
pub(super) fn forbids_execution(fd: BorrowedFd<'_>) -> bool {
    rustix::fs::fstatvfs(fd).is_ok_and(|about| about.f_flag.contains(StatVfsMountFlags::NOEXEC))
}

/// Returns the bytes and files of the descriptor's file system.
pub(super) fn file_system_usage(fd: BorrowedFd<'_>) -> io::Result<(u64, u64)> {
    let about = rustix::fs::fstatvfs(fd)?;
    let bytes = about.f_blocks.saturating_sub(about.f_bfree).saturating_mul(about.f_frsize);
    Ok((bytes, about.f_files.saturating_sub(about.f_ffree)))
}

/// Unmounts everything at and below `path`.
pub(super) fn detach(path: &CStr) -> io::Result<()> {
    Ok(unmount(path, UnmountFlags::DETACH)?)
}
