//! Traces as inputs: streams, decompressed on the way.
use super::{Identity, asset, no_asset, open, patient};
use crate::{cli::output::has_extension, suite::library};
use anyhow::{Context, Result, bail};
use std::{
    io::{self, BufReader, Cursor, Read},
    path::Path,
    sync::{Arc, Mutex, PoisonError},
};

/// A trace that is about to be read.
pub(in crate::cli) struct TraceInput {
    /// The name as typed, fit for printing.
    pub(in crate::cli) name: String,
    /// Its bytes, decompressed.
    pub(in crate::cli) reader: Box<dyn Read + Send>,
    /// Its length, when it is a plain file.
    pub(in crate::cli) length: Option<u64>,
    /// The file, when there is one.
    pub(in crate::cli) identity: Option<Identity>,
    failure: Arc<Mutex<Option<String>>>,
}

impl TraceInput {
    /// What the operating system said when reading failed: our fault, not the trace's.
    pub(in crate::cli) fn failure(&self) -> Option<String> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

/// Opens a trace: a path, `-` for standard input, or `asset:Group/name` for an embedded recording.
///
/// # Errors
/// When it can't be opened. Damage shows only while it is read.
pub(in crate::cli) fn trace(name: &Path) -> Result<TraceInput> {
    let shown = name.display().to_string();
    let failure = Arc::default();
    let watched = |reader| Watched { reader, failure: Arc::clone(&failure) };
    let (reader, length, identity): (Box<dyn Read + Send>, _, _) = if let Some(asset) = asset(name) {
        let recording = library::recording(asset).with_context(|| no_asset("recording", asset))?;
        (decompressed(Box::new(Cursor::new(recording)), &[])?, None, None)
    } else if name == Path::new("-") {
        let (reader, packed) = maybe_packed(Box::new(watched(Box::new(io::stdin()))), false)?;
        (reader, (!packed).then_some(()).and(None), None)
    } else {
        let context = || format!("cannot read the trace {shown}");
        let (file, metadata) = open(name).with_context(context)?;
        let plain = metadata.is_file().then_some(metadata.len());
        let file = patient(file, &metadata).with_context(context)?;
        let (reader, packed) =
            maybe_packed(Box::new(watched(file)), has_extension(name, "zst")).with_context(context)?;
        (reader, plain.filter(|_| !packed), Some(Identity::of(&metadata)))
    };
    Ok(TraceInput { name: shown, reader, length, identity, failure })
}

/// Remembers what the operating system said when reading failed.
struct Watched {
    reader: Box<dyn Read + Send>,
    failure: Arc<Mutex<Option<String>>>,
}

impl Read for Watched {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.reader.read(buffer).inspect_err(|error| {
            if error.kind() != io::ErrorKind::Interrupted {
                *self.failure.lock().unwrap_or_else(PoisonError::into_inner) = Some(error.to_string());
            }
        })
    }
}

/// The first bytes of every zstd frame.
const ZSTD_MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// Frames that need a larger window than 8 MiB are refused: memory stays bounded.
const ZSTD_WINDOW: u32 = 23;

/// The reader, decompressed when it starts like a zstd file, and whether it does.
fn maybe_packed(mut reader: Box<dyn Read + Send>, must: bool) -> Result<(Box<dyn Read + Send>, bool)> {
    let mut start = Vec::new();
    reader.by_ref().take(ZSTD_MAGIC.len() as u64).read_to_end(&mut start)?;
    if start == ZSTD_MAGIC {
        return Ok((decompressed(reader, &start)?, true));
    }
    if must {
        bail!("it is not zstd data although its name ends in .zst; rename it, or compress it with zstd");
    }
    Ok((Box::new(Cursor::new(start).chain(reader)), false))
}

fn decompressed(reader: Box<dyn Read + Send>, start: &[u8]) -> Result<Box<dyn Read + Send>> {
    let packed = BufReader::with_capacity(1 << 16, Cursor::new(start.to_vec()).chain(reader));
    let mut decoder = zstd::stream::read::Decoder::with_buffer(packed)?;
    decoder.window_log_max(ZSTD_WINDOW)?;
    Ok(Box::new(Unpacked(decoder)))
}

/// A decoder whose errors say what is wrong with the file.
struct Unpacked<R: io::BufRead>(zstd::stream::read::Decoder<'static, R>);

impl<R: io::BufRead> Read for Unpacked<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.0.read(buffer).map_err(|error| match error.kind() {
            io::ErrorKind::Interrupted => error,
            io::ErrorKind::UnexpectedEof => io::Error::new(error.kind(), "the zstd data is cut short"),
            kind => io::Error::new(kind, format!("the zstd data is damaged ({error})")),
        })
    }
}
