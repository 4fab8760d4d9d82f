//! Changes permission bits on behalf of build tools that run as the grader's own user.
//!
//! Linkers make their output executable, and name the file by its path. Landlock does not restrict permission bits, so
//! a build step could change those of the grader's own files. Therefore the call is announced. If the file is below the
//! working folder, the supervisor makes the change; otherwise it denies the call. Links are not followed.

use std::{
    ffi::CString,
    fs::{File, Permissions},
    io::{self, Read, Seek, SeekFrom},
    os::{
        fd::{AsRawFd, BorrowedFd, OwnedFd},
        unix::{ffi::OsStrExt, fs::PermissionsExt},
    },
    path::{Path, PathBuf},
};

use super::calls;
use crate::sys::{self, OFlags, PendingCall};

/// The permission bits that may be set. The bits for set-user and set-group are excluded.
const MODE_BITS: u64 = 0o1777;

/// Returns whether the call changes permission bits.
pub(super) fn is_mode_call(call: i64) -> bool {
    calls::MODE_CALLS.iter().any(|(_, number)| *number == call)
}

/// Makes the change if the file is below `folder`, whose path is `root`.
///
/// # Errors
///
/// Fails with the error number that the caller gets.
pub(super) fn change_mode(announced: &PendingCall, folder: BorrowedFd<'_>, root: &Path) -> Result<(), i32> {
    let [first, second, third, ..] = announced.arguments;
    let thread = announced.thread;
    let (file, mode) = match announced.call {
        libc::SYS_fchmod => (reopen_descriptor(thread, first, folder, root)?, second),
        libc::SYS_fchmodat => {
            let start = if first as i32 == libc::AT_FDCWD { StartFolder::Current } else { StartFolder::Held(first) };
            (change_named(thread, &start, second, folder, root)?, third)
        }
        // The only other call is `chmod`.
        _ => (change_named(thread, &StartFolder::Current, first, folder, root)?, second),
    };
    // The current name of the open file is checked, and then the mode of this open file is changed.
    let entry = format!("/proc/self/fd/{}", file.as_raw_fd());
    let target = std::fs::read_link(&entry).map_err(|_| libc::EPERM)?;
    if target == root || !target.starts_with(root) {
        return Err(libc::EPERM);
    }
    std::fs::set_permissions(&entry, Permissions::from_mode((mode & MODE_BITS) as u32))
        .map_err(|error| error.raw_os_error().unwrap_or(libc::EPERM))
}

/// The folder at which a relative path starts.
enum StartFolder {
    Current,
    Held(u64),
}

/// Returns the file that the thread has open as this descriptor. It is opened again by its current name.
fn reopen_descriptor(thread: u32, number: u64, folder: BorrowedFd<'_>, root: &Path) -> Result<OwnedFd, i32> {
    let target = std::fs::read_link(format!("/proc/{thread}/fd/{}", number as i32)).map_err(|_| libc::EBADF)?;
    open_beneath(&target, folder, root).map_err(|_| libc::EPERM)
}

/// Returns the file whose name is at `address` in the thread's memory. Links are not followed.
fn change_named(
    thread: u32,
    start: &StartFolder,
    address: u64,
    folder: BorrowedFd<'_>,
    root: &Path,
) -> Result<OwnedFd, i32> {
    let path = read_text(thread, address).ok_or(libc::EFAULT)?;
    let from = match start {
        StartFolder::Current => format!("/proc/{thread}/cwd"),
        StartFolder::Held(number) => format!("/proc/{thread}/fd/{}", *number as i32),
    };
    let from = std::fs::read_link(from).map_err(|_| libc::EBADF)?;
    open_beneath(&from.join(path), folder, root).map_err(|error| match error.raw_os_error() {
        Some(libc::ENOENT) => libc::ENOENT,
        _ => libc::EPERM,
    })
}

/// Returns the file at a path, if it is below the working folder. It is opened only as a reference (`O_PATH`). Links on
/// the path are not followed.
fn open_beneath(path: &Path, folder: BorrowedFd<'_>, root: &Path) -> io::Result<OwnedFd> {
    let inside = path.strip_prefix(root).map_err(io::Error::other)?;
    sys::open_beneath(folder, &CString::new(inside.as_os_str().as_bytes())?, OFlags::PATH)
}

/// Returns the zero-terminated text at `address` in the memory of the thread.
fn read_text(thread: u32, address: u64) -> Option<PathBuf> {
    let mut memory = File::open(format!("/proc/{thread}/mem")).ok()?;
    memory.seek(SeekFrom::Start(address)).ok()?;
    let mut text = Vec::new();
    // The text may end shortly before the memory does. A read can then fail after enough bytes were read.
    let _ = memory.take(libc::PATH_MAX as u64).read_to_end(&mut text);
    let end = text.iter().position(|&byte| byte == 0)?;
    text.truncate(end);
    Some(PathBuf::from(std::ffi::OsString::from(String::from_utf8(text).ok()?)))
}
