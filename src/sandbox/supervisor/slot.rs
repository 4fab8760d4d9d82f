//! One user id per running program, so that programs that run side by side cannot signal or read each other.
//!
//! Only root can become another user. The ids are 61000 and up, a range that no distribution hands out; each is held by
//! a lock on a file that only root can reach, for as long as the supervisor lives.

use std::fs::{DirBuilder, File, OpenOptions};
use std::io;
use std::os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt};
use std::path::PathBuf;

use super::processes;

/// The first id and how many there are (systemd hands out ids from 61184 on).
const FIRST: u32 = 61_000;
const COUNT: u32 = 184;

/// A user id that is ours until this is dropped.
pub(super) struct Slot {
    pub(super) user: u32,
    _lock: File,
}

/// Takes the first id that nobody holds and that no process runs under.
///
/// # Errors
///
/// When all are taken, or the folder of locks belongs to somebody else.
pub(super) fn take() -> io::Result<Slot> {
    let folder = folder()?;
    for user in FIRST..FIRST + COUNT {
        let path = folder.join(user.to_string());
        let lock = OpenOptions::new().create(true).truncate(false).write(true).mode(0o600).open(path)?;
        if lock.try_lock().is_ok() && processes::of_user(user).is_empty() {
            return Ok(Slot { user, _lock: lock });
        }
    }
    Err(io::Error::other(format!("all {COUNT} user ids from {FIRST} on are in use")))
}

/// The folder of the locks, made on first use.
fn folder() -> io::Result<PathBuf> {
    let base = ["/run", "/var/tmp", "/tmp"].into_iter().map(PathBuf::from).find(|base| base.is_dir());
    let folder = base.ok_or_else(|| io::Error::other("there is neither /run nor /tmp"))?.join("fosssim-oracle-users");
    match DirBuilder::new().mode(0o700).create(&folder) {
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
        _ => {}
    }
    let metadata = folder.symlink_metadata()?;
    if !metadata.is_dir() || metadata.uid() != 0 || metadata.mode() & 0o077 != 0 {
        return Err(io::Error::other(format!("{} must be a folder that only root can enter", folder.display())));
    }
    Ok(folder)
}
