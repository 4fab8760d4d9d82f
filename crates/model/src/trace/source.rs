//! A stream with a buffer that can be looked at before it is consumed, an absolute offset, and, where it is known, the
//! number of bytes left.
//!
//! An error of the stream counts as its end and is kept, so that both readers treat it like missing bytes and can
//! still name it.
use super::error::Malformation;
use std::io::{self, Read};

/// Size of the buffer, hence of the largest piece that [`Source::ensure`] can show at once. A larger one makes no
/// faster reading: its pages have to be made, and its bytes do not stay near the processor.
pub(crate) const WINDOW: usize = 64 * 1024;

#[derive(Debug)]
pub(crate) struct Source<R> {
    stream: R,
    buffer: Vec<u8>,
    start: usize,
    end: usize,
    /// Absolute offset of `buffer[start]`.
    offset: u64,
    /// Length of the whole stream, where it is known. Nothing beyond is read.
    length: Option<u64>,
    ended: bool,
    error: Option<Malformation>,
    /// The bytes consumed since `start_tape`.
    tape: Option<Vec<u8>>,
}

impl<R: Read> Source<R> {
    /// A source at the beginning of `stream`.
    pub(crate) fn new(stream: R) -> Self {
        let (buffer, length, error, tape) = (Vec::new(), None, None, None);
        Self { stream, buffer, start: 0, end: 0, offset: 0, length, ended: false, error, tape }
    }

    /// The same source, whatever the stream is.
    pub(super) fn boxed<'a>(self) -> Source<Box<dyn Read + 'a>>
    where
        R: 'a,
    {
        let Self { stream, buffer, start, end, offset, length, ended, error, tape } = self;
        Source { stream: Box::new(stream), buffer, start, end, offset, length, ended, error, tape }
    }

    /// The same source, with a known length of the whole stream.
    pub(crate) fn with_length(mut self, bytes: u64) -> Self {
        self.length = Some(bytes);
        self
    }

    /// Starts keeping what is consumed, in `buffer`, whose old content is thrown away.
    pub(crate) fn start_tape(&mut self, mut buffer: Vec<u8>) {
        buffer.clear();
        self.tape = Some(buffer);
    }

    /// Stops keeping and gives what was consumed since the start; empty without a start.
    pub(crate) fn stop_tape(&mut self) -> Vec<u8> {
        self.tape.take().unwrap_or_default()
    }

    /// Absolute offset of the next byte.
    #[inline]
    pub(crate) fn offset(&self) -> u64 {
        self.offset
    }

    /// Bytes from here to the end: known with a known length and once the end has been seen.
    pub(crate) fn left(&self) -> Option<u64> {
        if self.ended {
            Some((self.end - self.start) as u64)
        } else {
            self.length.map(|length| length.saturating_sub(self.offset))
        }
    }

    /// The error that ended the stream.
    pub(crate) fn error(&self) -> Option<Malformation> {
        self.error.clone()
    }

    /// The bytes in the buffer.
    #[inline]
    pub(crate) fn window(&self) -> &[u8] {
        &self.buffer[self.start..self.end]
    }

    /// Tries to have at least `wanted` bytes in the buffer and gives the number that is there, fewer only at the end.
    ///
    /// # Panics
    /// With more than [`WINDOW`] bytes.
    pub(crate) fn ensure(&mut self, wanted: usize) -> usize {
        assert!(wanted <= WINDOW, "the window is smaller");
        if self.end - self.start < wanted && !self.ended {
            self.fill(wanted);
        }
        self.end - self.start
    }

    /// Steps over `count` bytes of the window.
    #[inline]
    pub(crate) fn consume(&mut self, count: usize) {
        if let Some(tape) = &mut self.tape {
            tape.extend_from_slice(&self.buffer[self.start..self.start + count]);
        }
        self.start += count;
        self.offset += count as u64;
    }

    /// Steps over the next bytes as far as they are those of `expected`, piece by piece. Whether they all are; if not,
    /// some of those that are may have been stepped over, and [`Source::unread`] gives them back.
    pub(crate) fn follow(&mut self, expected: &[u8]) -> bool {
        let mut rest = expected;
        while !rest.is_empty() {
            let there = self.ensure(1).min(rest.len());
            if there == 0 || self.window()[..there] != rest[..there] {
                return false;
            }
            self.consume(there);
            rest = &rest[there..];
        }
        true
    }

    /// Puts the `count` bytes that were consumed last in front of what follows; `bytes` are these, piece by piece, and
    /// may go on.
    pub(crate) fn unread<'a>(&mut self, count: usize, bytes: impl Iterator<Item = &'a [u8]>) {
        self.offset -= count as u64;
        if let Some(start) = self.start.checked_sub(count) {
            // They are still there.
            self.start = start;
            return;
        }
        let size = self.buffer.len().max(count + self.window().len());
        let mut buffer = Vec::with_capacity(size);
        for piece in bytes {
            buffer.extend_from_slice(&piece[..piece.len().min(count - buffer.len())]);
        }
        buffer.extend_from_slice(self.window());
        (self.start, self.end) = (0, buffer.len());
        // As long as it was at least, lest the stream be read in small pieces from now on.
        buffer.resize(size, 0);
        self.buffer = buffer;
    }

    /// Consumes everything up to the end, but at most `limit` bytes, without keeping it. Gives how many there were;
    /// `None` when more follow.
    pub(crate) fn drain(&mut self, limit: u64) -> Option<u64> {
        let mut drained = 0;
        loop {
            let there = self.ensure(1);
            if there == 0 {
                return Some(drained);
            }
            let step = there.min(usize::try_from(limit - drained).unwrap_or(usize::MAX));
            if step == 0 {
                return None;
            }
            self.start += step;
            self.offset += step as u64;
            drained += step as u64;
        }
    }

    #[cold]
    fn fill(&mut self, wanted: usize) {
        if self.buffer.is_empty() {
            // Small traces get a small buffer; one byte more shows the end of the stream in the same call. Memory that
            // is not used stays untouched.
            let size = self.length.map_or(WINDOW as u64, |length| length.saturating_add(1).clamp(64, WINDOW as u64));
            self.buffer = vec![0; usize::try_from(size).unwrap_or(WINDOW)];
        }
        self.buffer.copy_within(self.start..self.end, 0);
        if self.buffer.len() < wanted || self.buffer.len() > WINDOW {
            // It was small, or holds what was given back and is consumed by now.
            self.buffer.resize(WINDOW, 0);
            self.buffer.shrink_to_fit();
        }
        self.end -= self.start;
        self.start = 0;
        while self.end < wanted && !self.ended {
            let there = self.offset + self.end as u64;
            let allowed = self.length.map_or(u64::MAX, |length| length.saturating_sub(there));
            let room = (self.buffer.len() - self.end).min(usize::try_from(allowed).unwrap_or(usize::MAX));
            if room == 0 {
                self.ended = true;
                break;
            }
            match self.stream.read(&mut self.buffer[self.end..self.end + room]) {
                Ok(0) => self.ended = true,
                Ok(count) => self.end += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => {
                    self.error = Some(Malformation::Io { message: error.to_string() });
                    self.ended = true;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gives one byte per call, with an interruption before each.
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
        assert_eq!((source.offset(), source.left()), (7, None));
        assert_eq!(source.ensure(200), 93);
        assert_eq!(source.window(), &bytes[7..]);
        assert_eq!(source.left(), Some(93));
        assert_eq!(source.drain(93), Some(93));
        assert_eq!(source.ensure(1), 0);
    }

    #[test]
    fn what_was_followed_can_be_given_back() {
        let bytes: Vec<u8> = (0..=255).cycle().take(3 * WINDOW).collect();
        let mut source = Source::new(&bytes[..]);
        assert!(source.follow(&bytes[..2 * WINDOW]));
        assert!(!source.follow(&[0; 9]) && !source.follow(&[&bytes[2 * WINDOW..], &[1]].concat()));
        let count = usize::try_from(source.offset()).unwrap();
        source.unread(count, [&bytes[..7], &bytes[7..]].into_iter());
        assert_eq!((source.offset(), &source.window()[..9]), (0, &bytes[..9]));
        let mut read = Vec::new();
        while source.ensure(WINDOW) > 0 {
            let there = source.window().len();
            read.extend_from_slice(source.window());
            source.consume(there);
        }
        assert!(read == bytes && source.offset() == bytes.len() as u64);
    }

    /// A stream that counts how often it is read.
    struct Counting<'a>(&'a [u8], &'a mut usize);

    impl Read for Counting<'_> {
        fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
            *self.1 += 1;
            self.0.read(out)
        }
    }

    /// Each call is one of the system: what is given back must not make them more.
    #[test]
    fn what_is_given_back_makes_no_smaller_pieces() {
        let bytes = vec![7; 8 * WINDOW];
        for followed in [5, WINDOW - 3, WINDOW + 9] {
            let mut count = 0;
            let mut source = Source::new(Counting(&bytes, &mut count));
            assert!(source.follow(&bytes[..followed]));
            source.unread(followed, [&bytes[..followed]].into_iter());
            while source.ensure(4) > 0 {
                let there = source.window().len();
                source.consume(there);
            }
            assert_eq!(source.offset(), bytes.len() as u64);
            drop(source);
            assert!(count <= 12, "{count} pieces after {followed} bytes");
        }
    }

    #[test]
    fn nothing_beyond_the_known_length_is_read() {
        let mut source = Source::new(&[1_u8; 50][..]).with_length(20);
        assert_eq!(source.left(), Some(20));
        assert_eq!(source.ensure(30), 20);
        assert_eq!(source.drain(u64::MAX), Some(20));
    }

    #[test]
    fn no_more_is_drained_than_allowed() {
        let mut source = Source::new(io::repeat(0));
        assert_eq!((source.drain(1_000_000), source.offset()), (None, 1_000_000));
        let mut source = Source::new(&[1_u8; 50][..]);
        assert_eq!((source.drain(49), source.drain(1)), (None, Some(1)));
    }

    #[test]
    fn the_tape_holds_what_was_consumed() {
        let bytes: Vec<u8> = (0..100).collect();
        let mut source = Source::new(&bytes[..]);
        source.ensure(30);
        source.consume(10);
        source.start_tape(vec![1, 2, 3]);
        source.consume(5);
        source.consume(5);
        assert_eq!(source.stop_tape(), &bytes[10..20]);
        source.consume(5);
        assert_eq!(source.stop_tape(), [0; 0]);
    }
}
