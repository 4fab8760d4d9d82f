//! Takes a file out of a working folder after the program's end.
//!
//! A hostile program leaves a link to a reference, a pipe, a device or a terabyte of holes where its output should be.
//! So the file is opened beneath the folder without following any link and without waiting, and judged by the open
//! descriptor: a regular file, with one name, within the limit. Call this only when every process is dead, which is
//! when [`Running::wait`](super::Running::wait) has returned.

use std::ffi::{CString, OsStr, OsString};
use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::os::fd::{AsFd, AsRawFd, OwnedFd};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{FileTypeExt, MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};

use super::supervisor::open_up;
use super::sys;

/// Why a file was not taken. Except for [`CollectError::System`] these are the program's doing.
#[derive(Debug, thiserror::Error)]
pub enum CollectError {
    /// Nothing lies there.
    #[error("there is no file {name}")]
    Missing {
        /// The file's name, escaped.
        name: String,
    },
    /// Something else lies there.
    #[error("{name} is {what}, not a regular file")]
    NotRegular {
        /// The file's name, escaped.
        name: String,
        /// What it is instead.
        what: &'static str,
    },
    /// The file has further names, perhaps outside the folder.
    #[error("{name} is a hard link: the file has {links} names")]
    Linked {
        /// The file's name, escaped.
        name: String,
        /// How many names it has.
        links: u64,
    },
    /// The file is too long.
    #[error("{name} is {length} bytes long, the limit is {limit}")]
    TooLong {
        /// The file's name, escaped.
        name: String,
        /// Its length in bytes.
        length: u64,
        /// The limit in bytes.
        limit: u64,
    },
    /// The folder or the file cannot be read.
    #[error("cannot read {name}: {source}")]
    System {
        /// The file's name, escaped.
        name: String,
        /// The system's reason.
        source: io::Error,
    },
}

/// Opens the regular file at `path` once, without waiting, and says how long it is. A link at its end is followed only
/// when `follow` says so; how many names the file has does not matter.
///
/// # Errors
///
/// When it is missing, not a regular file, or closed to us.
pub fn open_file(path: &Path, follow: bool) -> Result<(File, u64), CollectError> {
    let shown = || path.to_string_lossy().escape_debug().to_string();
    let no_link = if follow { 0 } else { libc::O_NOFOLLOW };
    let file = File::options().read(true).custom_flags(libc::O_NONBLOCK | no_link).open(path);
    let file = file.map_err(|error| not_opened(shown(), error))?;
    let length = regular(&file, shown)?.len();
    Ok((file, length))
}

/// A folder that is held open. What lies in it is reached by its own names only: no link leads out, and nobody who
/// exchanges a path meanwhile leads elsewhere.
#[derive(Debug)]
pub struct OpenFolder(File);

/// What lies in an [`OpenFolder`].
#[derive(Debug)]
pub enum FolderEntry {
    /// A regular file, open.
    File(File),
    /// A folder, open.
    Folder(OpenFolder),
    /// Neither: a link, a pipe, a socket or a device.
    Other,
}

impl From<OwnedFd> for OpenFolder {
    fn from(folder: OwnedFd) -> Self {
        Self(folder.into())
    }
}

impl OpenFolder {
    /// Opens the folder at the path.
    ///
    /// # Errors
    ///
    /// When there is none or it is closed to us.
    pub fn open(path: &Path) -> io::Result<Self> {
        File::options().read(true).custom_flags(libc::O_DIRECTORY | libc::O_NONBLOCK).open(path).map(Self)
    }

    /// The names of what lies in it.
    ///
    /// # Errors
    ///
    /// When it can't be read.
    pub fn names(&self) -> io::Result<Vec<OsString>> {
        std::fs::read_dir(self.path())?.map(|entry| entry.map(|entry| entry.file_name())).collect()
    }

    /// What lies under this name, opened once.
    ///
    /// # Errors
    ///
    /// When it can't be opened; [`io::ErrorKind::NotFound`] when it has gone.
    pub fn entry(&self, name: &OsStr) -> io::Result<FolderEntry> {
        let name = CString::new(name.as_bytes())?;
        let file = match sys::open_beneath(self.0.as_fd(), &name, libc::O_RDONLY | libc::O_NONBLOCK) {
            Ok(fd) => File::from(fd),
            Err(error) if matches!(error.raw_os_error(), Some(libc::ELOOP | libc::ENXIO | libc::ENODEV)) => {
                return Ok(FolderEntry::Other);
            }
            Err(error) => return Err(error),
        };
        let kind = file.metadata()?.file_type();
        Ok(match () {
            () if kind.is_file() => FolderEntry::File(file),
            () if kind.is_dir() => FolderEntry::Folder(Self(file)),
            () => FolderEntry::Other,
        })
    }

    /// The regular file `name` (which may contain `/`, but leads out of nowhere), open, with its length in bytes.
    ///
    /// # Errors
    ///
    /// When it is missing, not a regular file, reached through a link, has a second name, or is longer than
    /// `max_bytes`.
    pub fn regular_file(&self, name: &str, max_bytes: u64) -> Result<(File, u64), CollectError> {
        let shown = || name.escape_debug().to_string();
        let system = |source: io::Error| CollectError::System { name: shown(), source };
        let c_name = CString::new(name).map_err(|error| system(error.into()))?;
        let file = match sys::open_beneath(self.0.as_fd(), &c_name, libc::O_RDONLY | libc::O_NONBLOCK) {
            Ok(fd) => File::from(fd),
            Err(error) => return Err(not_opened(shown(), error)),
        };
        let metadata = regular(&file, shown)?;
        if metadata.nlink() != 1 {
            return Err(CollectError::Linked { name: shown(), links: metadata.nlink() });
        }
        if metadata.len() > max_bytes {
            return Err(CollectError::TooLong { name: shown(), length: metadata.len(), limit: max_bytes });
        }
        Ok((file, metadata.len()))
    }

    /// A path that leads to this very folder as long as it is open, wherever it lies by now.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        PathBuf::from(format!("/proc/self/fd/{}", self.0.as_raw_fd()))
    }
}

/// Removes a folder with all that a program left in it: folders that are closed to their owner, and folders nested
/// deeper than descriptors suffice. Only called while no process of the program is alive.
///
/// # Errors
///
/// When something can't be removed. A folder that is not there is removed.
pub fn remove_folder(path: &Path) -> io::Result<()> {
    let gone = |error: io::Error| if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) };
    if std::fs::remove_dir_all(path).or_else(gone).is_ok() {
        return Ok(());
    }
    // In a folder that others may write to, a link could lie there by now.
    open_up(File::options().read(true).custom_flags(libc::O_DIRECTORY | libc::O_NOFOLLOW).open(path)?.as_fd());
    std::fs::remove_dir_all(path).or_else(gone)
}

/// The contents of the file `name` (which may contain `/`, but leads out of nowhere) in `folder`.
///
/// # Errors
///
/// When it is missing, not a regular file, reached through a link, has a second name, or is longer than `max_bytes`.
pub fn regular_file(folder: &Path, name: &str, max_bytes: u64) -> Result<Vec<u8>, CollectError> {
    let (file, length) = open_regular_file(folder, name, max_bytes)?;
    let mut bytes = Vec::with_capacity(usize::try_from(length).unwrap_or(0));
    // The length was checked; the bound holds even if the file grew since.
    file.take(max_bytes)
        .read_to_end(&mut bytes)
        .map_err(|source| CollectError::System { name: name.escape_debug().to_string(), source })?;
    Ok(bytes)
}

/// As [`regular_file`], but open, with its length in bytes: for files that are better read in pieces.
///
/// # Errors
///
/// As [`regular_file`].
pub fn open_regular_file(folder: &Path, name: &str, max_bytes: u64) -> Result<(File, u64), CollectError> {
    let folder = OpenFolder::open(folder)
        .map_err(|source| CollectError::System { name: name.escape_debug().to_string(), source })?;
    folder.regular_file(name, max_bytes)
}

/// Why a file could not be opened.
fn not_opened(name: String, error: io::Error) -> CollectError {
    match error.raw_os_error() {
        Some(libc::ENOENT | libc::ENOTDIR) => CollectError::Missing { name },
        Some(libc::ELOOP) => CollectError::NotRegular { name, what: "a symbolic link" },
        Some(libc::EXDEV) => CollectError::NotRegular { name, what: "outside the folder" },
        Some(libc::ENXIO) => CollectError::NotRegular { name, what: "a socket" },
        _ => CollectError::System { name, source: error },
    }
}

/// The facts of an open file, which must be a regular one.
fn regular(file: &File, shown: impl Fn() -> String) -> Result<Metadata, CollectError> {
    let metadata = file.metadata().map_err(|source| CollectError::System { name: shown(), source })?;
    let kind = metadata.file_type();
    if kind.is_file() {
        return Ok(metadata);
    }
    let what = match () {
        () if kind.is_dir() => "a folder",
        () if kind.is_fifo() => "a pipe",
        () if kind.is_socket() => "a socket",
        () => "a device",
    };
    Err(CollectError::NotRegular { name: shown(), what })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn problem(folder: &Path, name: &str) -> String {
        regular_file(folder, name, 1000).unwrap_err().to_string()
    }

    #[test]
    fn a_plain_file_is_taken_whole() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("trace.bin"), vec![7; 1000]).unwrap();
        assert_eq!(regular_file(folder.path(), "trace.bin", 1000).unwrap(), vec![7; 1000]);
        assert!(regular_file(folder.path(), "trace.bin", 999).unwrap_err().to_string().contains("the limit is 999"));
        std::fs::create_dir(folder.path().join("out")).unwrap();
        std::fs::write(folder.path().join("out/trace.bin"), b"deep").unwrap();
        assert_eq!(regular_file(folder.path(), "out/trace.bin", 4).unwrap(), b"deep");
    }

    #[test]
    fn whatever_else_a_program_leaves_is_refused_by_name() {
        let outside = tempfile::tempdir().unwrap();
        let secret = outside.path().join("reference.bin");
        std::fs::write(&secret, b"secret").unwrap();
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::os::unix::fs::symlink(&secret, at("link")).unwrap();
        std::os::unix::fs::symlink(outside.path(), at("way")).unwrap();
        std::fs::hard_link(&secret, at("hard")).unwrap();
        std::fs::create_dir(at("folder")).unwrap();
        std::fs::File::create(at("sparse")).unwrap().set_len(1 << 40).unwrap();
        let _socket = std::os::unix::net::UnixListener::bind(at("socket")).unwrap();
        sys::make_fifo(File::open(folder.path()).unwrap().as_fd(), c"fifo").unwrap();
        for (name, expected) in [
            ("link", "a symbolic link"),
            ("way/reference.bin", "a symbolic link"),
            ("hard", "2 names"),
            ("folder", "a folder"),
            ("sparse", "the limit is 1000"),
            ("socket", "a socket"),
            ("fifo", "a pipe"),
            ("none", "no file none"),
            ("new\nline", "no file new\\nline"),
            ("../reference.bin", "outside the folder"),
            (&secret.display().to_string(), "outside the folder"),
        ] {
            let problem = problem(folder.path(), name);
            assert!(problem.contains(expected), "{name}: {problem}");
        }
    }
}
