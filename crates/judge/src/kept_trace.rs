//! Keeps the beginning of a trace that can be read only once, because explanations and pictures read it again.
use std::io::{self, Read};

/// The maximum number of kept bytes. The course's largest trace has 18 MB. A lower limit leaves mistakes in longer
/// traces unexplained; a higher limit lets each job of a class take more memory.
pub const MAX_KEPT_BYTES: usize = 64 << 20;

/// The kept beginning of a trace. It stays valid if judging panics.
#[derive(Debug)]
pub struct KeptTrace {
    bytes: Vec<u8>,
    max_bytes: usize,
    has_ended: bool,
    is_cut: bool,
}

impl KeptTrace {
    /// Creates a store for at most `max_bytes` bytes. A small number suits a trace that is not needed again.
    pub const fn new(max_bytes: usize) -> Self {
        Self { bytes: Vec::new(), max_bytes, has_ended: false, is_cut: false }
    }

    /// Returns a reader of the trace that keeps what it reads.
    pub fn keep_from<R>(&mut self, trace: R) -> KeepingReader<'_, R> {
        KeepingReader { trace: self, inner: trace }
    }

    /// Returns the kept bytes.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Returns whether the whole trace was kept.
    pub const fn is_whole(&self) -> bool {
        self.has_ended && !self.is_cut
    }
}

/// A reader that keeps the bytes of the trace.
#[derive(Debug)]
pub struct KeepingReader<'k, R> {
    trace: &'k mut KeptTrace,
    inner: R,
}

impl<R: Read> Read for KeepingReader<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(buffer)?;
        let room = self.trace.max_bytes - self.trace.bytes.len();
        self.trace.bytes.extend_from_slice(&buffer[..count.min(room)]);
        self.trace.is_cut |= count > room;
        self.trace.has_ended |= count == 0 && !buffer.is_empty();
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kept_part_is_limited_and_the_rest_is_forwarded() {
        let trace: Vec<u8> = (0..100).collect();
        for (most, is_whole) in [(101, true), (100, true), (99, false), (0, false)] {
            let mut kept = KeptTrace::new(most);
            let mut start = [0; 30];
            kept.keep_from(&trace[..]).read_exact(&mut start).expect("there");
            assert!(!kept.is_whole());
            let mut rest = Vec::new();
            kept.keep_from(&trace[30..]).read_to_end(&mut rest).expect("there");
            assert_eq!((start.as_slice(), rest.as_slice()), (&trace[..30], &trace[30..]));
            assert_eq!((kept.bytes(), kept.is_whole()), (&trace[..most.min(100)], is_whole));
        }
    }
}
