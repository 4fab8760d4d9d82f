//! Takes a file out of a working folder after the program's end.
//!
//! A hostile program leaves a link to a reference, a pipe, a device or a terabyte of holes where its output should be.
//! So the file is opened beneath the folder without following any link and without waiting, and judged by the open
//! descriptor: a regular file, with one name, within the limit. Call this only when every process is dead, which is
//! when [`Running::wait`](super::Running::wait) has returned.

use std::ffi::CString;
use std::fs::File;
use std::io::{self, Read};
use std::os::fd::AsFd;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{FileTypeExt, MetadataExt};
use std::path::Path;

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
    let shown = || name.escape_debug().to_string();
    let system = |source: io::Error| CollectError::System { name: shown(), source };
    let c_name = CString::new(Path::new(name).as_os_str().as_bytes()).map_err(|error| system(error.into()))?;
    let folder = File::open(folder).map_err(system)?;
    let file = match sys::open_beneath(folder.as_fd(), &c_name, libc::O_RDONLY | libc::O_NONBLOCK) {
        Ok(fd) => File::from(fd),
        Err(error) => {
            return Err(match error.raw_os_error() {
                Some(libc::ENOENT | libc::ENOTDIR) => CollectError::Missing { name: shown() },
                Some(libc::ELOOP) => CollectError::NotRegular { name: shown(), what: "a symbolic link" },
                Some(libc::EXDEV) => CollectError::NotRegular { name: shown(), what: "outside the folder" },
                Some(libc::ENXIO) => CollectError::NotRegular { name: shown(), what: "a socket" },
                _ => system(error),
            });
        }
    };
    let metadata = file.metadata().map_err(system)?;
    let kind = metadata.file_type();
    if !kind.is_file() {
        let what = match () {
            () if kind.is_dir() => "a folder",
            () if kind.is_fifo() => "a pipe",
            () if kind.is_socket() => "a socket",
            () => "a device",
        };
        return Err(CollectError::NotRegular { name: shown(), what });
    }
    if metadata.nlink() != 1 {
        return Err(CollectError::Linked { name: shown(), links: metadata.nlink() });
    }
    if metadata.len() > max_bytes {
        return Err(CollectError::TooLong { name: shown(), length: metadata.len(), limit: max_bytes });
    }
    Ok((file, metadata.len()))
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
