//! Files that appear whole: written next to their place under another name, and renamed.
use super::folder::{Folder, single};
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

/// The beginning of unfinished files' names.
pub const UNFINISHED: &str = ".fosssim-oracle-";

/// Names of unfinished files that are tried.
const TRIES: u32 = 100;

/// A file that is being written. It gets its name with [`Replacement::finish`], and is removed without.
#[derive(Debug)]
pub struct Replacement {
    folder: Folder,
    file: File,
    unfinished: OsString,
    name: OsString,
    finished: bool,
}

impl Replacement {
    pub(crate) fn new(folder: Folder, name: &OsStr, mode: Option<u32>) -> io::Result<Self> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let flags = OFlags::RDWR | OFlags::CREATE | OFlags::EXCL | OFlags::NOFOLLOW | OFlags::CLOEXEC;
        let mut problem = Errno::EXIST;
        for _ in 0..TRIES {
            let count = COUNT.fetch_add(1, Ordering::Relaxed);
            let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.subsec_nanos());
            let unfinished = OsString::from(format!("{UNFINISHED}{:x}-{count:x}-{now:x}", process::id()));
            match openat(&folder, &unfinished, flags, Mode::from_raw_mode(mode.unwrap_or(0o666))) {
                Ok(fd) => {
                    let made = Self { folder, file: fd.into(), unfinished, name: name.to_owned(), finished: false };
                    if let Some(mode) = mode {
                        // The mode of a new file loses what the mask forbids; the mode of a replaced one must stay.
                        made.file.set_permissions(Permissions::from_mode(mode))?;
                    }
                    return Ok(made);
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

    /// Returns the place of the bytes before the file is finished, with the folder's path from when it was opened.
    #[must_use]
    pub fn unfinished_path(&self) -> PathBuf {
        self.folder.given_path().join(&self.unfinished)
    }

    /// Returns where the file will be.
    #[must_use]
    pub fn target(&self) -> PathBuf {
        self.folder.given_path().join(&self.name)
    }

    /// Lets the file appear under its name. A file of that name is replaced; a link is, too, and not the file to which
    /// it leads.
    ///
    /// # Errors
    /// When it can't be renamed; a file of that name is then as it was.
    pub fn finish(mut self) -> io::Result<()> {
        self.file.flush()?;
        renameat(&self.folder, &self.unfinished, &self.folder, &self.name)?;
        self.finished = true;
        Ok(())
    }

    /// Finishes as [`Replacement::finish`] does, and returns the open file.
    ///
    /// # Errors
    /// As for [`Replacement::finish`].
    pub fn finish_open(self) -> io::Result<File> {
        let file = self.file.try_clone()?;
        self.finish()?;
        Ok(file)
    }
}

impl Folder {
    /// Returns a file that will take this name when it is finished, whatever has the name by then.
    ///
    /// # Errors
    /// When no file can be made here.
    pub fn replacement(&self, name: &OsStr, mode: Option<u32>) -> io::Result<Replacement> {
        Replacement::new(self.clone(), single(name)?, mode)
    }

    /// Writes a whole file by rename: it appears with all its bytes or not at all. A file of that name is replaced, and
    /// no link is followed.
    ///
    /// # Errors
    /// When it can't be written.
    pub fn write(&self, name: &OsStr, bytes: &[u8]) -> io::Result<()> {
        let mut file = self.replacement(name, None)?;
        file.write_all(bytes)?;
        file.finish()
    }
}

impl Drop for Replacement {
    fn drop(&mut self) {
        if !self.finished {
            // A file that stays behind is hidden and useless.
            let _ = unlinkat(&self.folder, &self.unfinished, AtFlags::empty());
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
