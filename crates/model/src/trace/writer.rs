//! Writes frames as bytes.
//!
//! [`Writer`] collects records and writes them to any `Write` in large pieces, so the stream needs no buffer. Short
//! data is copied into a buffer; a recorder's long lists are not copied. It counts the bytes and records, and keeps the
//! first I/O error until [`Writer::finish`]. It checks nothing, so tests can write damaged traces.
use super::{encode, frame::Frame, layout::Layout, log::Log};
use crate::sim::State;
use std::{
    io::{self, ErrorKind, IoSlice, Write},
    ops::Range,
};

/// The size in bytes at which collected bytes are written.
const PIECE_BYTES: usize = 256 * 1024;

/// The size in bytes from which a list is not copied; for a shorter list, a separate part would cost the system more
/// than a copy.
const LONG_LIST_BYTES: usize = 1024;

/// The maximum number of long lists that are collected.
const MAX_LISTS: usize = 128;

/// The numbers of bytes and records written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WrittenTrace {
    /// The number of records.
    pub records: u64,
    /// The number of bytes.
    pub bytes: u64,
}

/// Writes records to a stream (trace-format.md 1).
#[derive(Debug)]
pub struct Writer<W: Write> {
    stream: W,
    layout: Layout,
    buffer: Vec<u8>,
    /// The long lists that are not in the buffer: their positions in it, and their ranges among the log's polynomials.
    lists: Vec<(usize, Range<usize>)>,
    /// The number of bytes of the lists.
    listed_bytes: usize,
    written: WrittenTrace,
    error: Option<io::Error>,
}

impl<W: Write> Writer<W> {
    /// Creates a writer of records with the blocks of `layout`.
    pub fn new(stream: W, layout: Layout) -> Self {
        Self {
            stream,
            layout,
            buffer: Vec::with_capacity(2 * PIECE_BYTES),
            lists: Vec::with_capacity(MAX_LISTS),
            listed_bytes: 0,
            written: WrittenTrace::default(),
            error: None,
        }
    }

    /// Writes one frame. Lists that the layout does not have are left out.
    pub fn write_frame(&mut self, frame: &Frame) {
        encode::append_state(&mut self.buffer, &frame.state);
        if self.layout.has_impulses {
            encode::append_count(&mut self.buffer, frame.impulses.len());
            for impulse in &frame.impulses {
                encode::encode_impulse(&mut self.buffer, impulse);
            }
        }
        if self.layout.has_polynomials {
            encode::append_count(&mut self.buffer, frame.polynomials.len());
            frame.polynomials.iter().for_each(|polynomial| encode::encode_polynomial(&mut self.buffer, polynomial));
        }
        self.written.records += 1;
        if self.is_full() {
            self.write_collected(&[]);
        }
    }

    /// Writes one record with encoded lists. While lists are [unwritten](Self::has_unwritten), the log keeps its
    /// polynomials. Once the writer is [full](Self::is_full), it takes two more records, then they must be written.
    pub(super) fn write_record(&mut self, state: &State, log: &Log) {
        log.write_head(&mut self.buffer, self.layout, state);
        if self.layout.has_polynomials {
            let polynomials = log.polynomials.bytes();
            if polynomials.len() < LONG_LIST_BYTES {
                self.buffer.extend_from_slice(polynomials);
            } else {
                self.lists.push((self.buffer.len(), log.polynomials.range()));
                self.listed_bytes += polynomials.len();
            }
        }
        self.written.records += 1;
    }

    /// Returns whether enough is collected to be written.
    pub(super) fn is_full(&self) -> bool {
        self.buffer.len() + self.listed_bytes >= PIECE_BYTES || self.lists.len() + 2 > MAX_LISTS
    }

    /// Returns whether polynomials of the log have not been written.
    pub(super) fn has_unwritten(&self) -> bool {
        !self.lists.is_empty()
    }

    /// Returns the bytes and records written so far, including those in the buffer.
    pub fn written_trace(&self) -> WrittenTrace {
        WrittenTrace {
            records: self.written.records,
            bytes: self.written.bytes + (self.buffer.len() + self.listed_bytes) as u64,
        }
    }

    /// Returns whether writing has failed. Later bytes are then dropped.
    pub fn has_failed(&self) -> bool {
        self.error.is_some()
    }

    /// Writes the rest, flushes, and returns the stream.
    ///
    /// # Errors
    /// Fails with the first error that the stream reported, now or earlier.
    pub fn finish(mut self) -> io::Result<(W, WrittenTrace)> {
        self.write_collected(&[]);
        if let Some(error) = self.error {
            return Err(error);
        }
        self.stream.flush()?;
        Ok((self.stream, self.written))
    }

    /// Writes the collected records; `polynomials` are those of the log.
    pub(super) fn write_collected(&mut self, polynomials: &[u8]) {
        let bytes = (self.buffer.len() + self.listed_bytes) as u64;
        if self.error.is_none() && bytes > 0 {
            let mut parts = [IoSlice::new(&[]); 2 * MAX_LISTS + 1];
            let (mut count, mut begin) = (0, 0);
            for (end, list) in &self.lists {
                parts[count] = IoSlice::new(&self.buffer[begin..*end]);
                parts[count + 1] = IoSlice::new(&polynomials[list.clone()]);
                (count, begin) = (count + 2, *end);
            }
            parts[count] = IoSlice::new(&self.buffer[begin..]);
            match write_all(&mut self.stream, &mut parts[..=count]) {
                Ok(()) => self.written.bytes += bytes,
                Err(error) => self.error = Some(error),
            }
        }
        self.buffer.clear();
        self.lists.clear();
        self.listed_bytes = 0;
    }
}

/// Writes all parts. (`Write::write_all_vectored` is not stable.)
fn write_all(stream: &mut impl Write, mut parts: &mut [IoSlice<'_>]) -> io::Result<()> {
    // Parts without bytes are skipped.
    IoSlice::advance_slices(&mut parts, 0);
    while !parts.is_empty() {
        match stream.write_vectored(parts) {
            Ok(0) => return Err(ErrorKind::WriteZero.into()),
            Ok(written) => IoSlice::advance_slices(&mut parts, written),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stream with room for a limited number of bytes.
    struct Full(usize);

    impl Write for Full {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let taken = bytes.len().min(self.0);
            self.0 -= taken;
            if taken == 0 { Err(io::Error::other("no space left")) } else { Ok(taken) }
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn layout() -> Layout {
        Layout { particles: 1, has_impulses: false, has_polynomials: false, steps: 3 }
    }

    fn frame() -> Frame {
        let state = State { positions: vec![1.0, 2.0], velocities: vec![3.0, 4.0] };
        Frame { state, ..Frame::default() }
    }

    #[test]
    fn counts_records_and_bytes() {
        let mut writer = Writer::new(Vec::new(), layout());
        writer.write_frame(&frame());
        writer.write_frame(&frame());
        assert_eq!(writer.written_trace(), WrittenTrace { records: 2, bytes: 64 });
        let (bytes, written) = writer.finish().unwrap();
        assert_eq!(bytes.len(), 64);
        assert_eq!(written, WrittenTrace { records: 2, bytes: 64 });
        assert_eq!(bytes[24..32], 4.0_f64.to_le_bytes());
    }

    /// A stream that accepts only a few bytes at a time.
    struct Slow(Vec<u8>);

    impl Write for Slow {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.write(&bytes[..bytes.len().min(7)])
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_stream_that_takes_little_at_a_time_gets_all() {
        let (parts, all) = ([&b""[..], b"a part of sixteen", b"", b"another one"], b"a part of sixteenanother one");
        let mut stream = Slow(Vec::new());
        write_all(&mut stream, &mut parts.map(IoSlice::new)).unwrap();
        assert_eq!(stream.0, all);
        write_all(&mut stream, &mut []).unwrap();
        assert_eq!(write_all(&mut Full(20), &mut parts.map(IoSlice::new)).unwrap_err().to_string(), "no space left");
    }

    #[test]
    fn an_error_of_the_stream_is_kept_until_the_end() {
        let mut writer = Writer::new(Full(40), layout());
        for _ in 0..3 * PIECE_BYTES / 32 {
            writer.write_frame(&frame());
        }
        assert!(writer.has_failed());
        assert_eq!(writer.finish().err().unwrap().to_string(), "no space left");
    }
}
