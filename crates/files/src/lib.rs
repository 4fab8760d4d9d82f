//! The only crate that opens files.
//!
//! - **Nothing waits.** A program that opens a named pipe waits until another opens its other end. This crate reports a
//!   pipe without a reader immediately, and a pipe without a writer after a few seconds. If it expects a file, it
//!   reports every pipe immediately.
//! - **Nothing is read without a limit.** A device, a growing file, or a file full of holes is read only up to the
//!   limit.
//! - **No link is followed below a [`Folder`]**, neither to read nor to write. A program that fills the folder, even at
//!   the same time, cannot redirect the access.
//! - **Written files appear whole** ([`Replacement`]), and replace files of the same name.
//!
//! ```
//! use fosssim_files::FilePlace;
//!
//! let folder = tempfile::tempdir()?;
//! let place = FilePlace::new(folder.path(), "report.txt");
//! place.write(b"right")?;
//! assert_eq!(place.read(1024)?, b"right");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod error;
mod file_place;
mod folder;
mod replacement;

pub use error::FileError;
pub use file_place::FilePlace;
pub use folder::{Folder, FolderEntry, open_file};
pub use replacement::{Replacement, UNFINISHED_PREFIX};

use std::{
    fs::{File, Metadata, OpenOptions},
    io::{self, Cursor, Read},
    os::unix::fs::{FileTypeExt, MetadataExt, OpenOptionsExt},
    path::Path,
    thread,
    time::{Duration, Instant},
};

/// The identity of a file, which consists of its device and its inode. All hard links to a file have the same identity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Identity(u64, u64);

impl Identity {
    const fn new(device: u64, inode: u64) -> Self {
        Self(device, inode)
    }

    /// Returns the identity of the file that has this metadata.
    pub fn from_metadata(metadata: &Metadata) -> Self {
        Self(metadata.dev(), metadata.ino())
    }
}

/// Opens a file, a folder or a pipe for reading. Does not wait for a process that writes into a pipe.
///
/// # Errors
/// Fails if the entry cannot be opened.
pub fn open_for_reading(name: &Path) -> io::Result<(File, Metadata)> {
    let file = OpenOptions::new().read(true).custom_flags(libc::O_NONBLOCK).open(name);
    let file = file.map_err(|error| match error.raw_os_error() {
        Some(libc::ENXIO) => io::Error::other("this is a socket or a missing device; name a regular file"),
        _ => error,
    })?;
    let metadata = file.metadata()?;
    Ok((file, metadata))
}

/// Opens a file or a pipe for writing. Does not wait for a process that reads from a pipe: a pipe without a reader is
/// an error. Writing then waits until the pipe has space.
///
/// # Errors
/// Fails if the entry cannot be opened, or if a pipe has no reader.
pub fn open_for_writing(options: &OpenOptions, name: &Path) -> io::Result<File> {
    let first = options.clone().custom_flags(libc::O_NONBLOCK).open(name)?;
    let kind = first.metadata()?.file_type();
    if kind.is_fifo() || kind.is_char_device() {
        // The pipe has a reader. `first` never waits, so writing into a full pipe would fail. Therefore the pipe is
        // opened again, and writing waits.
        return options.open(name);
    }
    Ok(first)
}

/// Reads a whole file that a user names, of at most `limit` bytes. It may be a pipe, and links are followed.
///
/// # Errors
/// Fails if the file cannot be read, is a folder, or is larger than `limit`.
pub fn read(name: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let (file, metadata) = open_for_reading(name)?;
    if metadata.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    read_limited(file, &metadata, limit)
}

/// Reads a whole file as text, as [`read`] does.
///
/// # Errors
/// Fails like [`read`]. Also fails if the bytes are not UTF-8.
pub fn read_text(name: &Path, limit: u64) -> io::Result<String> {
    String::from_utf8(read(name, limit)?)
        .map_err(|error| io::Error::new(io::ErrorKind::InvalidData, format!("it is not text: {}", error.utf8_error())))
}

/// Reads an open file of at most `limit` bytes.
///
/// # Errors
/// Fails if the file cannot be read, or is larger than `limit`.
pub fn read_limited(file: File, metadata: &Metadata, limit: u64) -> io::Result<Vec<u8>> {
    // One byte more than allowed is read, to find out whether the file is longer.
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len().min(limit)).unwrap_or_default() + 1);
    with_timeout(file, metadata)?.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        let text = format!("the file is larger than {limit} bytes, which is the limit");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, text));
    }
    Ok(bytes)
}

/// The maximum time for which a pipe may have no writer.
const PIPE_TIMEOUT: Duration = Duration::from_secs(5);

/// Returns a reader that waits until a pipe's writer writes. If the pipe has no writer, it does not wait forever.
///
/// # Errors
/// Fails if the pipe has no writer for five seconds, or if it cannot be read.
pub fn with_timeout(file: File, metadata: &Metadata) -> io::Result<Box<dyn Read + Send>> {
    if !metadata.file_type().is_fifo() {
        return Ok(Box::new(file));
    }
    let mut pipe = TimeoutPipe(file);
    let start = Instant::now();
    let mut first = [0; 1];
    loop {
        match pipe.0.read(&mut first) {
            // If a pipe has no writer, reading looks like the end of a file.
            Ok(0) if start.elapsed() < PIPE_TIMEOUT => thread::sleep(Duration::from_millis(5)),
            Ok(0) => {
                let text = "nothing wrote to the pipe for five seconds";
                return Err(io::Error::new(io::ErrorKind::TimedOut, text));
            }
            Ok(_) => return Ok(Box::new(Cursor::new(first).chain(pipe))),
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => return Ok(Box::new(pipe)),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

/// A pipe that is opened without waiting, and has a writer.
struct TimeoutPipe(File);

impl Read for TimeoutPipe {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            match self.0.read(buffer) {
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => thread::sleep(Duration::from_millis(1)),
                other => return other,
            }
        }
    }
}
