//! Limits the bytes that all readers of an archive may read together, so that an archive cannot keep them reading
//! forever.
use std::{
    cell::Cell,
    io::{self, Read, Seek, SeekFrom},
    rc::Rc,
};

/// The total number of bytes that the readers may still read.
#[derive(Debug, Clone)]
pub(crate) struct Meter(Rc<Cell<u64>>);

/// A reader that fails when its meter has no bytes left.
#[derive(Debug)]
pub(crate) struct MeteredReader<R> {
    inner: R,
    meter: Meter,
}

impl Meter {
    /// Creates a meter that allows `bytes` bytes.
    pub(crate) fn new(bytes: u64) -> Self {
        Self(Rc::new(Cell::new(bytes)))
    }

    /// Sets the number of bytes that are still allowed.
    pub(crate) fn set(&self, bytes: u64) {
        self.0.set(bytes);
    }

    /// Returns a reader whose bytes this meter counts.
    pub(crate) fn reader<R>(&self, inner: R) -> MeteredReader<R> {
        MeteredReader { inner, meter: self.clone() }
    }
}

impl<R: Read> Read for MeteredReader<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.inner.read(buffer)?;
        let Some(left) = self.meter.0.get().checked_sub(read as u64) else {
            return Err(io::Error::other(
                "reading the archive takes too much work for its content; it may be an archive bomb",
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
