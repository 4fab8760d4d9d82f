//! Files that were dropped on the page, read piece by piece.
use std::{
    io::{self, Read},
    sync::atomic::{AtomicBool, Ordering},
};

/// How many bytes the browser is asked for at once: each call takes some 0.1 ms.
pub(crate) const PIECE: usize = 1 << 20;

/// The page, as far as requests need it.
pub trait PageHost: Sync {
    /// Reads bytes of the dropped file of this number from an offset on. Returns how many; 0 at the file's end, `None`
    /// when it can't be read.
    fn read(&self, file: u32, offset: u64, into: &mut [u8]) -> Option<usize>;

    /// Is told how far a request is: how many steps of all are done.
    fn progress(&self, done: u32, all: u32);
}

/// A dropped file from its beginning.
pub(crate) struct Dropped<'a> {
    host: &'a dyn PageHost,
    file: u32,
    offset: u64,
    failed: &'a AtomicBool,
}

impl<'a> Dropped<'a> {
    /// The file of this number; `failed` becomes true when it can't be read.
    pub(crate) fn new(host: &'a dyn PageHost, file: u32, failed: &'a AtomicBool) -> Self {
        Self { host, file, offset: 0, failed }
    }
}

impl Read for Dropped<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let Some(count) = self.host.read(self.file, self.offset, into) else {
            self.failed.store(true, Ordering::Relaxed);
            return Err(io::Error::other("the browser can't read the file any more"));
        };
        self.offset += count as u64;
        Ok(count)
    }
}
