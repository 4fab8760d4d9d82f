//! The system calls that make namespaces and mounts, each behind a safe function.
//!
//! Like `sys.rs`, and with the same promise: every function passes the kernel valid pointers to live values, turns its
//! answer into a `Result`, and keeps no pointer. Only the supervisor's own fresh process calls these.

#![expect(unsafe_code, reason = "namespaces and mounts have no safe wrapper among the dependencies")]

use std::{
    ffi::CStr,
    io,
    os::fd::{AsRawFd, BorrowedFd, FromRawFd, OwnedFd, RawFd},
};

use crate::sys::{Fork, SingleThread, check, done};

/// Files there can be read and not changed.
pub(super) const READ_ONLY: u64 = 0x1;
/// Set-user bits are without effect.
pub(super) const NO_SET_USER: u64 = 0x2;
/// Device files are without effect.
pub(super) const NO_DEVICES: u64 = 0x4;

const OPEN_TREE_CLONE: u32 = 1;
const AT_RECURSIVE: u32 = 0x8000;
const MOVE_MOUNT_FROM_DESCRIPTOR: u32 = 4;

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
    done(unsafe { libc::unshare(flags) })
}

/// Forks into new namespaces (`CLONE_NEW*`), in which the child is at once, and the first process if one is of
/// processes.
pub(super) fn fork_into(_: &SingleThread, namespaces: i32) -> io::Result<Fork> {
    let flags = namespaces | libc::SIGCHLD;
    // SAFETY: without a stack of its own the child goes on with a copy of ours, as after `fork`; the process has one
    // thread, so that the copy is consistent. The other arguments are for flags that are not set.
    match check(unsafe { libc::syscall(libc::SYS_clone, flags, 0, 0, 0, 0) })? {
        0 => Ok(Fork::Child),
        pid => Ok(Fork::Parent(pid as i32)),
    }
}

/// Has no mount of this namespace show anywhere else.
pub(super) fn keep_to_ourselves() -> io::Result<()> {
    let flags = libc::MS_REC | libc::MS_PRIVATE;
    // SAFETY: the path is a constant; the other pointers are not read for a change of propagation.
    done(unsafe { libc::mount(std::ptr::null(), c"/".as_ptr(), std::ptr::null(), flags, std::ptr::null()) })
}

/// Mounts a fresh file system of this kind. What set-user bits and devices mean there is: nothing. Its files may be
/// executed only where that is said.
pub(super) fn mount(kind: &CStr, target: &CStr, options: &CStr, executable: bool) -> io::Result<()> {
    let flags = libc::MS_NOSUID | libc::MS_NODEV | if executable { 0 } else { libc::MS_NOEXEC };
    // SAFETY: all texts outlive the call.
    done(unsafe { libc::mount(kind.as_ptr(), target.as_ptr(), kind.as_ptr(), flags, options.as_ptr().cast()) })
}

/// A copy of the mounts at and beneath the path, which lies nowhere yet. A link at its end is not followed.
pub(super) fn copy_of(path: &CStr) -> io::Result<OwnedFd> {
    let flags = OPEN_TREE_CLONE | AT_RECURSIVE | (libc::O_CLOEXEC | libc::AT_SYMLINK_NOFOLLOW).cast_unsigned();
    // SAFETY: the path outlives the call.
    let fd = check(unsafe { libc::syscall(libc::SYS_open_tree, libc::AT_FDCWD, path.as_ptr(), flags) })?;
    // SAFETY: the kernel has just opened it for us alone.
    Ok(unsafe { OwnedFd::from_raw_fd(fd as RawFd) })
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
    // SAFETY: both paths outlive the call; the empty one means the descriptor itself.
    let answer = unsafe {
        libc::syscall(
            libc::SYS_move_mount,
            tree.as_raw_fd(),
            c"".as_ptr(),
            libc::AT_FDCWD,
            target.as_ptr(),
            MOVE_MOUNT_FROM_DESCRIPTOR,
        )
    };
    check(answer).map(drop)
}

/// Makes the mount at `root` the root folder, and the old root a folder beneath it.
pub(super) fn change_root(root: &CStr, old: &CStr) -> io::Result<()> {
    // SAFETY: both paths outlive the call.
    check(unsafe { libc::syscall(libc::SYS_pivot_root, root.as_ptr(), old.as_ptr()) })?;
    std::env::set_current_dir("/")
}

/// The facts of the file system that the descriptor lies on.
fn about_file_system(fd: BorrowedFd<'_>) -> io::Result<libc::statvfs> {
    // SAFETY: an all-zero structure is valid and outlives the call, which fills it.
    unsafe {
        let mut about: libc::statvfs = std::mem::zeroed();
        done(libc::fstatvfs(fd.as_raw_fd(), &raw mut about)).map(|()| about)
    }
}

/// Whether the open file lies where nothing may be executed (a mount with `noexec`).
pub(super) fn forbids_execution(fd: BorrowedFd<'_>) -> bool {
    about_file_system(fd).is_ok_and(|about| about.f_flag & libc::ST_NOEXEC != 0)
}

/// Bytes and files of the file system that the descriptor lies on.
pub(super) fn file_system_usage(fd: BorrowedFd<'_>) -> io::Result<(u64, u64)> {
    let about = about_file_system(fd)?;
    let bytes = about.f_blocks.saturating_sub(about.f_bfree).saturating_mul(about.f_frsize);
    Ok((bytes, about.f_files.saturating_sub(about.f_ffree)))
}

/// Takes the mounts at and beneath the path away.
pub(super) fn detach(path: &CStr) -> io::Result<()> {
    // SAFETY: the path outlives the call.
    done(unsafe { libc::umount2(path.as_ptr(), libc::MNT_DETACH) })
}
