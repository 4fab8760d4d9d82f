//! The system calls that make namespaces and mounts, each behind a safe function.
//!
//! Like `sys.rs`, and with the same promise: every function passes the kernel valid pointers to live values, turns its
//! answer into a `Result`, and keeps no pointer. Only the supervisor's own fresh process calls these.

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

/// Files there can be read and not changed.
pub(super) const READ_ONLY: u64 = 0x1;
/// Set-user bits are without effect.
pub(super) const NO_SET_USER: u64 = 0x2;
/// Device files are without effect.
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

/// Leaves namespaces for new ones (`CLONE_NEW*`).
pub(super) fn unshare(flags: i32) -> io::Result<()> {
    // SAFETY: an integer; nothing of ours depends on the namespaces that are left.
    check_answer(unsafe { libc::unshare(flags) })
}

/// Forks into new namespaces (`CLONE_NEW*`). The child is in them immediately, and is the first process of a namespace
/// of processes.
pub(super) fn fork_into(_: &SingleThread, namespaces: i32) -> io::Result<Fork> {
    let flags = namespaces | libc::SIGCHLD;
    // SAFETY: without a stack of its own the child continues with a copy of ours, as after `fork`; the process has one
    // thread, so that the copy is consistent. The other arguments are for flags that are not set.
    match check(unsafe { libc::syscall(libc::SYS_clone, flags, 0, 0, 0, 0) })? {
        0 => Ok(Fork::Child),
        pid => Ok(Fork::Parent(pid as i32)),
    }
}

/// Hides mounts of this namespace everywhere else.
pub(super) fn keep_to_ourselves() -> io::Result<()> {
    Ok(mount_change(c"/", MountPropagationFlags::PRIVATE | MountPropagationFlags::REC)?)
}

/// Mounts a fresh file system of this kind. Set-user bits and devices have no effect in it; its files may be executed
/// only on request.
pub(super) fn mount(kind: &CStr, target: &CStr, options: &CStr, executable: bool) -> io::Result<()> {
    let limits = if executable { MountFlags::empty() } else { MountFlags::NOEXEC };
    Ok(rustix::mount::mount(kind, target, kind, MountFlags::NOSUID | MountFlags::NODEV | limits, options)?)
}

/// Returns a copy of the mounts at and beneath the path, which is not attached yet. A link at its end is not followed.
pub(super) fn copy_of(path: &CStr) -> io::Result<OwnedFd> {
    let kind = OpenTreeFlags::OPEN_TREE_CLONE | OpenTreeFlags::OPEN_TREE_CLOEXEC;
    Ok(open_tree(CWD, path, kind | OpenTreeFlags::AT_RECURSIVE | OpenTreeFlags::AT_SYMLINK_NOFOLLOW)?)
}

/// Restricts every mount of the copy.
pub(super) fn restrict(tree: BorrowedFd<'_>, attributes: u64) -> io::Result<()> {
    set_attributes(tree.as_raw_fd(), c"", AT_RECURSIVE | libc::AT_EMPTY_PATH.cast_unsigned(), attributes)
}

/// Restricts the one mount at the path.
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

/// Lays the copy over the path.
pub(super) fn attach(tree: BorrowedFd<'_>, target: &CStr) -> io::Result<()> {
    Ok(move_mount(tree, c"", CWD, target, MoveMountFlags::MOVE_MOUNT_F_EMPTY_PATH)?)
}

/// Makes the mount at `root` the root folder, and the old root a folder beneath it.
pub(super) fn change_root(root: &CStr, old: &CStr) -> io::Result<()> {
    rustix::process::pivot_root(root, old)?;
    std::env::set_current_dir("/")
}

/// Returns whether the open file is where nothing may be executed (a mount with `noexec`).
pub(super) fn forbids_execution(fd: BorrowedFd<'_>) -> bool {
    rustix::fs::fstatvfs(fd).is_ok_and(|about| about.f_flag.contains(StatVfsMountFlags::NOEXEC))
}

/// Returns the bytes and files of the descriptor's file system.
pub(super) fn file_system_usage(fd: BorrowedFd<'_>) -> io::Result<(u64, u64)> {
    let about = rustix::fs::fstatvfs(fd)?;
    let bytes = about.f_blocks.saturating_sub(about.f_bfree).saturating_mul(about.f_frsize);
    Ok((bytes, about.f_files.saturating_sub(about.f_ffree)))
}

/// Takes the mounts at and beneath the path away.
pub(super) fn detach(path: &CStr) -> io::Result<()> {
    Ok(unmount(path, UnmountFlags::DETACH)?)
}
