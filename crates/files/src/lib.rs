//! Opens files and pipes without waiting for an end that never comes.
//!
//! A named pipe blocks whoever opens it until somebody opens its other end. Nothing here waits for that: a pipe without
//! a reader is an error at once, one without a writer after a few seconds.
#![forbid(unsafe_code)]

use std::{
    fs::{File, Metadata, OpenOptions},
    io::{self, Cursor, Read},
    os::unix::fs::{FileTypeExt, MetadataExt, OpenOptionsExt},
    path::Path,
    thread,
    time::{Duration, Instant},
};

/// What tells one file from every other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Identity(u64, u64);

impl Identity {
    /// The identity of an open or existing file.
    #[must_use]
    pub fn of(metadata: &Metadata) -> Self {
        Self(metadata.dev(), metadata.ino())
    }
}

/// Opens a file, a directory or a pipe for reading; a pipe is not waited for.
///
/// # Errors
/// When it can't be opened.
pub fn open_for_reading(name: &Path) -> io::Result<(File, Metadata)> {
    let file = OpenOptions::new().read(true).custom_flags(libc::O_NONBLOCK).open(name)?;
    let metadata = file.metadata()?;
    Ok((file, metadata))
}

/// Opens for writing without waiting for a pipe's reader, whose absence is an error. What is opened waits, when it is
/// written to, until there is room.
///
/// # Errors
/// When it can't be opened.
pub fn open_for_writing(options: &OpenOptions, name: &Path) -> io::Result<File> {
    let first = options.clone().custom_flags(libc::O_NONBLOCK).open(name)?;
    let kind = first.metadata()?.file_type();
    if kind.is_fifo() || kind.is_char_device() {
        // There is a reader. Through `first` a full pipe would be an error; through a second opening it is waited for.
        return options.open(name);
    }
    Ok(first)
}

/// Reads an open file, which may have so many bytes at most: those of a scene.
///
/// # Errors
/// When it can't be read, or is larger.
pub fn read_limited(file: File, metadata: &Metadata, limit: usize) -> io::Result<Vec<u8>> {
    let limit = limit as u64;
    // One byte more than it should have shows whether it ends there.
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len().min(limit)).unwrap_or_default() + 1);
    patient(file, metadata)?.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        let text = format!("it is larger than {limit} bytes, which no scene is");
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, text));
    }
    Ok(bytes)
}

/// How long a pipe may stay without a writer.
const PIPE_PATIENCE: Duration = Duration::from_secs(5);

/// A reader that waits for what a pipe's writer has yet to write, but not for a writer that never comes.
///
/// # Errors
/// When nobody writes within five seconds, or the pipe can't be read.
pub fn patient(file: File, metadata: &Metadata) -> io::Result<Box<dyn Read + Send>> {
    if !metadata.file_type().is_fifo() {
        return Ok(Box::new(file));
    }
    let mut pipe = PatientPipe(file);
    let begun = Instant::now();
    let mut first = [0; 1];
    loop {
        match pipe.0.read(&mut first) {
            // Without a writer a pipe seems to be at its end.
            Ok(0) if begun.elapsed() < PIPE_PATIENCE => thread::sleep(Duration::from_millis(5)),
            Ok(0) => {
                let text = "it is a pipe that nobody has written to for five seconds";
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
