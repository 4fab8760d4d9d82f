//! Which workers of this machine are alive, by locks that the kernel drops with the process that holds them. So a
//! server that was killed and started again goes on at once, and waits for no lease.
use std::{
    fs::{self, File, TryLockError},
    io,
    path::{Path, PathBuf},
};

/// A sign of life: a locked file in a folder that all workers of one data folder share.
#[derive(Debug)]
pub struct Liveness {
    path: PathBuf,
    _lock: File,
}

impl Liveness {
    /// Begins to be alive under a name that nobody else has.
    ///
    /// # Errors
    /// When the folder can't be written, or somebody of this name is alive.
    pub fn begin(folder: &Path, worker: &str) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let path = folder.join(worker);
        // Locked before it shows: somebody who found it in between would take its owner for dead.
        let unseen = folder.join(format!(".{worker}"));
        let lock = File::options().create(true).truncate(false).write(true).open(&unseen)?;
        lock.try_lock().map_err(|error| match error {
            TryLockError::Error(error) => error,
            TryLockError::WouldBlock => io::Error::new(io::ErrorKind::AddrInUse, "a worker of this name is starting"),
        })?;
        if path.exists() {
            fs::remove_file(&unseen)?;
            return Err(io::Error::new(io::ErrorKind::AddrInUse, format!("a worker called {worker} is or was here")));
        }
        fs::rename(&unseen, &path)?;
        Ok(Self { path, _lock: lock })
    }
}

impl Drop for Liveness {
    fn drop(&mut self) {
        // Anybody who ends in peace has given its jobs back.
        drop(fs::remove_file(&self.path));
    }
}

/// The workers that died without a word. Call [`forget`] for each when their jobs have been taken care of.
///
/// # Errors
/// When the folder can't be read.
pub fn dead_workers(folder: &Path) -> io::Result<Vec<String>> {
    let mut dead = Vec::new();
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(dead),
        entries => entries?,
    };
    for entry in entries {
        let entry = entry?;
        let Some(name) = entry.file_name().into_string().ok().filter(|name| !name.starts_with('.')) else { continue };
        // One that ends in peace at this moment is gone by itself.
        let Ok(file) = File::options().write(true).open(entry.path()) else { continue };
        if file.try_lock().is_ok() {
            dead.push(name);
        }
    }
    dead.sort();
    Ok(dead)
}

/// Removes the sign of a dead worker.
pub fn forget(folder: &Path, worker: &str) {
    drop(fs::remove_file(folder.join(worker)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dead_are_told_from_the_living() {
        let folder = tempfile::tempdir().expect("a folder");
        let alive = Liveness::begin(folder.path(), "alive").expect("a sign");
        assert!(Liveness::begin(folder.path(), "alive").is_err(), "one name, one worker");
        File::create(folder.path().join("dead")).expect("what a killed process leaves");
        assert_eq!(dead_workers(folder.path()).expect("a list"), ["dead"]);
        forget(folder.path(), "dead");
        drop(alive);
        assert!(dead_workers(folder.path()).expect("a list").is_empty());
    }
}
