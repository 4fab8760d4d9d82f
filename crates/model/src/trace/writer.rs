//! Frames to bytes.
//!
//! [`Writer`] gathers records in a buffer and hands them to any `Write` in large pieces, so the stream below needs no
//! buffer of its own. It counts what it wrote, keeps the first I/O error until [`Writer::finish`], and checks nothing:
//! damaged traces for tests can be written, too.
use super::{encode, frame::Frame, layout::Layout, log::Log};
use crate::sim::State;
use std::io::{self, Write};

/// The buffer is handed on once it holds this many bytes.
const PIECE: usize = 256 * 1024;

/// What has been written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Written {
    /// Records.
    pub records: u64,
    /// Bytes.
    pub bytes: u64,
}

/// Writes records to a stream (trace-format.md 1).
#[derive(Debug)]
pub struct Writer<W: Write> {
    stream: W,
    layout: Layout,
    buffer: Vec<u8>,
    written: Written,
    error: Option<io::Error>,
}

impl<W: Write> Writer<W> {
    /// A writer of records with the blocks of `layout`.
    pub fn new(stream: W, layout: Layout) -> Self {
        Self { stream, layout, buffer: Vec::with_capacity(2 * PIECE), written: Written::default(), error: None }
    }

    /// Writes one frame; lists that the layout has no room for are left out.
    pub fn frame(&mut self, frame: &Frame) {
        self.begin(&frame.state);
        if self.layout.impulses {
            encode::count(&mut self.buffer, frame.impulses.len());
            for impulse in &frame.impulses {
                encode::impulse(&mut self.buffer, impulse);
            }
        }
        if self.layout.polynomials {
            encode::count(&mut self.buffer, frame.polynomials.len());
            encode::polynomials(&mut self.buffer, &frame.polynomials);
        }
        self.end();
    }

    /// Writes one record whose lists are encoded already. A long list goes to the stream as it is, without a copy.
    pub(super) fn record(&mut self, state: &State, log: &Log) {
        self.begin(state);
        if self.layout.impulses {
            encode::count(&mut self.buffer, log.impulses.count);
            self.buffer.extend_from_slice(&log.impulses.bytes);
        }
        if self.layout.polynomials {
            encode::count(&mut self.buffer, log.polynomials.count());
            let polynomials = log.polynomials.bytes();
            if polynomials.len() < PIECE {
                self.buffer.extend_from_slice(polynomials);
            } else {
                self.hand_on();
                self.pass_on(polynomials);
            }
        }
        self.end();
    }

    /// What has been written so far, what is still in the buffer included.
    #[must_use]
    pub fn written(&self) -> Written {
        Written { records: self.written.records, bytes: self.written.bytes + self.buffer.len() as u64 }
    }

    /// Whether writing has failed; what follows is thrown away then.
    #[must_use]
    pub fn failed(&self) -> bool {
        self.error.is_some()
    }

    /// Writes what is left, flushes, and gives the stream back.
    ///
    /// # Errors
    /// The first error that the stream reported, now or earlier.
    pub fn finish(mut self) -> io::Result<(W, Written)> {
        self.hand_on();
        if let Some(error) = self.error {
            return Err(error);
        }
        self.stream.flush()?;
        Ok((self.stream, self.written))
    }

    fn begin(&mut self, state: &State) {
        encode::state(&mut self.buffer, state);
    }

    fn end(&mut self) {
        self.written.records += 1;
        if self.buffer.len() >= PIECE {
            self.hand_on();
        }
    }

    fn hand_on(&mut self) {
        let buffer = std::mem::take(&mut self.buffer);
        self.pass_on(&buffer);
        self.buffer = buffer;
        self.buffer.clear();
    }

    /// Writes to the stream, past the buffer, which is empty or on its way.
    fn pass_on(&mut self, bytes: &[u8]) {
        if self.error.is_none() {
            match self.stream.write_all(bytes) {
                Ok(()) => self.written.bytes += bytes.len() as u64,
                Err(error) => self.error = Some(error),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stream with room for so many bytes.
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
        Layout { particles: 1, impulses: false, polynomials: false, steps: 3 }
    }

    fn frame() -> Frame {
        let state = State { positions: vec![1.0, 2.0], velocities: vec![3.0, 4.0] };
        Frame { state, ..Frame::default() }
    }

    #[test]
    fn counts_records_and_bytes() {
        let mut writer = Writer::new(Vec::new(), layout());
        writer.frame(&frame());
        writer.frame(&frame());
        assert_eq!(writer.written(), Written { records: 2, bytes: 64 });
        let (bytes, written) = writer.finish().unwrap();
        assert_eq!(bytes.len(), 64);
        assert_eq!(written, Written { records: 2, bytes: 64 });
        assert_eq!(bytes[24..32], 4.0_f64.to_le_bytes());
    }

    #[test]
    fn an_error_of_the_stream_is_kept_until_the_end() {
        let mut writer = Writer::new(Full(40), layout());
        for _ in 0..3 * PIECE / 32 {
            writer.frame(&frame());
        }
        assert!(writer.failed());
        assert_eq!(writer.finish().err().unwrap().to_string(), "no space left");
    }
}
