//! Captures the standard streams of a program, up to a limit.

use std::{
    io::{self, PipeReader, Read},
    os::fd::{AsFd, BorrowedFd},
};

use crate::sys;

/// The maximum number of bytes that are read at a time, because a flood of output must not block the supervisor.
const BYTES_PER_COPY: usize = 1 << 20;

/// A stream of which the first bytes are kept.
pub(super) struct CapturedStream {
    pipe: Option<PipeReader>,
    limit: u64,
    pub(super) bytes: Vec<u8>,
    pub(super) truncated: bool,
}

impl CapturedStream {
    /// Creates a stream that keeps at most `limit` bytes from a pipe.
    pub(super) fn new(pipe: PipeReader, limit: u64) -> io::Result<Self> {
        sys::set_blocking(pipe.as_fd(), false)?;
        Ok(Self { pipe: Some(pipe), limit, bytes: Vec::new(), truncated: false })
    }

    /// Returns the pipe, as long as it is open.
    pub(super) fn descriptor(&self) -> Option<BorrowedFd<'_>> {
        self.pipe.as_ref().map(AsFd::as_fd)
    }

    /// Reads the bytes that have arrived, and returns whether there were any. Bytes beyond the limit are dropped, and
    /// the stream is then marked as truncated.
    pub(super) fn read_available(&mut self) -> bool {
        let Some(pipe) = &mut self.pipe else { return false };
        // Touching memory for the first time takes longer than another call, and most programs print little.
        let (mut small, mut large) = ([0; 1 << 12], Vec::new());
        let buffer = if self.truncated {
            large.resize(BYTES_PER_COPY / 16, 0);
            &mut large[..]
        } else {
            &mut small[..]
        };
        let mut received_bytes = 0;
        while received_bytes < BYTES_PER_COPY {
            match pipe.read(buffer) {
                Ok(0) => {
                    self.pipe = None;
                    break;
                }
                Ok(length) => {
                    received_bytes += length;
                    let room = usize::try_from(self.limit).unwrap_or(usize::MAX) - self.bytes.len();
                    self.bytes.extend_from_slice(&buffer[..length.min(room)]);
                    self.truncated |= length > room;
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(_) => break,
            }
        }
        received_bytes > 0
    }

    /// Reads the rest of the stream. This must be called only when no process is alive that could still write.
    pub(super) fn read_rest(&mut self) {
        while self.pipe.is_some() && self.read_available() {}
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    #[test]
    fn a_stream_is_cut_at_its_limit_to_the_byte() {
        for (limit, truncated) in [(6, false), (5, true), (0, true)] {
            let (reader, mut writer) = io::pipe().unwrap();
            let mut capture = CapturedStream::new(reader, limit).unwrap();
            capture.read_available();
            writer.write_all(b"abcdef").unwrap();
            drop(writer);
            capture.read_rest();
            assert_eq!(capture.bytes, b"abcdef"[..limit as usize]);
            assert_eq!(capture.truncated, truncated);
            assert!(capture.descriptor().is_none());
        }
    }
}
