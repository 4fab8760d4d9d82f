//! Gives each running program its own user id, so that simultaneous programs cannot signal or read each other.
//!
//! Only root can become another user. The ids start at 61000, a range that no distribution uses. As long as the
//! supervisor is alive, it holds the id by a lock on a file that only root can open.

use std::{
    fs::{DirBuilder, File, OpenOptions},
    io,
    ops::Range,
    os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt},
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use super::processes;

/// The first user id. The ids that systemd uses begin at 61184.
const FIRST_USER: u32 = 61_000;
const USER_COUNT: u32 = 184;

/// A user id that is reserved until the value is dropped.
pub(super) struct UserSlot {
    pub(super) user: u32,
    _lock: File,
}

/// The maximum time to wait for an id. No run within its limits takes this long.
const MAX_WAIT: Duration = Duration::from_secs(3600);

/// Claims the first id that no run holds and that has no processes. If there is none, waits for one.
///
/// # Errors
///
/// Fails if no id becomes free for an hour, the grader has ended, or the folder of locks has another owner.
pub(super) fn claim_slot() -> io::Result<UserSlot> {
    claim_from_range(&lock_folder()?, FIRST_USER..FIRST_USER + USER_COUNT, MAX_WAIT)
}

/// Returns the id of a run whose supervisor was lost; `None` if another run has claimed it. In that case, no processes
/// of the lost run remained.
pub(super) fn reclaim_slot(user: u32) -> Option<UserSlot> {
    reclaim_in(&lock_folder().ok()?, user)
}

fn reclaim_in(folder: &Path, user: u32) -> Option<UserSlot> {
    let lock = OpenOptions::new().write(true).open(folder.join(user.to_string())).ok()?;
    lock.try_lock().is_ok().then_some(UserSlot { user, _lock: lock })
}

/// Claims an id in the range `users`. The locks are in `folder`.
fn claim_from_range(folder: &Path, users: Range<u32>, max_wait: Duration) -> io::Result<UserSlot> {
    const PAUSE: Duration = Duration::from_millis(20);
    let (start, grader) = (Instant::now(), std::os::unix::process::parent_id());
    loop {
        for user in users.clone() {
            let path = folder.join(user.to_string());
            let lock = OpenOptions::new().create(true).truncate(false).write(true).mode(0o600).open(path)?;
            if lock.try_lock().is_ok() && processes::find_by_user(user).is_empty() {
                return Ok(UserSlot { user, _lock: lock });
            }
        }
        if start.elapsed() >= max_wait || std::os::unix::process::parent_id() != grader {
            return Err(io::Error::other(format!("all {} user ids from {} on are in use", users.len(), users.start)));
        }
        std::thread::sleep(PAUSE);
    }
}

/// Returns the folder of the locks. It is created when it is first needed, in the first usual place that can be
/// written.
fn lock_folder() -> io::Result<PathBuf> {
    let mut problem = io::Error::other("neither /run nor /tmp exists");
    for base in ["/run", "/var/tmp", "/tmp"] {
        match lock_folder_in(Path::new(base)) {
            Ok(folder) => return Ok(folder),
            Err(error) => problem = error,
        }
    }
    Err(problem)
}

fn lock_folder_in(base: &Path) -> io::Result<PathBuf> {
    let folder = base.join("fosssim-oracle-users");
    match DirBuilder::new().mode(0o700).create(&folder) {
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
        _ => {}
    }
    let metadata = folder.symlink_metadata()?;
    if !metadata.is_dir() || metadata.uid() != 0 || metadata.mode() & 0o077 != 0 {
        return Err(io::Error::other(format!("{} must be a folder that only root can enter", folder.display())));
    }
    // An earlier container may have created the folder in a place that can no longer be written.
    OpenOptions::new().create(true).truncate(false).write(true).mode(0o600).open(folder.join("lock"))?;
    Ok(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_id_of_a_lost_run_is_not_taken_from_whoever_has_it_by_now() {
        let folder = tempfile::tempdir().unwrap();
        const NOBODY: u32 = 4_000_000_000;
        assert!(reclaim_in(folder.path(), NOBODY).is_none());
        let next = claim_from_range(folder.path(), NOBODY..NOBODY + 1, Duration::ZERO).unwrap();
        assert!(reclaim_in(folder.path(), NOBODY).is_none());
        drop(next);
        assert_eq!(reclaim_in(folder.path(), NOBODY).unwrap().user, NOBODY);
    }

    #[test]
    fn with_every_id_taken_a_run_waits_for_one() {
        let folder = tempfile::tempdir().unwrap();
        // No user has this id.
        let take = |max_wait| claim_from_range(folder.path(), 4_000_000_000..4_000_000_001, max_wait);
        let first = take(Duration::ZERO).unwrap();
        assert!(take(Duration::ZERO).is_err(), "it is held");
        std::thread::scope(|scope| {
            let second = scope.spawn(|| take(MAX_WAIT).map(|slot| slot.user));
            drop(first);
            assert_eq!(second.join().unwrap().unwrap(), 4_000_000_000);
        });
    }
}
