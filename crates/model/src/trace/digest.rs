//! Digests of traces and of their steps, as text for line-by-line comparison.
//!
//! The digest of a step is the beginning of the SHA-256 of its records' bytes, so a listing shows the step at which two
//! traces begin to differ. The digest of the trace is the SHA-256 of all its bytes, including trailing ones, as
//! `sha256sum` prints it.
use super::{
    error::{Malformation, TraceError},
    frame::Frame,
    layout::Layout,
    reader::Reader,
};
use sha2::{Digest, Sha256};
use std::{
    fmt,
    io::{self, Read},
};

/// The SHA-256 of some bytes; prints as 64 hexadecimal digits.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Sha(pub [u8; 32]);

impl fmt::Display for Sha {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl fmt::Debug for Sha {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// The first eight bytes of a SHA-256; prints as 16 hexadecimal digits.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ShortDigest(pub u64);

impl ShortDigest {
    /// Returns the first eight bytes of a digest.
    pub(super) fn from_digest(digest: Sha256) -> Self {
        let [a, b, c, d, e, f, g, h, ..] = finish(digest).0;
        Self(u64::from_be_bytes([a, b, c, d, e, f, g, h]))
    }
}

impl fmt::Display for ShortDigest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

impl fmt::Debug for ShortDigest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

fn finish(digest: Sha256) -> Sha {
    Sha(digest.finalize().into())
}

/// The digests of one trace.
///
/// The text has one line per step, with the initial record as step 0, and the whole trace last:
///
/// ```text
/// 0 8d1c1f7d7f1f6c5b
/// 1 0b5ed3c9a2f7b1aa
/// 288 bytes, 3 records, sha256 ...
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Digests {
    /// The digest of each step's records, with the initial record as step 0. An incomplete step has none.
    pub steps: Vec<ShortDigest>,
    /// The SHA-256 of all bytes.
    pub sha256: Sha,
    /// The number of all bytes.
    pub bytes: u64,
    /// The number of readable records.
    pub records: u64,
    /// The number of bytes after the last record.
    pub trailing_bytes: u64,
    /// Whether more bytes follow that were not read ([`TRAILING_LIMIT`](super::TRAILING_LIMIT)). `bytes` and `trailing`
    /// then count only the bytes that were read, and the digest is not that of the whole trace.
    pub has_more_bytes: bool,
    /// The error that ended the reading before the scene's last record.
    pub stop_error: Option<TraceError>,
}

impl Digests {
    /// Reads a whole trace, with the memory of one record and eight bytes per step. A malformed trace has digests as
    /// well: of its complete steps, and of all its bytes.
    pub fn from_stream(mut stream: impl Read, layout: Layout) -> Self {
        Self::walk(&mut stream, layout, &mut |_, _, _| {})
    }

    /// Digests a trace. `frame` is called for every record with its number, content and notes.
    pub(super) fn walk(
        stream: &mut dyn Read,
        layout: Layout,
        frame: &mut dyn FnMut(u64, &Frame, &[TraceError]),
    ) -> Self {
        let mut all = HashingReader { stream, digest: Sha256::new(), bytes: 0 };
        let mut reader = Reader::new(&mut all, layout).with_raw_bytes();
        let (mut current, mut digest, mut steps) = (Frame::default(), Sha256::new(), Vec::new());
        let stop_error = loop {
            match reader.next(&mut current) {
                Ok(true) => {}
                Ok(false) => break None,
                Err(error) => break Some(error),
            }
            let record = reader.record_count() - 1;
            frame(record, &current, reader.notes());
            digest.update(reader.raw_bytes());
            if !layout.is_mid_record(record) {
                steps.push(ShortDigest::from_digest(std::mem::take(&mut digest)));
            }
        };
        let begin = if stop_error.is_some() { reader.record_offset() } else { reader.offset() };
        let records = reader.record_count();
        let failed = reader.count_trailing_bytes().err();
        let has_more_bytes = matches!(&failed, Some(TraceError { what: Malformation::Endless { .. }, .. }));
        let end = reader.offset();
        let HashingReader { digest, bytes, .. } = all;
        // The buffer may contain a few more bytes than were read, depending on the stream.
        let bytes = if has_more_bytes { end } else { bytes };
        let (sha256, trailing, stop_error) = (finish(digest), bytes - begin, stop_error.or(failed));
        Self { steps, sha256, bytes, records, trailing_bytes: trailing, has_more_bytes, stop_error }
    }
}

impl fmt::Display for Digests {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (step, digest) in self.steps.iter().enumerate() {
            writeln!(f, "{step} {digest}")?;
        }
        if let Some(error) = &self.stop_error {
            writeln!(f, "{error}")?;
        }
        if self.has_more_bytes {
            return writeln!(f, "more than {} bytes, {} records", self.bytes, self.records);
        }
        writeln!(f, "{} bytes, {} records, sha256 {}", self.bytes, self.records, self.sha256)
    }
}

/// A stream that digests its bytes as they are read.
struct HashingReader<R> {
    stream: R,
    digest: Sha256,
    bytes: u64,
}

impl<R: Read> Read for HashingReader<R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let count = self.stream.read(out)?;
        self.digest.update(&out[..count]);
        self.bytes += count as u64;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAYOUT: Layout = Layout { particles: 1, has_impulses: false, has_polynomials: false, steps: 2 };

    #[test]
    fn a_changed_step_changes_its_digest_only() {
        let mut bytes = [0; 96];
        let sound = Digests::from_stream(&bytes[..], LAYOUT);
        assert_eq!((sound.steps.len(), sound.bytes, sound.records, sound.trailing_bytes), (3, 96, 3, 0));
        assert_eq!(sound.steps[0], sound.steps[1]);
        bytes[70] = 1;
        let changed = Digests::from_stream(&bytes[..], LAYOUT);
        assert_eq!(sound.steps[..2], changed.steps[..2]);
        assert_ne!(sound.steps[2], changed.steps[2]);
        assert_ne!(sound.sha256, changed.sha256);
    }

    #[test]
    fn the_whole_digest_is_that_of_the_file() {
        let digests = Digests::from_stream(&[0; 100][..], LAYOUT);
        assert_eq!(digests.trailing_bytes, 4);
        // This is the output of `head -c 100 /dev/zero | sha256sum`.
        let expected = "cd00e292c5970d3c5e2f0ffa5171e555bc46bfc4faddfb4a418b6840b86e79a3";
        assert_eq!(digests.sha256.to_string(), expected);
        let cut = Digests::from_stream(&[0; 50][..], LAYOUT);
        assert_eq!((cut.steps.len(), cut.records, cut.trailing_bytes, cut.bytes), (1, 1, 18, 50));
        assert!(cut.to_string().contains("byte 32, record 1 (step 1): positions and velocities need 32 bytes"));
    }
}
