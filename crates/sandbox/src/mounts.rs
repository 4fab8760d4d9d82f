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

/// The flag that makes the files of a mount read-only.
pub(super) const READ_ONLY: u64 = 0x1;
/// The flag that makes set-user bits ineffective in a mount (`nosuid`).
pub(super) const NO_SET_USER: u64 = 0x2;
/// The flag that makes device files ineffective in a mount (`nodev`).
pub(super) const NO_DEVICES: u64 = 0x4;

const AT_RECURSIVE: u32 = 0x8000;

/// The kernel's structure `mount_attr`.
#[repr(C)]
struct MountAttributes {
    set: u64,
    clear: u64,
    propagation: u64,
    user_namespace: u64,
}

/// Moves this process into new namespaces, given by the flags `CLONE_NEW*`.
pub(super) fn unshare(flags: i32) -> io::Result<()> {
    // SAFETY: the argument is an integer, and nothing in this process depends on the namespaces that it leaves.
    check_answer(unsafe { libc::unshare(flags) })
}

/// Forks into new namespaces, given by the flags `CLONE_NEW*`. The child is in them from the start, and is the first
/// process of a new process namespace.
pub(super) fn fork_into(_: &SingleThread, namespaces: i32) -> io::Result<Fork> {
    let flags = namespaces | libc::SIGCHLD;
    // SAFETY: without a stack of its own, the child continues with a copy of this process's stack, as after `fork`. The
    // process has only one thread, so the copy is consistent. The other arguments belong to flags that are not set.
    match check(unsafe { libc::syscall(libc::SYS_clone, flags, 0, 0, 0, 0) })? {
        0 => Ok(Fork::Child),
        pid => Ok(Fork::Parent(pid as i32)),
    }
}

/// Makes mounts in this namespace invisible elsewhere.
pub(super) fn make_mounts_private() -> io::Result<()> {
    Ok(mount_change(c"/", MountPropagationFlags::PRIVATE | MountPropagationFlags::REC)?)
}

/// Mounts a new file system of the type `kind`. Set-user bits and devices have no effect in it. Its files can be
/// executed only if `executable` is true.
pub(super) fn mount(kind: &CStr, target: &CStr, options: &CStr, executable: bool) -> io::Result<()> {
    let limits = if executable { MountFlags::empty() } else { MountFlags::NOEXEC };
    Ok(rustix::mount::mount(kind, target, kind, MountFlags::NOSUID | MountFlags::NODEV | limits, options)?)
}

/// Returns a copy of the mounts at and below `path`, which is not attached anywhere yet. If `path` ends with a link,
/// the link is not followed.
pub(super) fn copy_mounts(path: &CStr) -> io::Result<OwnedFd> {
    let kind = OpenTreeFlags::OPEN_TREE_CLONE | OpenTreeFlags::OPEN_TREE_CLOEXEC;
    Ok(open_tree(CWD, path, kind | OpenTreeFlags::AT_RECURSIVE | OpenTreeFlags::AT_SYMLINK_NOFOLLOW)?)
}

/// Restricts every mount in a copy, by the given attributes.
pub(super) fn restrict(tree: BorrowedFd<'_>, attributes: u64) -> io::Result<()> {
    set_attributes(tree.as_raw_fd(), c"", AT_RECURSIVE | libc::AT_EMPTY_PATH.cast_unsigned(), attributes)
}

/// Restricts only the mount at `path`, by the given attributes.
pub(super) fn restrict_at(path: &CStr, attributes: u64) -> io::Result<()> {
    set_attributes(libc::AT_FDCWD, path, 0, attributes)
}

fn set_attributes(start: RawFd, path: &CStr, flags: u32, attributes: u64) -> io::Result<()> {
    let attribute_request = MountAttributes { set: attributes, clear: 0, propagation: 0, user_namespace: 0 };
    let size = size_of::<MountAttributes>();
    // SAFETY: the path and the structure outlive the call, and the size is that of the structure.
    let answer = unsafe {
        libc::syscall(libc::SYS_mount_setattr, start, path.as_ptr(), flags, &raw const attribute_request, size)
    };
    check(answer).map(drop)
}

/// Attaches a copy of mounts at `target`.
pub(super) fn attach(tree: BorrowedFd<'_>, target: &CStr) -> io::Result<()> {
    Ok(move_mount(tree, c"", CWD, target, MoveMountFlags::MOVE_MOUNT_F_EMPTY_PATH)?)
}

/// Makes the mount at `root` the root folder. The earlier root folder becomes visible at `old`, below it.
pub(super) fn change_root(root: &CStr, old: &CStr) -> io::Result<()> {
    rustix::process::pivot_root(root, old)?;
    std::env::set_current_dir("/")
}

/// Returns whether the open file is in a mount in which nothing can be executed (`noexec`).
pub(super) fn forbids_execution(fd: BorrowedFd<'_>) -> bool {
    rustix::fs::fstatvfs(fd).is_ok_and(|about| about.f_flag.contains(StatVfsMountFlags::NOEXEC))
}

/// Returns how many bytes and files are in use in the file system of the descriptor.
pub(super) fn file_system_usage(fd: BorrowedFd<'_>) -> io::Result<(u64, u64)> {
    let about = rustix::fs::fstatvfs(fd)?;
    let bytes = about.f_blocks.saturating_sub(about.f_bfree).saturating_mul(about.f_frsize);
    Ok((bytes, about.f_files.saturating_sub(about.f_ffree)))
}

/// Unmounts everything at and below `path`.
pub(super) fn detach(path: &CStr) -> io::Result<()> {
    Ok(unmount(path, UnmountFlags::DETACH)?)
}
