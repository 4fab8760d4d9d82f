//! The reason why a file was rejected.
use std::{
    ffi::OsStr,
    fs::{File, Metadata},
    io,
    os::unix::fs::FileTypeExt,
};

/// The reason why a file was rejected. All of them except [`FileError::System`] are caused by the person who filled the
/// folder.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The file does not exist.
    #[error("the file {name} does not exist")]
    Missing {
        /// The file's name, escaped.
        name: String,
    },
    /// The name is that of a folder, link or device.
    #[error("{name} is {what}, not a regular file")]
    NotRegular {
        /// The file's name, escaped.
        name: String,
        /// The kind of entry that was found instead.
        what: &'static str,
    },
    /// The file has several names, possibly outside the folder.
    #[error("{name} is a hard link: the file has {links} names")]
    Linked {
        /// The file's name, escaped.
        name: String,
        /// The number of the file's names.
        links: u64,
    },
    /// The file is too long.
    #[error("{name} is {length} bytes long, the limit is {limit}")]
    TooLong {
        /// The file's name, escaped.
        name: String,
        /// The file's length in bytes.
        length: u64,
        /// The limit in bytes.
        limit: u64,
    },
    /// The folder or the file cannot be read.
    #[error("cannot read {name}: {source}")]
    System {
        /// The file's name, escaped.
        name: String,
        /// The error of the operating system.
        source: io::Error,
    },
}

impl FileError {
    /// Converts the operating system's error from opening a file.
    pub(crate) fn not_opened(name: String, error: io::Error) -> Self {
        match error.raw_os_error() {
            Some(libc::ENOENT | libc::ENOTDIR) => Self::Missing { name },
            Some(libc::ELOOP) => Self::NotRegular { name, what: "a symbolic link" },
            Some(libc::EXDEV) => Self::NotRegular { name, what: "outside the folder" },
            Some(libc::ENXIO) => Self::NotRegular { name, what: "a socket" },
            Some(libc::EISDIR) => Self::NotRegular { name, what: "a folder" },
            _ => Self::System { name, source: error },
        }
    }
}

/// Returns a name escaped for messages.
pub(crate) fn escape(name: &OsStr) -> String {
    name.to_string_lossy().escape_debug().to_string()
}

/// Returns the metadata of an open file, and checks that it is a regular file.
pub(crate) fn require_regular_file(file: &File, shown: impl Fn() -> String) -> Result<Metadata, FileError> {
    let metadata = file.metadata().map_err(|source| FileError::System { name: shown(), source })?;
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
    Err(FileError::NotRegular { name: shown(), what })
}
