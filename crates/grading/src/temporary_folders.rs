//! Manages the grader's temporary folders, which no other user can read, and removes those of killed graders.
//!
//! All temporary folders of a grader are in one folder. A locked file in it shows that the grader is alive. Unlike
//! process IDs, locks also work across containers.
use fosssim_sandbox::collect;
use std::{
    fs::{self, File, Permissions},
    io,
    os::unix::fs::{MetadataExt, OpenOptionsExt, PermissionsExt},
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError, Weak},
    time::Duration,
};

/// The prefix of the names of the folders of graders.
const FOLDER_PREFIX: &str = "fosssim-grader-";
/// The name of the file that a grader keeps locked while it is alive.
const LOCK_FILE: &str = "lock";
/// A temporary folder of this grader that others cannot read. When it is dropped, the folder is removed with everything
/// that programs left in it.
#[derive(Debug)]
pub(super) struct TemporaryFolder {
    path: PathBuf,
    // The grader's folder is kept until all folders in it are removed.
    _grader: Arc<GraderFolder>,
}

impl TemporaryFolder {
    /// Creates a folder whose name begins with `purpose`.
    pub(super) fn create(purpose: &str) -> io::Result<Self> {
        let grader = GraderFolder::current()?;
        let folder = create_private(&format!("{purpose}-"), &grader.path)?;
        let path = folder.keep();
        if purpose == "build" && is_root() {
            // Build tools use whole paths and run as another user, so the folder must be accessible. The entries in it
            // have restrictive permissions.
            fs::set_permissions(&path, Permissions::from_mode(0o711))?;
        }
        Ok(Self { path, _grader: grader })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        // If a folder can't be removed now, a later sweep removes it.
        drop(collect::remove_folder(&self.path));
    }
}

/// Working folders that no program has changed. They are kept for further runs, because on some file systems creating a
/// folder takes as long as a small run.
#[derive(Debug, Default)]
pub struct Folders(Mutex<Vec<TemporaryFolder>>);

impl Folders {
    /// Returns a [kept](Self::keep_folder) folder, which contains only files of the grader, or a new one.
    pub(super) fn take_folder(&self) -> io::Result<TemporaryFolder> {
        let kept_folder = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop();
        kept_folder.map_or_else(|| TemporaryFolder::create("run"), Ok)
    }

    /// Keeps a folder that only the grader has changed, for further runs.
    pub(super) fn keep_folder(&self, folder: TemporaryFolder) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(folder);
    }
}

/// The folder that contains all temporary folders of this process. It exists as long as there is one.
#[derive(Debug)]
struct GraderFolder {
    path: PathBuf,
    _lock: File,
}

impl GraderFolder {
    /// Returns the folder of this process. It is created if it does not exist.
    fn current() -> io::Result<Arc<Self>> {
        static CURRENT_GRADER: Mutex<Weak<GraderFolder>> = Mutex::new(Weak::new());
        let mut this = CURRENT_GRADER.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(grader) = this.upgrade().filter(|grader| grader.path.is_dir()) {
            return Ok(grader);
        }
        let grader = Arc::new(Self::create(&std::env::temp_dir())?);
        *this = Arc::downgrade(&grader);
        Ok(grader)
    }

    fn create(parent: &Path) -> io::Result<Self> {
        const MAX_TRIES: u32 = 10;
        let mut problem = io::Error::other("another process removes every new folder there");
        for _ in 0..MAX_TRIES {
            let path = create_private(FOLDER_PREFIX, parent)?.keep();
            let lock = path.join(LOCK_FILE);
            let lock_file = File::options().write(true).create_new(true).mode(0o600).open(&lock).and_then(|file| {
                file.try_lock().map_err(io::Error::from)?;
                // Another grader's sweep may have removed the folder before it was locked.
                let (locked_file, current_file) = (file.metadata()?, fs::metadata(&lock)?);
                if (locked_file.dev(), locked_file.ino()) == (current_file.dev(), current_file.ino()) {
                    Ok(file)
                } else {
                    Err(io::ErrorKind::NotFound.into())
                }
            });
            match lock_file {
                Ok(lock) => {
                    if is_root() {
                        // Programs run as other users. They must be able to reach their own folders, but must not list
                        // this one.
                        fs::set_permissions(&path, Permissions::from_mode(0o711))?;
                    }
                    return Ok(Self { path, _lock: lock });
                }
                Err(error) => problem = error,
            }
            drop(fs::remove_dir_all(&path));
        }
        Err(problem)
    }
}

impl Drop for GraderFolder {
    fn drop(&mut self) {
        drop(collect::remove_folder(&self.path));
    }
}

/// Creates a new folder that only its owner can enter.
fn create_private(prefix: &str, parent: &Path) -> io::Result<tempfile::TempDir> {
    tempfile::Builder::new().prefix(prefix).permissions(Permissions::from_mode(0o700)).tempdir_in(parent)
}

fn is_root() -> bool {
    fs::metadata("/proc/self").is_ok_and(|own| own.uid() == 0)
}

/// Removes the temporary folders of killed graders. A grader that is alive holds its lock, even in another container.
pub fn remove_abandoned() {
    remove_abandoned_in(&std::env::temp_dir());
}

fn remove_abandoned_in(parent: &Path) {
    let Ok(own) = fs::metadata("/proc/self") else { return };
    for entry in fs::read_dir(parent).into_iter().flatten().flatten() {
        let path = entry.path();
        let ours = entry.file_name().to_str().is_some_and(|name| name.starts_with(FOLDER_PREFIX));
        // The entry itself is checked, not the target of a link. Folders of other users are left to these users.
        if !ours || !entry.metadata().is_ok_and(|data| data.is_dir() && data.uid() == own.uid()) {
            continue;
        }
        match collect::open_file(&path.join(LOCK_FILE), false) {
            Ok((lock, _)) if lock.try_lock().is_ok() => remove_folder_of(&path),
            // The grader was killed before it created the lock, or it is about to create it; in that case it will use
            // another folder. A folder that is not empty is kept.
            Err(collect::CollectError::Missing { .. }) => drop(fs::remove_dir(&path)),
            _ => {}
        }
    }
}

/// Removes a grader's folder. The lock is removed last, because a folder without a lock counts as new. A supervisor may
/// still use the folder shortly after its grader has ended.
fn remove_folder_of(path: &Path) {
    const MAX_TRIES: u32 = 20;
    const PAUSE: Duration = Duration::from_millis(50);
    for _ in 0..MAX_TRIES {
        let folders = fs::read_dir(path).into_iter().flatten().flatten().filter(|entry| entry.path().is_dir());
        let removed = folders.map(|entry| collect::remove_folder(&entry.path())).filter(Result::is_err).count() == 0;
        if removed && collect::remove_folder(path).is_ok() {
            return;
        }
        std::thread::sleep(PAUSE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_nobody_holds_is_swept_away() {
        let place = tempfile::tempdir().unwrap();
        let living = GraderFolder::create(place.path()).unwrap();
        let killed = GraderFolder::create(place.path()).unwrap();
        let left = killed.path.clone();
        fs::create_dir_all(left.join("run-1").join("d/".repeat(1500))).unwrap();
        fs::write(living.path.join("program"), "x").unwrap();
        // This is the state after a kill: the lock is released, but the folder remains.
        let GraderFolder { path: _, _lock: ref lock } = killed;
        lock.unlock().unwrap();
        std::mem::forget(killed);
        let at = |name: &str| place.path().join(name);
        fs::create_dir(at("fosssim-grader-begun")).unwrap();
        fs::create_dir_all(at("fosssim-grader-strange/kept")).unwrap();
        fs::create_dir(at("other")).unwrap();
        std::os::unix::fs::symlink(at("other"), at("fosssim-grader-link")).unwrap();
        remove_abandoned_in(place.path());
        assert!(!left.exists(), "removed at any depth");
        assert!(living.path.join("program").exists(), "in use");
        assert!(!at("fosssim-grader-begun").exists(), "killed before it had a lock");
        assert!(at("fosssim-grader-strange/kept").exists() && at("other").exists());
        assert!(at("fosssim-grader-link").is_symlink());
    }

    #[test]
    fn a_grader_that_loses_its_new_folder_takes_another() {
        const ROUNDS: u32 = 200;
        let place = tempfile::tempdir().unwrap();
        let done = std::sync::atomic::AtomicBool::new(false);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                while !done.load(std::sync::atomic::Ordering::Relaxed) {
                    remove_abandoned_in(place.path());
                }
            });
            for _ in 0..ROUNDS {
                let grader = GraderFolder::create(place.path()).unwrap();
                assert!(grader.path.join(LOCK_FILE).exists());
            }
            done.store(true, std::sync::atomic::Ordering::Relaxed);
        });
    }

    #[test]
    fn a_folder_that_was_kept_is_taken_again_and_goes_with_the_others() {
        let folders = Folders::default();
        let first = folders.take_folder().unwrap();
        let path = first.path().to_path_buf();
        let second = folders.take_folder().unwrap();
        assert_ne!(second.path(), path);
        folders.keep_folder(first);
        assert_eq!(folders.take_folder().unwrap().path(), path);
        folders.keep_folder(second);
        drop(folders);
        assert!(!path.exists());
    }

    #[test]
    fn folders_are_closed_to_others_and_go_away_with_their_last_user() {
        let first = TemporaryFolder::create("program").unwrap();
        let second = TemporaryFolder::create("run").unwrap();
        let grader = first.path().parent().unwrap().to_path_buf();
        assert_eq!(second.path().parent(), Some(&*grader));
        for path in [first.path(), second.path()] {
            assert_eq!(fs::metadata(path).unwrap().permissions().mode() & 0o077, 0);
        }
        assert_eq!(fs::metadata(&grader).unwrap().permissions().mode() & 0o066, 0, "no names are shown");
        let path = first.path().to_path_buf();
        drop(first);
        assert!(!path.exists() && grader.exists());
    }
}
