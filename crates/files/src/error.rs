//! The reason why a file was rejected.
use std::{
    ffi::OsStr,
    fs::{File, Metadata},
    io,
    os::unix::fs::FileTypeExt,
};

/// The reason why a file was rejected. Except for [`FileError::System`], the person who filled the folder is the cause.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The file does not exist.
    #[error("the file {name} does not exist")]
    Missing {
        /// The name of the file, with escapes.
        name: String,
    },
    /// The name belongs to a folder, a link or a device, not to a regular file.
    #[error("{name} is {what}, not a regular file")]
    NotRegular {
        /// The name of the entry, with escapes.
        name: String,
        /// The kind of entry that has this name.
        what: &'static str,
    },
    /// The file has several hard links. Some of them may be outside the folder.
    #[error("{name} has {links} hard links, but only one is allowed")]
    Linked {
        /// The name of the file, with escapes.
        name: String,
        /// The number of the file's hard links.
        links: u64,
    },
    /// The file is too long.
    #[error("{name} is {length} bytes long, the limit is {limit}")]
    TooLong {
        /// The name of the file, with escapes.
        name: String,
        /// The length of the file in bytes.
        length: u64,
        /// The maximum length in bytes.
        limit: u64,
    },
    /// The folder or the file cannot be read.
    #[error("cannot read {name}: {source}")]
    System {
        /// The name of the file or folder, with escapes.
        name: String,
        /// The error that the operating system reported.
        source: io::Error,
    },
}

impl FileError {
    /// Converts the operating system's error after a file could not be opened.
    pub(crate) fn from_open_error(name: String, error: io::Error) -> Self {
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

/// Returns a name for messages, in which unusual characters are replaced by escapes.
pub(crate) fn escape(name: &OsStr) -> String {
    name.to_string_lossy().escape_debug().to_string()
}

/// Returns the metadata of an open file. Fails if it is not a regular file.
pub(crate) fn require_regular_file(file: &File, printable_name: impl Fn() -> String) -> Result<Metadata, FileError> {
    let metadata = file.metadata().map_err(|source| FileError::System { name: printable_name(), source })?;
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
    Err(FileError::NotRegular { name: printable_name(), what })
}
