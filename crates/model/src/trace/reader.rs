//! The strict reader, which is a [`LenientReader`] that stops at the first damage.
//!
//! For traces of any size, memory is bounded by one frame, and grows only with bytes that arrive.
use super::{
    error::{RecordList, TraceError, TraceFormatError},
    frame::{Frame, LoggedImpulse},
    layout::Layout,
    lenient::{LenientFrame, LenientReader, MAX_NOTES},
};
use crate::{scene::Scene, sim::PairKind};
use std::{io::Read, mem::swap};

/// Reads a trace frame by frame (trace-format.md 1, 2).
///
/// ```
/// use fosssim_model::trace::{Frame, Layout, Reader};
///
/// // Two records of one particle without lists: 32 bytes each.
/// let layout = Layout { particles: 1, has_impulses: false, has_polynomials: false, steps: 1 };
/// let mut reader = Reader::from_slice(&[0; 64], layout);
/// let mut frame = Frame::default();
/// let mut frames = 0;
/// while reader.next(&mut frame)? {
///     frames += 1;
/// }
/// assert_eq!(frames, 2);
/// assert_eq!(reader.offset(), 64);
/// # Ok::<(), fosssim_model::trace::TraceError>(())
/// ```
#[derive(Debug)]
pub struct Reader<R> {
    records: LenientReader<R>,
    frame: LenientFrame,
    layout: Layout,
    /// The numbers of edges and half-planes of the scene, if known.
    objects: Option<(usize, usize)>,
    notes: Vec<TraceError>,
    stop_error: Option<TraceError>,
}

impl<'a> Reader<&'a [u8]> {
    /// Returns a reader of a trace in memory.
    pub fn from_slice(trace: &'a [u8], layout: Layout) -> Self {
        Self::from_lenient(LenientReader::from_slice(trace, layout), layout)
    }
}

impl<R: Read> Reader<R> {
    /// Creates a reader at the beginning of `stream`, which needs no buffer of its own.
    pub fn new(stream: R, layout: Layout) -> Self {
        Self::from_lenient(LenientReader::new(stream, layout), layout)
    }

    fn from_lenient(records: LenientReader<R>, layout: Layout) -> Self {
        Self {
            records: records.into_strict(),
            frame: LenientFrame::default(),
            layout,
            objects: None,
            notes: Vec::new(),
            stop_error: None,
        }
    }

    /// Lets the reader report impulses whose edges or half-planes do not exist in the scene.
    #[must_use]
    pub fn with_scene(mut self, scene: &Scene) -> Self {
        self.objects = Some((scene.edges.len(), scene.half_planes.len()));
        self
    }

    /// Replaces `frame` by the next record. Returns false after the scene's last record.
    ///
    /// # Errors
    /// Fails with a [`TraceError`] if the trace is invalid. Every later call returns the same error.
    pub fn next(&mut self, frame: &mut Frame) -> Result<bool, TraceError> {
        if let Some(error) = &self.stop_error {
            return Err(error.clone());
        }
        self.notes.clear();
        if self.record_count() == self.layout.records() {
            return Ok(false);
        }
        if let Err(stop) = self.records.next(&mut self.frame) {
            self.stop_error = Some(stop.error.clone());
            return Err(stop.error);
        }
        swap(&mut frame.state, &mut self.frame.state);
        swap(&mut frame.impulses, &mut self.frame.impulses);
        swap(&mut frame.polynomials, &mut self.frame.polynomials);
        self.record_odd_impulses(&frame.impulses);
        self.notes.extend_from_slice(self.records.notes());
        self.notes.truncate(MAX_NOTES);
        Ok(true)
    }

    /// Returns oddities of the record that was read last that do not stop the reading: impulses of unknown type or with
    /// missing objects, sizes below 0 (read as 0) or above 6. At most 16 are kept.
    pub fn notes(&self) -> &[TraceError] {
        &self.notes
    }

    /// Returns the number of records read.
    pub fn record_count(&self) -> u64 {
        self.records.record_count()
    }

    /// Returns the byte offset of the record that was read last. Before the first call of [`Reader::next`], returns the
    /// offset of the first record.
    pub fn record_offset(&self) -> u64 {
        self.records.record_offset()
    }

    /// Returns the byte offset after the record that was read last.
    pub fn offset(&self) -> u64 {
        self.records.offset()
    }

    /// Returns the layout of the records.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Records the odd impulses of the record that was read last.
    fn record_odd_impulses(&mut self, impulses: &[LoggedImpulse]) {
        let (record, list) = (self.record_count() - 1, self.record_offset() + self.layout.state_bytes() as u64 + 4);
        let odd = (0..).zip(impulses).filter_map(|(number, impulse)| {
            let offset = list + number * RecordList::Impulses.entry_bytes();
            Some(TraceError::new(self.layout, record, offset, self.find_format_error(number, impulse)?))
        });
        let odd: Vec<_> = odd.take(MAX_NOTES).collect();
        self.notes.extend(odd);
    }

    /// Returns the fault of an impulse, if it has an unknown kind or names an object that the scene does not have.
    fn find_format_error(&self, number: u64, impulse: &LoggedImpulse) -> Option<TraceFormatError> {
        let particles = self.layout.particles;
        let Some(kind) = impulse.kind() else {
            return Some(TraceFormatError::UnknownKind { impulse: number, kind: impulse.kind });
        };
        let object = kind.second_name();
        let count = match kind {
            PairKind::ParticleParticle => Some(particles),
            PairKind::ParticleEdge => self.objects.map(|(edges, _)| edges),
            PairKind::ParticleHalfPlane => self.objects.map(|(_, half_planes)| half_planes),
        };
        let first = ("particle", impulse.first, particles);
        let second = (object, impulse.second, count.unwrap_or(usize::MAX));
        [first, second].into_iter().find_map(|(object, index, count)| {
            let inside = usize::try_from(index).is_ok_and(|index| index < count);
            let what = TraceFormatError::IndexOutOfRange { impulse: number, object: object.into(), index, count };
            (!inside).then_some(what)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_beyond_the_limit_is_rejected_before_it_is_in_memory() {
        let layout = Layout { particles: 0, has_impulses: true, has_polynomials: true, steps: 0 };
        for list in [[0, i32::MAX, 0], [0, 1, 1 << 28]] {
            // The list has as many empty polynomials, or coefficients of one polynomial, as there are zero bytes.
            let head = list.map(i32::to_le_bytes).concat();
            let endless = Read::chain(&head[..], std::io::repeat(0));
            let mut reader = Reader::new(endless, layout);
            reader.records = reader.records.with_limit(1 << 20);
            let error = reader.next(&mut Frame::default()).unwrap_err();
            assert_eq!(error.what, TraceFormatError::FrameTooLarge { limit: 1 << 20 });
            assert!(reader.offset() < 1 << 21);
        }
    }
}
