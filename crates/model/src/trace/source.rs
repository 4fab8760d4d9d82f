//! A stream with an absolute offset, and with a buffer that can be read before it is consumed.
//!
//! An error of the stream counts as its end and is kept. A reader treats it like missing bytes and can still name it.
use super::error::TraceFormatError;
use std::io::{self, Read};

/// The size of the buffer, and of the largest piece that [`Source::ensure`] can provide in one call. A larger buffer
/// does not make reading faster, because its pages must be created and it does not fit the cache.
pub(crate) const WINDOW_BYTES: usize = 64 * 1024;

#[derive(Debug)]
pub(crate) struct Source<R> {
    stream: R,
    buffer: Vec<u8>,
    start: usize,
    end: usize,
    /// The absolute offset of `buffer[start]`.
    offset: u64,
    /// The length of the whole stream, if known. Nothing after it is read.
    length: Option<u64>,
    has_ended: bool,
    error: Option<TraceFormatError>,
}

impl<R: Read> Source<R> {
    /// Creates a source at the beginning of `stream`.
    pub(crate) fn new(stream: R) -> Self {
        let (buffer, length, error) = (Vec::new(), None, None);
        Self { stream, buffer, start: 0, end: 0, offset: 0, length, has_ended: false, error }
    }

    /// Returns the source with a known length of the whole stream.
    pub(crate) fn with_length(mut self, bytes: u64) -> Self {
        self.length = Some(bytes);
        self
    }

    /// Returns the absolute offset of the next byte.
    #[inline]
    pub(crate) fn offset(&self) -> u64 {
        self.offset
    }

    /// Returns the error that ended the stream, if an error ended it.
    pub(crate) fn error(&self) -> Option<TraceFormatError> {
        self.error.clone()
    }

    /// Returns the bytes in the buffer.
    #[inline]
    pub(crate) fn window(&self) -> &[u8] {
        &self.buffer[self.start..self.end]
    }

    /// Tries to fill the buffer to at least `byte_count` bytes, and returns the number present, which is smaller only
    /// at the end.
    ///
    /// # Panics
    /// Panics if `byte_count` exceeds [`WINDOW_BYTES`] bytes.
    pub(crate) fn ensure(&mut self, byte_count: usize) -> usize {
        assert!(byte_count <= WINDOW_BYTES, "the window is smaller");
        if self.end - self.start < byte_count && !self.has_ended {
            self.fill(byte_count);
        }
        self.end - self.start
    }

    /// Skips `count` bytes of the window.
    #[inline]
    pub(crate) fn consume(&mut self, count: usize) {
        self.start += count;
        self.offset += count as u64;
    }

    #[cold]
    fn fill(&mut self, wanted: usize) {
        if self.buffer.is_empty() {
            // Small traces get a small buffer; one more byte shows the end of the stream in the same call. Unused
            // memory is never touched.
            let size = self
                .length
                .map_or(WINDOW_BYTES as u64, |length| length.saturating_add(1).clamp(64, WINDOW_BYTES as u64));
            self.buffer = vec![0; usize::try_from(size).unwrap_or(WINDOW_BYTES)];
        }
        self.buffer.copy_within(self.start..self.end, 0);
        if self.buffer.len() < wanted {
            self.buffer.resize(WINDOW_BYTES, 0);
        }
        self.end -= self.start;
        self.start = 0;
        while self.end < wanted && !self.has_ended {
            let read = self.offset + self.end as u64;
            let allowed = self.length.map_or(u64::MAX, |length| length.saturating_sub(read));
            let room = (self.buffer.len() - self.end).min(usize::try_from(allowed).unwrap_or(usize::MAX));
            if room == 0 {
                self.has_ended = true;
                break;
            }
            match self.stream.read(&mut self.buffer[self.end..self.end + room]) {
                Ok(0) => self.has_ended = true,
                Ok(count) => self.end += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => {
                    self.error = Some(TraceFormatError::Io { message: error.to_string() });
                    self.has_ended = true;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns one byte per call, with an interruption before each.
    struct Trickle<'a>(&'a [u8], bool);

    impl Read for Trickle<'_> {
        fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
            self.1 = !self.1;
            if self.1 {
                return Err(io::ErrorKind::Interrupted.into());
            }
            let count = out.len().min(1).min(self.0.len());
            out[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    #[test]
    fn a_trickling_stream_gives_the_same_bytes() {
        let bytes: Vec<u8> = (0..100).collect();
        let mut source = Source::new(Trickle(&bytes, false));
        assert_eq!(source.ensure(10), 10);
        assert_eq!(source.window(), &bytes[..10]);
        source.consume(7);
        assert_eq!(source.offset(), 7);
        assert_eq!(source.ensure(200), 93);
        assert_eq!(source.window(), &bytes[7..]);
        source.consume(93);
        assert_eq!(source.ensure(1), 0);
    }

    #[test]
    fn nothing_beyond_the_known_length_is_read() {
        let mut source = Source::new(&[1_u8; 50][..]).with_length(20);
        assert_eq!(source.ensure(30), 20);
        source.consume(20);
        assert_eq!(source.ensure(1), 0);
    }
}
