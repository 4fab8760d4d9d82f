//! Random access to the records of a seekable trace.
//!
//! Records have no length fields, so [`Indexed::open`] walks the whole trace once. It keeps the offset of every k-th
//! record, with k such that the table stays small; a look-up walks on from the nearest one.
use super::{error::TraceError, frame::Frame, layout::Layout, reader::Reader};
use std::io::{Read, Seek};

/// The table never has more entries than this (8 MiB).
const ENTRIES: usize = 1 << 20;

/// A trace whose records can be read in any order. For a trace in memory use a [`std::io::Cursor`].
#[derive(Debug)]
pub struct Indexed<R> {
    reader: Reader<R>,
    offsets: Vec<u64>,
    /// The distance of records that are in the table.
    stride: u64,
    records: u64,
    end: u64,
    stopped: Option<TraceError>,
}

impl<R: Read + Seek> Indexed<R> {
    /// Walks the trace once. A malformed record ends the walk: the records before it can be read, and
    /// [`Indexed::stopped`] says what is wrong.
    pub fn open(stream: R, layout: Layout) -> Self {
        Self::with_entries(stream, layout, ENTRIES)
    }

    fn with_entries(stream: R, layout: Layout, entries: usize) -> Self {
        let mut reader = Reader::new(stream, layout);
        reader.seek(0, 0);
        let (mut offsets, mut stride) = (Vec::new(), 1);
        let mut frame = Frame::default();
        let stopped = loop {
            match reader.next(&mut frame) {
                Ok(true) => {}
                Ok(false) => break None,
                Err(error) => break Some(error),
            }
            let record = reader.records() - 1;
            if record.is_multiple_of(stride) {
                if offsets.len() == entries {
                    offsets = offsets.into_iter().step_by(2).collect();
                    stride *= 2;
                }
                if record.is_multiple_of(stride) {
                    offsets.push(reader.record_offset());
                }
            }
        };
        let end = if stopped.is_some() { reader.record_offset() } else { reader.offset() };
        Self { records: reader.records(), end, reader, offsets, stride, stopped }
    }

    /// Number of records that can be read.
    #[must_use]
    pub fn records(&self) -> u64 {
        self.records
    }

    /// Byte offset behind the last of them.
    #[must_use]
    pub fn end(&self) -> u64 {
        self.end
    }

    /// Why the walk ended before the scene's last record.
    #[must_use]
    pub fn stopped(&self) -> Option<&TraceError> {
        self.stopped.as_ref()
    }

    /// Replaces `frame` by record `record` (from 0) and gives its byte offset, or nothing when there is no such record.
    ///
    /// # Errors
    /// [`TraceError`], when the stream has changed or fails.
    pub fn frame_at(&mut self, record: u64, frame: &mut Frame) -> Result<Option<u64>, TraceError> {
        if record >= self.records {
            return Ok(None);
        }
        // Going on from where the reader stands saves a walk when records are asked for in order.
        let near = record - record % self.stride;
        if !(near..=record).contains(&self.reader.records()) {
            let entry = usize::try_from(record / self.stride).expect("a small table");
            self.reader.seek(near, self.offsets[entry]);
        }
        while self.reader.records() <= record {
            self.reader.next(frame)?;
        }
        Ok(Some(self.reader.record_offset()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{sim::State, trace::Writer};
    use std::io::Cursor;

    const LAYOUT: Layout = Layout { particles: 1, impulses: true, polynomials: true, steps: 20 };

    /// A trace whose records have different lengths and their number as first position.
    fn trace() -> (Vec<u8>, Vec<u64>) {
        let mut writer = Writer::new(Vec::new(), LAYOUT);
        let mut offsets = Vec::new();
        for record in 0..LAYOUT.records() {
            offsets.push(writer.written().bytes);
            let state = State { positions: vec![record as f64, 0.0], velocities: vec![0.0; 2] };
            let mut frame = Frame { state, ..Frame::default() };
            (0..record % 7).for_each(|k| frame.polynomials.push(&[1.0, 2.0, 3.0][..k as usize % 4]));
            writer.frame(&frame);
        }
        (writer.finish().unwrap().0, offsets)
    }

    #[test]
    fn every_record_is_found_in_any_order() {
        let (bytes, offsets) = trace();
        let mut frame = Frame::default();
        for entries in [2, 3, 8, 1000] {
            let mut indexed = Indexed::with_entries(Cursor::new(&bytes), LAYOUT, entries);
            assert_eq!((indexed.records(), indexed.end()), (41, bytes.len() as u64));
            assert!(indexed.stopped().is_none());
            for record in (0..41).rev().chain(0..41).chain((0..41).map(|k| k * 7 % 41)) {
                let offset = indexed.frame_at(record, &mut frame).unwrap();
                assert_eq!(offset, Some(offsets[record as usize]), "record {record}, {entries} entries");
                assert_eq!(frame.state.positions[0], record as f64);
            }
            assert_eq!(indexed.frame_at(41, &mut frame).unwrap(), None);
        }
    }

    #[test]
    fn the_sound_part_of_a_damaged_trace_can_be_read() {
        let (bytes, offsets) = trace();
        let mut indexed = Indexed::open(Cursor::new(&bytes[..offsets[10] as usize + 5]), LAYOUT);
        assert_eq!((indexed.records(), indexed.end()), (10, offsets[10]));
        assert_eq!(indexed.stopped().unwrap().frame, 10);
        let mut frame = Frame::default();
        assert!(indexed.frame_at(9, &mut frame).unwrap().is_some());
        assert!(indexed.frame_at(10, &mut frame).unwrap().is_none());
    }
}
