//! Inputs: scenes and traces by path, from standard input, or from the embedded library.
//!
//! Nothing here waits for ever: a named pipe that nobody writes to is refused. Nothing is read whole but scenes, whose
//! size is limited; traces are streams, decompressed on the way when they are zstd files.

pub(super) mod pair;
mod scene;
mod trace;

pub(super) use scene::{SceneInput, scene};
pub(super) use trace::{TraceInput, trace};

use crate::{report::grade::one_line, scene::LARGEST_SCENE, suite::library};
use anyhow::{Result, bail};
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
pub(super) struct Identity(u64, u64);

impl Identity {
    /// The identity of an open or existing file.
    pub(super) fn of(metadata: &Metadata) -> Self {
        Self(metadata.dev(), metadata.ino())
    }
}

/// A file's name as typed, fit for printing: a stranger's file may be called by codes that a terminal obeys.
pub(super) fn shown(name: &Path) -> String {
    one_line(&name.display().to_string())
}

/// Reads at most [`LARGEST_SCENE`] bytes of an open file.
pub(super) fn read_limited(file: File, metadata: &Metadata) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let limit = LARGEST_SCENE as u64;
    patient(file, metadata)?.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        bail!("it is larger than {limit} bytes, which no scene is");
    }
    Ok(bytes)
}

/// The name after `asset:`.
pub(super) fn asset(name: &Path) -> Option<&str> {
    name.to_str()?.strip_prefix("asset:")
}

fn no_asset(what: &str, name: &str) -> String {
    let close: Vec<_> = library::names().filter(|known| known.contains(name) || name.contains(*known)).collect();
    let known = if close.is_empty() { library::names().take(3).collect() } else { close };
    format!("no embedded {what} is called `{name}`; there are, for example, {}", known.join(", "))
}

/// A file that is not there, but would be what comes with the program, had it `asset:` before its name.
fn or_asset(name: &Path, error: io::Error) -> anyhow::Error {
    let known = name.to_str().map(|name| name.strip_suffix(".xml").unwrap_or(name));
    match known.filter(|known| error.kind() == io::ErrorKind::NotFound && library::names().any(|name| name == *known)) {
        Some(known) => anyhow::anyhow!("there is no such file; the scene that comes with the program is asset:{known}"),
        None => error.into(),
    }
}

/// Opens a file without waiting for a pipe's other end. Directories are refused.
pub(super) fn open(name: &Path) -> Result<(File, Metadata)> {
    let file = OpenOptions::new().read(true).custom_flags(libc::O_NONBLOCK).open(name);
    let file = file.map_err(|error| or_asset(name, error))?;
    let metadata = file.metadata()?;
    if metadata.is_dir() {
        bail!("it is a directory; name a file inside");
    }
    Ok((file, metadata))
}

/// How long a pipe may stay without a writer.
const PIPE_PATIENCE: Duration = Duration::from_secs(5);

/// A reader that waits for what a pipe's writer has yet to write, but not for a writer that never comes.
pub(super) fn patient(file: File, metadata: &Metadata) -> io::Result<Box<dyn Read + Send>> {
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
