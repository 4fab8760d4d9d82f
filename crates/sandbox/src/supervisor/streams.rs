//! The program's standard streams, kept up to a limit and counted to the byte.

use std::{
    io::{self, PipeReader, Read},
    os::fd::{AsFd, BorrowedFd},
    time::{Duration, Instant},
};

use crate::sys;

/// At most this much is read at one go, so that a flood does not keep the supervisor from its other watches.
const AT_ONE_GO: usize = 1 << 20;

/// One captured stream.
pub(super) struct CapturedStream {
    pipe: Option<PipeReader>,
    limit: u64,
    pub(super) bytes: Vec<u8>,
    pub(super) truncated: bool,
}

impl CapturedStream {
    /// Captures the bytes from the pipe, up to `limit` of them.
    pub(super) fn new(pipe: PipeReader, limit: u64) -> io::Result<Self> {
        sys::set_blocking(pipe.as_fd(), false)?;
        Ok(Self { pipe: Some(pipe), limit, bytes: Vec::new(), truncated: false })
    }

    /// The pipe, as long as it is open.
    pub(super) fn descriptor(&self) -> Option<BorrowedFd<'_>> {
        self.pipe.as_ref().map(AsFd::as_fd)
    }

    /// Takes the bytes that have arrived. A stream over its limit is closed and marked; the rest is dropped.
    pub(super) fn take(&mut self) {
        let Some(pipe) = &mut self.pipe else { return };
        // Memory that is touched for the first time costs more than another call, and most programs print little.
        let mut buffer = [0; 1 << 12];
        let mut taken = 0;
        while taken < AT_ONE_GO {
            match pipe.read(&mut buffer) {
                Ok(0) => {
                    self.pipe = None;
                    return;
                }
                Ok(length) => {
                    taken += length;
                    let room = usize::try_from(self.limit).unwrap_or(usize::MAX) - self.bytes.len();
                    self.bytes.extend_from_slice(&buffer[..length.min(room)]);
                    if length > room {
                        self.truncated = true;
                        self.pipe = None;
                        return;
                    }
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(_) => return,
            }
        }
    }

    /// Takes all that is left. Only called when no process is alive that could go on writing.
    pub(super) fn take_rest(&mut self) {
        while self.pipe.is_some() {
            let before = self.bytes.len();
            self.take();
            if self.bytes.len() == before {
                return;
            }
        }
    }
}

/// How long the trace pipe was full.
#[derive(Debug, Default)]
pub(super) struct Stalled {
    since: Option<Instant>,
    pub(super) total: Duration,
}

impl Stalled {
    /// Notes whether the pipe is full now. The time between two looks counts when it was at both.
    pub(super) fn look(&mut self, full: bool, now: Instant) {
        if let Some(since) = self.since.filter(|_| full) {
            self.total += now.saturating_duration_since(since);
        }
        self.since = full.then_some(now);
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
            capture.take();
            writer.write_all(b"abcdef").unwrap();
            drop(writer);
            capture.take_rest();
            assert_eq!(capture.bytes, b"abcdef"[..limit as usize]);
            assert_eq!(capture.truncated, truncated);
            assert!(capture.descriptor().is_none());
        }
    }

    #[test]
    fn only_time_between_two_looks_at_a_full_pipe_is_given_back() {
        let start = Instant::now();
        let mut stalled = Stalled::default();
        for (milliseconds, full) in
            [(0, false), (10, true), (20, true), (35, true), (40, false), (50, true), (60, false)]
        {
            stalled.look(full, start + Duration::from_millis(milliseconds));
        }
        assert_eq!(stalled.total, Duration::from_millis(25));
    }
}
