//! Limits reading for all readers together, so that an archive cannot occupy its readers forever.
use std::{
    cell::Cell,
    io::{self, Read, Seek, SeekFrom},
    rc::Rc,
};

/// The number of bytes that may still be read.
#[derive(Debug, Clone)]
pub(crate) struct Meter(Rc<Cell<u64>>);

/// A reader that fails when the bytes of its meter are used up.
#[derive(Debug)]
pub(crate) struct MeteredReader<R> {
    inner: R,
    meter: Meter,
}

impl Meter {
    /// Creates a limit of `bytes` bytes.
    pub(crate) fn new(bytes: u64) -> Self {
        Self(Rc::new(Cell::new(bytes)))
    }

    /// Sets the remaining limit to `bytes` bytes.
    pub(crate) fn set(&self, bytes: u64) {
        self.0.set(bytes);
    }

    /// Returns a reader that counts for this meter.
    pub(crate) fn reader<R>(&self, inner: R) -> MeteredReader<R> {
        MeteredReader { inner, meter: self.clone() }
    }
}

impl<R: Read> Read for MeteredReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.inner.read(buffer)?;
        let Some(left) = self.meter.0.get().checked_sub(read as u64) else {
            return Err(io::Error::other(
                "the archive takes too much work to read for its content (a possible archive bomb)",
            ));
        };
        self.meter.0.set(left);
        Ok(read)
    }
}

impl<R: Seek> Seek for MeteredReader<R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.inner.seek(to)
    }
}
