//! Reads dropped files piece by piece. Compressed traces are decompressed.
use fosssim_judge::replay::{Progress, Remark};
use ruzstd::decoding::{FrameDecoder, StreamingDecoder};
use std::{
    io::{self, BufRead, BufReader, Read},
    mem,
    sync::OnceLock,
};

/// The number of bytes that are requested from the browser in one call. Each call takes about 0.1 ms.
const CHUNK_BYTES: usize = 1 << 20;

/// The first bytes of each frame in a zstd file.
const ZSTD_MAGIC: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// The reason why a file cannot be read to its end, and what the user can do.
pub(crate) type ReadFault = OnceLock<&'static str>;

/// The functions of the page that requests may call.
pub trait PageHost: Sync {
    /// Reads bytes of a dropped file, beginning at an offset. Returns the number of bytes that were read, which is 0 at
    /// the end of the file; `None` if the file cannot be read.
    fn read(&self, file: u32, offset: u64, into: &mut [u8]) -> Option<usize>;

    /// Reports the progress of a request: the number of completed steps, and the total number of steps.
    fn progress(&self, done: u32, all: u32);
}

/// Passes the progress of judging on to the page.
pub(crate) struct PageProgress<'a> {
    pub(crate) host: &'a dyn PageHost,
    pub(crate) all: u32,
}

impl Progress for PageProgress<'_> {
    fn observe_step_end(&mut self, step: u32, _: &[Remark]) {
        self.host.progress(step, self.all);
    }
}

/// Returns a reader of a dropped trace. If the file is compressed with zstd, it is decompressed.
pub(crate) fn open<'a>(host: &'a dyn PageHost, file: u32, fault: &'a ReadFault) -> Box<dyn Read + Send + 'a> {
    let mut bytes = BufReader::with_capacity(CHUNK_BYTES, DroppedFile { host, file, offset: 0, fault });
    // If a file cannot be read, this is reported when it is read.
    match bytes.fill_buf() {
        Ok(start) if start.starts_with(&ZSTD_MAGIC) => Box::new(ZstdReader { frames: Frames::Next(bytes), fault }),
        _ => Box::new(bytes),
    }
}

/// Reads a dropped file from its beginning to its end.
struct DroppedFile<'a> {
    host: &'a dyn PageHost,
    file: u32,
    offset: u64,
    fault: &'a ReadFault,
}

impl Read for DroppedFile<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let Some(count) = self.host.read(self.file, self.offset, into) else {
            let _ = self.fault.set("the file was changed or removed; drop it again");
            return Err(io::Error::other("the browser can no longer read the file"));
        };
        self.offset += count as u64;
        Ok(count)
    }
}

/// Decompresses a zstd file. If the compressed data is damaged, the error is about this copy of the file, not about the
/// trace.
struct ZstdReader<'a> {
    frames: Frames<BufReader<DroppedFile<'a>>>,
    fault: &'a ReadFault,
}

/// A zstd file as a sequence of frames, and the position in it.
enum Frames<R: Read> {
    /// The position is before the next frame.
    Next(R),
    /// The position is within a frame.
    Within(Box<StreamingDecoder<R, FrameDecoder>>),
    /// The position is after the last byte.
    End,
}

impl Read for ZstdReader<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        self.frames.read(into).inspect_err(|_| {
            // If the file cannot be read, this has been reported already, and explains more.
            let _ = self.fault.set("the zstd data is cut short or damaged; copy it again");
        })
    }
}

impl<R: BufRead> Frames<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        loop {
            *self = match mem::replace(self, Self::End) {
                Self::End => return Ok(0),
                Self::Next(mut bytes) => {
                    if bytes.fill_buf()?.is_empty() {
                        return Ok(0);
                    }
                    Self::Within(Box::new(StreamingDecoder::new(bytes).map_err(io::Error::other)?))
                }
                Self::Within(mut frame) => {
                    let count = frame.read(into)?;
                    if count > 0 || into.is_empty() {
                        *self = Self::Within(frame);
                        return Ok(count);
                    }
                    let (bytes, decoder) = frame.into_parts();
                    let (stored, computed) = (decoder.get_checksum_from_data(), decoder.get_calculated_checksum());
                    if stored.is_some() && stored != computed {
                        return Err(io::Error::other(
                            "the decompressed content does not match its checksum; copy the file again",
                        ));
                    }
                    Self::Next(bytes)
                }
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Bytes(Vec<u8>);

    impl PageHost for Bytes {
        fn read(&self, _: u32, offset: u64, into: &mut [u8]) -> Option<usize> {
            let rest = &self.0[usize::try_from(offset).ok()?.min(self.0.len())..];
            let count = rest.len().min(into.len()).min(1000);
            into[..count].copy_from_slice(&rest[..count]);
            Some(count)
        }

        fn progress(&self, _: u32, _: u32) {}
    }

    fn content(bytes: Vec<u8>) -> (Vec<u8>, Option<&'static str>) {
        let (fault, host, mut content) = (ReadFault::new(), Bytes(bytes), Vec::new());
        let _ = open(&host, 0, &fault).read_to_end(&mut content);
        (content, fault.get().copied())
    }

    #[test]
    fn packed_traces_are_read_like_others_and_damaged_ones_are_told() {
        let trace: Vec<u8> = (0..100_000_u32).flat_map(|k| (k / 7 * k).to_le_bytes()).collect();
        let pack = |bytes: &[u8]| {
            let mut encoder = zstd::Encoder::new(Vec::new(), 3).expect("an encoder");
            encoder.include_checksum(true).expect("checksums");
            io::Write::write_all(&mut encoder, bytes).expect("packed");
            encoder.finish().expect("packed")
        };
        assert_eq!(content(trace.clone()), (trace.clone(), None));
        let packed = pack(&trace);
        assert_eq!(content(packed.clone()), (trace.clone(), None));
        // Two frames form one content.
        let (one, other) = trace.split_at(1000);
        assert_eq!(content([pack(one), pack(other)].concat()), (trace, None));
        let damaged = |bytes: Vec<u8>| content(bytes).1.expect("it is told").contains("cut short or damaged");
        assert!(damaged(packed[..packed.len() / 2].to_vec()));
        let mut other = packed.clone();
        let last = other.len() - 1;
        other[last] ^= 1;
        assert!(damaged(other), "the checksum is another one");
        assert!(damaged([packed, b"more".to_vec()].concat()));
    }
}
