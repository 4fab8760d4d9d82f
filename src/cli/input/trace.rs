//! Reads traces as inputs. They are streams, and are decompressed while they are read.
use super::{asset_name, describe_missing_asset, open, printable_name};
use crate::files::{Identity, with_timeout};
use crate::{
    cli::output::has_extension,
    report::check::{SNIFFED_BYTES, detect_file_kind},
    scene::Scene,
    suite::library,
    trace::{Layout, Reader},
};
use anyhow::{Context, Result, bail};
use std::{
    io::{self, BufReader, Cursor, Read},
    path::Path,
    sync::{Arc, Mutex, PoisonError},
};

/// A trace that is opened, but not read yet.
pub(in crate::cli) struct TraceInput {
    /// The name of the trace as the user typed it, in printable form.
    pub(in crate::cli) name: String,
    /// The bytes of the trace, decompressed.
    pub(in crate::cli) reader: Box<dyn Read + Send>,
    /// The identity of the trace's file; `None` if it is not a file.
    pub(in crate::cli) identity: Option<Identity>,
    /// The kind of file that it probably is, if it can't be a trace.
    pub(in crate::cli) probable_kind: Option<&'static str>,
    failure: Failure,
}

impl TraceInput {
    /// Returns the error message of the operating system or of the decoder, if reading failed. In that case, the author
    /// of the trace is not at fault.
    pub(in crate::cli) fn failure(&self) -> Option<String> {
        self.failure.get()
    }

    /// Returns an error if reading failed.
    ///
    /// # Errors
    ///
    /// Fails with the error of [`TraceInput::failure`].
    pub(in crate::cli) fn ensure_not_failed(&self) -> Result<()> {
        match self.failure() {
            Some(message) => bail!("cannot read the trace {}: {message}", self.name),
            None => Ok(()),
        }
    }

    /// Reads the records of the trace, which belongs to `scene`.
    pub(in crate::cli) fn records(&mut self, scene: &Scene) -> Reader<&mut Box<dyn Read + Send>> {
        Reader::new(&mut self.reader, Layout::for_scene(scene)).with_scene(scene)
    }
}

/// The first error that occurs while the trace is read.
#[derive(Clone, Default)]
struct Failure(Arc<Mutex<Option<String>>>);

impl Failure {
    fn get(&self) -> Option<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn set(&self, message: &str) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(|| message.to_owned());
    }
}

/// Opens a trace. The name is a path, `-` for standard input, `asset:Group/name` for an embedded recording, or
/// `asset:Group/name/flawed` for the built-in wrong trace of one scene.
///
/// # Errors
///
/// Fails if the trace can't be opened. Damage is detected only when the trace is read.
pub(in crate::cli) fn open_trace(name: &Path) -> Result<TraceInput> {
    let display_name = printable_name(name);
    let failure = Failure::default();
    let watched = |reader| WatchedReader { reader, failure: failure.clone() };
    let is_flawed = |asset: &&str| asset.strip_suffix("/flawed") == Some(library::FLAWED_TRACE.0);
    let (mut reader, identity): (Box<dyn Read + Send>, _) = if asset_name(name).filter(is_flawed).is_some() {
        (Box::new(library::FLAWED_TRACE.1), None)
    } else if let Some(asset) = asset_name(name) {
        let recording = library::recording(asset).with_context(|| describe_missing_asset("recording", asset))?;
        (decompress(Box::new(Cursor::new(recording)), &[], &failure)?, None)
    } else if name == Path::new("-") {
        let reader = open_packed(Box::new(watched(Box::new(io::stdin()))), false, &failure);
        (reader.context("cannot read the trace from standard input")?, None)
    } else {
        // If the user names a scene instead of a trace, that is a mistake of the user, and not a wrong trace. It is
        // rejected if both the name and the content show it.
        if is_scene(name) {
            bail!("{display_name} is a scene, not a trace: SCENE comes first, then TRACE");
        }
        let context = || format!("cannot read the trace {display_name}");
        let (file, metadata) = open(name).with_context(context)?;
        let file = with_timeout(file, &metadata).with_context(context)?;
        let reader = open_packed(Box::new(watched(file)), has_extension(name, "zst"), &failure);
        (reader.with_context(context)?, Some(Identity::from_metadata(&metadata)))
    };
    let mut start = Vec::new();
    // If bytes can't be read here, reading them again below reports it.
    let _ = reader.by_ref().take(SNIFFED_BYTES).read_to_end(&mut start);
    let looks_like = if failure.get().is_none() { detect_file_kind(&start) } else { None };
    let reader = Box::new(Cursor::new(start).chain(reader));
    Ok(TraceInput { name: display_name, reader, identity, probable_kind: looks_like, failure })
}

/// Returns whether a file is a scene, according to its name and its first bytes.
pub(in crate::cli) fn is_scene(name: &Path) -> bool {
    if has_extension(name, "xml")
        && let Ok((file, metadata)) = open(name)
        && metadata.is_file()
    {
        let mut start = Vec::new();
        let is_read = file.take(8).read_to_end(&mut start).is_ok();
        return is_read && (start.starts_with(b"<?xml") || start.starts_with(b"<scene"));
    }
    false
}

/// A reader that stores the error of the operating system if reading fails.
struct WatchedReader {
    reader: Box<dyn Read + Send>,
    failure: Failure,
}

impl Read for WatchedReader {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.reader.read(buffer).inspect_err(|error| {
            if error.kind() != io::ErrorKind::Interrupted {
                self.failure.set(&error.to_string());
            }
        })
    }
}

/// The first bytes of each frame in a zstd file.
pub(super) const ZSTD_MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// The maximum window size of zstd frames, as a power of two (8 MiB). It limits the memory for decompression. The
/// program that compresses chooses the window: it is 2 MiB at zstd's default level 3, and 8 MiB at level 19, which
/// recordings use.
const ZSTD_WINDOW: u32 = 23;

/// Returns whether a file begins like a gzip file. Its flags must be below 32.
const fn is_gzip(start: &[u8]) -> bool {
    matches!(start, [0x1f, 0x8b, 8, 0..32])
}

/// Returns a reader that decompresses the bytes if they begin like a zstd or a gzip file. If `is_required` is set,
/// other bytes are rejected.
fn open_packed(mut reader: Box<dyn Read + Send>, is_required: bool, failure: &Failure) -> Result<Box<dyn Read + Send>> {
    let mut start = Vec::new();
    reader.by_ref().take(ZSTD_MAGIC.len() as u64).read_to_end(&mut start)?;
    if start == ZSTD_MAGIC {
        return decompress(reader, &start, failure);
    }
    if is_gzip(&start) {
        let decoder = flate2::read::MultiGzDecoder::new(Cursor::new(start).chain(reader));
        return Ok(Box::new(UnpackedReader { decoder, format: "gzip", failure: failure.clone() }));
    }
    if is_required {
        bail!("the file is not zstd data although its name ends in .zst; rename it, or compress it with zstd");
    }
    Ok(Box::new(Cursor::new(start).chain(reader)))
}

/// Returns at most `max_bytes` bytes of a trace that may be compressed. If its zstd data can't be decompressed, returns
/// the reason.
///
/// # Errors
///
/// Fails if the file can't be read.
pub(in crate::cli) fn unpack(file: impl Read + Send + 'static, max_bytes: u64) -> io::Result<Result<Vec<u8>, String>> {
    let failure = Failure::default();
    let mut bytes = Vec::new();
    let read = open_packed(Box::new(file), false, &failure)
        .map_err(io::Error::other)
        .and_then(|reader| reader.take(max_bytes).read_to_end(&mut bytes));
    match (read, failure.get()) {
        (_, Some(why)) => Ok(Err(why)),
        (Err(error), None) => Err(error),
        (Ok(_), None) => Ok(Ok(bytes)),
    }
}

fn decompress(reader: Box<dyn Read + Send>, start: &[u8], failure: &Failure) -> Result<Box<dyn Read + Send>> {
    let packed = BufReader::with_capacity(1 << 16, Cursor::new(start.to_vec()).chain(reader));
    let mut decoder = zstd::stream::read::Decoder::with_buffer(packed)?;
    decoder.window_log_max(ZSTD_WINDOW)?;
    Ok(Box::new(UnpackedReader { decoder, format: "zstd", failure: failure.clone() }))
}

/// A decoder that stores its errors and describes them as faults of the file, because a damaged file proves nothing
/// about the trace. If bytes follow the last zstd frame that are not a frame, the file also counts as damaged.
struct UnpackedReader<R> {
    decoder: R,
    format: &'static str,
    failure: Failure,
}

impl<R: Read> Read for UnpackedReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.decoder.read(buffer).map_err(|error| {
            // The message of the operating system is already stored. It explains more than this one.
            if error.kind() == io::ErrorKind::Interrupted || self.failure.get().is_some() {
                return error;
            }
            let text = if error.kind() == io::ErrorKind::UnexpectedEof {
                format!("the {} data is cut short; copy it again", self.format)
            } else if error.to_string().contains("too much memory") {
                "the file's zstd window is larger than 8 MiB; compress it again without --long or --ultra".to_owned()
            } else {
                format!("the {} data is damaged; copy it again", self.format)
            };
            self.failure.set(&text);
            io::Error::new(error.kind(), text)
        })
    }
}
