//! Writes files so that they appear only when they are complete. They are written under another name in the same
//! folder, and then renamed.
use super::folder::{Folder, check_single_component};
use rustix::{
    fs::{AtFlags, Mode, OFlags, openat, renameat, unlinkat},
    io::Errno,
};
use std::{
    ffi::{OsStr, OsString},
    fs::{File, Permissions},
    io::{self, IoSlice, Write},
    os::unix::fs::PermissionsExt,
    path::PathBuf,
    process,
    sync::atomic::{AtomicU64, Ordering},
    time::{SystemTime, UNIX_EPOCH},
};

/// The prefix of the names of unfinished files.
pub const UNFINISHED_PREFIX: &str = ".fosssim-oracle-";

/// The maximum number of names that are tried for an unfinished file.
const MAX_TRIES: u32 = 100;

/// A file that is being written. [`Replacement::finish`] gives the file its final name. If it is not called, the file
/// is removed.
#[derive(Debug)]
pub struct Replacement {
    folder: Folder,
    file: File,
    unfinished_name: OsString,
    name: OsString,
    is_finished: bool,
}

impl Replacement {
    pub(crate) fn new(folder: Folder, name: &OsStr, mode: Option<u32>) -> io::Result<Self> {
        static FILE_COUNT: AtomicU64 = AtomicU64::new(0);
        let flags = OFlags::RDWR | OFlags::CREATE | OFlags::EXCL | OFlags::NOFOLLOW | OFlags::CLOEXEC;
        let mut problem = Errno::EXIST;
        for _ in 0..MAX_TRIES {
            let count = FILE_COUNT.fetch_add(1, Ordering::Relaxed);
            let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.subsec_nanos());
            let unfinished = OsString::from(format!("{UNFINISHED_PREFIX}{:x}-{count:x}-{now:x}", process::id()));
            match openat(&folder, &unfinished, flags, Mode::from_raw_mode(mode.unwrap_or(0o666))) {
                Ok(fd) => {
                    let replacement = Self {
                        folder,
                        file: fd.into(),
                        unfinished_name: unfinished,
                        name: name.to_owned(),
                        is_finished: false,
                    };
                    if let Some(mode) = mode {
                        // The process's mask limits the permission bits of a new file. If the file replaces another
                        // one, it must have the same bits.
                        replacement.file.set_permissions(Permissions::from_mode(mode))?;
                    }
                    return Ok(replacement);
                }
                Err(Errno::EXIST) => {}
                Err(error) => {
                    problem = error;
                    break;
                }
            }
        }
        Err(problem.into())
    }

    /// Returns the path of the unfinished file. It begins with the path by which the folder was opened.
    pub fn unfinished_path(&self) -> PathBuf {
        self.folder.given_path().join(&self.unfinished_name)
    }

    /// Returns the path that the file has when it is finished.
    pub fn target(&self) -> PathBuf {
        self.folder.given_path().join(&self.name)
    }

    /// Renames the temporary file to its final name. A file or a link with that name is replaced. If it is a link, the
    /// file to which it leads does not change.
    ///
    /// # Errors
    /// Fails if the file cannot be renamed. An existing file with that name is then unchanged.
    pub fn finish(mut self) -> io::Result<()> {
        self.file.flush()?;
        renameat(&self.folder, &self.unfinished_name, &self.folder, &self.name)?;
        self.is_finished = true;
        Ok(())
    }

    /// Finishes as [`Replacement::finish`] does, and returns the open file.
    ///
    /// # Errors
    /// Fails like [`Replacement::finish`].
    pub fn finish_open(self) -> io::Result<File> {
        let file = self.file.try_clone()?;
        self.finish()?;
        Ok(file)
    }
}

impl Folder {
    /// Begins a file that gets the name `name` when it is finished. Any entry with that name is then replaced.
    ///
    /// # Errors
    /// Fails if no file can be created in the folder.
    pub fn replacement(&self, name: &OsStr, mode: Option<u32>) -> io::Result<Replacement> {
        Replacement::new(self.clone(), check_single_component(name)?, mode)
    }

    /// Writes a file in the folder. It appears only when it is complete. A file with the same name is replaced, and no
    /// link is followed.
    ///
    /// # Errors
    /// Fails if the file cannot be written.
    pub fn write(&self, name: &OsStr, bytes: &[u8]) -> io::Result<()> {
        let mut file = self.replacement(name, None)?;
        file.write_all(bytes)?;
        file.finish()
    }
}

impl Drop for Replacement {
    fn drop(&mut self) {
        if !self.is_finished {
            // If the file cannot be removed, a hidden file remains, which does no harm.
            let _ = unlinkat(&self.folder, &self.unfinished_name, AtFlags::empty());
        }
    }
}

impl Write for Replacement {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn write_vectored(&mut self, parts: &[IoSlice<'_>]) -> io::Result<usize> {
        self.file.write_vectored(parts)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}
