//! The only way to open files.
//!
//! - **Nothing waits.** A program that opens a named pipe waits until another opens its other end. This crate reports
//!   a pipe without a reader immediately, and a pipe without a writer after a few seconds, or immediately if a file is
//!   expected.
//! - **Nothing is read without a limit.** A device, a growing file, or a file full of holes is read only up to the
//!   limit.
//! - **No link is followed below a [`Folder`]**, neither to read nor to write, so a user who fills a folder cannot
//!   redirect access, even at the same time.
//! - **Written files appear whole** ([`Replacement`]), and replace files of the same name.
//!
//! ```
//! use fosssim_files::Place;
//!
//! let folder = tempfile::tempdir()?;
//! let place = Place::new(folder.path(), "report.txt");
//! place.write(b"right")?;
//! assert_eq!(place.read(1024)?, b"right");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod error;
mod folder;
mod place;
mod replacement;

pub use error::FileError;
pub use folder::{Folder, FolderEntry, open_file};
pub use place::Place;
pub use replacement::{Replacement, UNFINISHED_PREFIX};

use std::{
    fs::{File, Metadata, OpenOptions},
    io::{self, Cursor, Read},
    os::unix::fs::{FileTypeExt, MetadataExt, OpenOptionsExt},
    path::Path,
    thread,
    time::{Duration, Instant},
};

/// The identity of a file: its device and its inode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Identity(u64, u64);

impl Identity {
    const fn new(device: u64, inode: u64) -> Self {
        Self(device, inode)
    }

    /// Returns the identity of an open or existing file.
    #[must_use]
    pub fn from_metadata(metadata: &Metadata) -> Self {
        Self(metadata.dev(), metadata.ino())
    }
}

/// Opens a file, a directory or a pipe for reading, without waiting for a pipe's writer.
///
/// # Errors
/// Fails if it cannot be opened.
pub fn open_for_reading(name: &Path) -> io::Result<(File, Metadata)> {
    let file = OpenOptions::new().read(true).custom_flags(libc::O_NONBLOCK).open(name);
    let file = file.map_err(|error| match error.raw_os_error() {
        Some(libc::ENXIO) => io::Error::other("it is a socket, or a missing device; name a regular file"),
        _ => error,
    })?;
    let metadata = file.metadata()?;
    Ok((file, metadata))
}

/// Opens for writing without waiting for a pipe's reader, whose absence is an error. Writing then waits until there is
/// room.
///
/// # Errors
/// Fails if it cannot be opened.
pub fn open_for_writing(options: &OpenOptions, name: &Path) -> io::Result<File> {
    let first = options.clone().custom_flags(libc::O_NONBLOCK).open(name)?;
    let kind = first.metadata()?.file_type();
    if kind.is_fifo() || kind.is_char_device() {
        // The pipe has a reader. `first` never waits, so a full pipe would be an error; open the pipe again for writing
        // that waits.
        return options.open(name);
    }
    Ok(first)
}

/// Reads a whole file that a user names, with at most `limit` bytes. Pipes are read and links are followed.
///
/// # Errors
/// Fails if it cannot be read, is a folder, or is larger.
pub fn read(name: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let (file, metadata) = open_for_reading(name)?;
    if metadata.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    read_limited(file, &metadata, limit)
}

/// Reads text like [`read`].
///
/// # Errors
/// Fails like [`read`], and if the bytes are not UTF-8.
pub fn read_text(name: &Path, limit: u64) -> io::Result<String> {
    String::from_utf8(read(name, limit)?)
        .map_err(|error| io::Error::new(io::ErrorKind::InvalidData, format!("it is not text: {}", error.utf8_error())))
}

/// Reads an open file of at most `limit` bytes.
///
/// # Errors
/// Fails if it cannot be read, or is larger.
pub fn read_limited(file: File, metadata: &Metadata, limit: u64) -> io::Result<Vec<u8>> {
    // Read one byte more than allowed, to see whether the file is longer.
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len().min(limit)).unwrap_or_default() + 1);
    with_timeout(file, metadata)?.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        let text = format!("it is larger than {limit} bytes, the limit of such a file");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, text));
    }
    Ok(bytes)
}

/// The maximum time that a pipe may be without a writer.
const PIPE_PATIENCE: Duration = Duration::from_secs(5);

/// Returns a reader that waits for the bytes of a pipe's writer, but not forever for a missing writer.
///
/// # Errors
/// Fails if nothing is written within five seconds, or the pipe cannot be read.
pub fn with_timeout(file: File, metadata: &Metadata) -> io::Result<Box<dyn Read + Send>> {
    if !metadata.file_type().is_fifo() {
        return Ok(Box::new(file));
    }
    let mut pipe = PatientPipe(file);
    let begun = Instant::now();
    let mut first = [0; 1];
    loop {
        match pipe.0.read(&mut first) {
            // A pipe without a writer looks like the end of a file.
            Ok(0) if begun.elapsed() < PIPE_PATIENCE => thread::sleep(Duration::from_millis(5)),
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

/// A pipe in non-blocking mode with a writer at its other end.
struct PatientPipe(File);

impl Read for PatientPipe {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            match self.0.read(buffer) {
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => thread::sleep(Duration::from_millis(1)),
                other => return other,
            }
        }
    }
}
