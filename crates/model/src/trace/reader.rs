//! The strict reader: bytes to frames, and every malformation named.
//!
//! Memory is bounded by one frame whatever the trace's size, and counts are held against the bytes that are left
//! before anything is allocated. For the original's reading, which passes over damage, see [`Lenient`](super::Lenient).
use super::{
    decode,
    error::{List, Malformation, TraceError},
    frame::{Frame, LoggedImpulse},
    layout::Layout,
    source::{Source, WINDOW},
};
use crate::{scene::Scene, sim::PairKind};
use fosssim_num::polynomial::MAX_COEFFICIENTS;
use std::io::Read;

/// Memory that one decoded frame may take, in bytes.
pub const FRAME_LIMIT: u64 = 256 * 1024 * 1024;

/// At most this many bytes behind the last record are read, 64 MiB: a stream need not have an end.
pub const TRAILING_LIMIT: u64 = 64 * 1024 * 1024;

/// At most this many notes are kept per record.
const NOTES: usize = 16;

/// Reads frame after frame (trace-format.md 1, 2).
///
/// ```
/// use fosssim_model::trace::{Frame, Layout, Reader};
///
/// // Two records of one particle without lists: 32 bytes each.
/// let layout = Layout { particles: 1, impulses: false, polynomials: false, steps: 1 };
/// let mut reader = Reader::of_slice(&[0; 64], layout);
/// let mut frame = Frame::default();
/// let mut frames = 0;
/// while reader.next(&mut frame)? {
///     frames += 1;
/// }
/// assert_eq!(frames, 2);
/// assert_eq!(reader.trailing()?, 0);
/// # Ok::<(), fosssim_model::trace::TraceError>(())
/// ```
#[derive(Debug)]
pub struct Reader<R> {
    source: Source<R>,
    layout: Layout,
    /// Edges and half-planes of the scene, where they are known.
    objects: Option<(usize, usize)>,
    record: u64,
    begin: u64,
    notes: Vec<TraceError>,
    stopped: Option<TraceError>,
    limit: u64,
    keeps_raw: bool,
    raw: Vec<u8>,
}

impl<'a> Reader<&'a [u8]> {
    /// A reader of a trace in memory.
    #[must_use]
    pub fn of_slice(trace: &'a [u8], layout: Layout) -> Self {
        Self::new(trace, layout).with_length(trace.len() as u64)
    }
}

impl<R: Read> Reader<R> {
    /// A reader at the beginning of `stream`, which needs no buffer of its own.
    pub fn new(stream: R, layout: Layout) -> Self {
        Self {
            source: Source::new(stream),
            layout,
            objects: None,
            record: 0,
            begin: 0,
            notes: Vec::new(),
            stopped: None,
            limit: FRAME_LIMIT,
            keeps_raw: false,
            raw: Vec::new(),
        }
    }

    /// Tells the reader how long the whole stream is, so that impossible counts are refused at once. Nothing beyond
    /// is read. To be called before the first record.
    #[must_use]
    pub fn with_length(mut self, bytes: u64) -> Self {
        self.source = self.source.with_length(bytes);
        self
    }

    /// Lets the reader note impulses that name edges or half-planes which the scene does not have.
    #[must_use]
    pub fn with_scene(mut self, scene: &Scene) -> Self {
        self.objects = Some((scene.edges.len(), scene.half_planes.len()));
        self
    }

    /// Replaces [`FRAME_LIMIT`].
    #[must_use]
    pub fn with_frame_limit(mut self, bytes: u64) -> Self {
        self.limit = bytes;
        self
    }

    /// Keeps each record's bytes for [`Reader::raw`].
    #[must_use]
    pub fn keeping_raw(mut self) -> Self {
        self.keeps_raw = true;
        self
    }

    /// Replaces `frame` by the next record; false when the scene's last record lies behind.
    ///
    /// # Errors
    /// [`TraceError`]; reading goes no further then, and every later call gives the same error.
    pub fn next(&mut self, frame: &mut Frame) -> Result<bool, TraceError> {
        if let Some(error) = &self.stopped {
            return Err(error.clone());
        }
        self.notes.clear();
        if self.record == self.layout.records() {
            return Ok(false);
        }
        self.begin = self.source.offset();
        if self.keeps_raw {
            self.source.start_tape(std::mem::take(&mut self.raw));
        }
        let read = self.read(frame);
        if self.keeps_raw {
            self.raw = self.source.stop_tape();
        }
        match read {
            Ok(()) => {
                self.record += 1;
                Ok(true)
            }
            Err((offset, what)) => {
                let error = self.error(offset, what);
                self.stopped = Some(error.clone());
                Err(error)
            }
        }
    }

    /// Oddities of the last record that do not keep it from being read: impulses of unknown type or of objects that do
    /// not exist, sizes below 0 (read as 0) or above 6. At most 16.
    #[must_use]
    pub fn notes(&self) -> &[TraceError] {
        &self.notes
    }

    /// Bytes of the last record, with [`Reader::keeping_raw`].
    #[must_use]
    pub fn raw(&self) -> &[u8] {
        &self.raw
    }

    /// Number of records read.
    #[must_use]
    pub fn records(&self) -> u64 {
        self.record
    }

    /// Byte offset of the last record (of the next one before the first call of [`Reader::next`]).
    #[must_use]
    pub fn record_offset(&self) -> u64 {
        self.begin
    }

    /// Byte offset behind the last record.
    #[must_use]
    pub fn offset(&self) -> u64 {
        self.source.offset()
    }

    /// The layout.
    #[must_use]
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Reads to the end of the stream, in bounded memory, and gives the number of bytes behind the last record read.
    ///
    /// # Errors
    /// An error of the stream, or [`Malformation::Endless`] when more than [`TRAILING_LIMIT`] bytes follow.
    pub fn trailing(&mut self) -> Result<u64, TraceError> {
        let offset = self.source.offset();
        let drained = self.source.drain(TRAILING_LIMIT);
        match (self.source.error(), drained) {
            (Some(what), _) => Err(self.error(self.source.offset(), what)),
            (None, None) => {
                // The place is the end of the last record: there may be none that could come next.
                let frame = self.record.saturating_sub(1);
                let what = Malformation::Endless { limit: TRAILING_LIMIT };
                Err(TraceError::new(self.layout, frame, offset, what))
            }
            (None, Some(trailing)) => Ok(trailing),
        }
    }

    fn error(&self, offset: u64, what: Malformation) -> TraceError {
        TraceError::new(self.layout, self.record, offset, what)
    }

    fn note(&mut self, offset: u64, what: Malformation) {
        if self.notes.len() < NOTES {
            let note = self.error(offset, what);
            self.notes.push(note);
        }
    }

    fn too_large(&self) -> Malformation {
        Malformation::FrameTooLarge { limit: self.limit }
    }

    /// The failure that missing bytes are: the stream's own error, or else `what`.
    fn missing(&self, offset: u64, what: Malformation) -> Failure {
        (offset, self.source.error().unwrap_or(what))
    }

    fn read(&mut self, frame: &mut Frame) -> Result<(), Failure> {
        let begin = self.begin;
        if !decode::state(&mut self.source, self.layout.particles, &mut frame.state) {
            let left = self.source.offset() - begin + self.source.ensure(1) as u64;
            let what = Malformation::no_state(self.layout, self.record, self.record, left);
            return Err(self.missing(begin, what));
        }
        frame.impulses.clear();
        frame.polynomials.clear();
        if self.layout.impulses {
            self.impulses(&mut frame.impulses)?;
        }
        if self.layout.polynomials {
            self.polynomials(frame)?;
        }
        Ok(())
    }

    /// A list's count, which may not be negative, nor larger than the bytes left or the frame's memory allow.
    fn count(&mut self, list: List, memory: u64) -> Result<(u64, i32), Failure> {
        let offset = self.source.offset();
        let count = decode::count(&mut self.source).map_err(|left| {
            let empty = left == 0 && self.layout.particles == 0 && offset == 0;
            let what = if empty { Malformation::Empty } else { Malformation::CountCut { list, left: left as u64 } };
            self.missing(offset, what)
        })?;
        let entries = u64::try_from(count).map_err(|_| (offset, Malformation::NegativeCount { list, count }))?;
        if let Some(left) = self.source.left() {
            let needs = entries * list.entry_bytes();
            if needs > left {
                return Err(self.missing(offset, Malformation::CountBeyondEnd { list, count, needs, left }));
            }
            if entries * memory > self.limit {
                return Err((offset, self.too_large()));
            }
        }
        Ok((entries, count))
    }

    fn impulses(&mut self, impulses: &mut Vec<LoggedImpulse>) -> Result<(), Failure> {
        let list = List::Impulses;
        let (entries, count) = self.count(list, decode::IMPULSE_MEMORY as u64)?;
        let begin = self.source.offset();
        while (impulses.len() as u64) < entries {
            let missing = usize::try_from(entries).unwrap_or(usize::MAX) - impulses.len();
            let first = impulses.len();
            if decode::impulses(&mut self.source, missing, impulses) == 0 {
                let left = self.source.offset() - begin + self.source.ensure(1) as u64;
                let needs = entries * list.entry_bytes();
                return Err(self.missing(begin - 4, Malformation::CountBeyondEnd { list, count, needs, left }));
            }
            if (impulses.len() * decode::IMPULSE_MEMORY) as u64 > self.limit {
                return Err((begin - 4, self.too_large()));
            }
            for (number, impulse) in impulses.iter().enumerate().skip(first) {
                if let Some(what) = self.odd(number as u64, impulse) {
                    self.note(begin + number as u64 * list.entry_bytes(), what);
                }
            }
        }
        Ok(())
    }

    /// An oddity of an impulse.
    fn odd(&self, number: u64, impulse: &LoggedImpulse) -> Option<Malformation> {
        let particles = self.layout.particles;
        let Some(kind) = impulse.kind() else {
            return Some(Malformation::UnknownKind { impulse: number, kind: impulse.kind });
        };
        let object = kind.second();
        let count = match kind {
            PairKind::ParticleParticle => Some(particles),
            PairKind::ParticleEdge => self.objects.map(|(edges, _)| edges),
            PairKind::ParticleHalfPlane => self.objects.map(|(_, half_planes)| half_planes),
        };
        let first = ("particle", impulse.first, particles);
        let second = (object, impulse.second, count.unwrap_or(usize::MAX));
        [first, second].into_iter().find_map(|(object, index, count)| {
            let inside = usize::try_from(index).is_ok_and(|index| index < count);
            let what = Malformation::IndexOutOfRange { impulse: number, object: object.into(), index, count };
            (!inside).then_some(what)
        })
    }

    fn polynomials(&mut self, frame: &mut Frame) -> Result<(), Failure> {
        let (entries, count) = self.count(List::Polynomials, 8)?;
        let begin = self.source.offset();
        let log = &mut frame.polynomials;
        let mut done = 0;
        while done < entries {
            let (used, ordinary, _) = decode::polynomials::<false>(self.source.window(), entries - done, log);
            self.source.consume(used);
            done += ordinary;
            if decode::memory(log) as u64 > self.limit {
                return Err((begin - 4, self.too_large()));
            }
            if done == entries {
                break;
            }
            // The next one is not wholly in the window, or its size is not ordinary.
            if decode::has_ordinary(&mut self.source) {
                continue;
            }
            let offset = self.source.offset();
            let Ok(size) = decode::count(&mut self.source) else {
                return Err(self.cut(begin, count, (offset, Malformation::PolynomialCut { polynomial: done, count })));
            };
            if let Err(failure) = self.odd_polynomial(offset, done, size, log) {
                return Err(self.cut(begin, count, failure));
            }
            log.ends.push(log.coefficients.len());
            done += 1;
        }
        Ok(())
    }

    /// The failure that the end of the stream inside a polynomial list is: the count's own, when not even as many empty
    /// polynomials would have had room behind it (`begin`), else `failure`. So the answer does not depend on whether
    /// the length was known.
    fn cut(&mut self, begin: u64, count: i32, failure: Failure) -> Failure {
        let (list, needs) = (List::Polynomials, 4 * u64::from(count.unsigned_abs()));
        match self.source.left().map(|left| self.source.offset() + left - begin) {
            Some(left) if needs > left => {
                self.missing(begin - 4, Malformation::CountBeyondEnd { list, count, needs, left })
            }
            _ => self.missing(failure.0, failure.1),
        }
    }

    /// Reads the coefficients of a polynomial whose size is negative, above six, or more than what is left.
    fn odd_polynomial(
        &mut self,
        offset: u64,
        polynomial: u64,
        size: i32,
        log: &mut super::PolynomialLog,
    ) -> Result<(), Failure> {
        let Ok(coefficients) = usize::try_from(size) else {
            self.note(offset, Malformation::NegativeSize { polynomial, size });
            return Ok(());
        };
        if let Some(left) = self.source.left().filter(|left| 8 * coefficients as u64 > *left) {
            return Err(self.missing(offset, Malformation::SizeBeyondEnd { polynomial, size, left }));
        }
        self.note(offset, Malformation::OversizedPolynomial { polynomial, size });
        let end = log.coefficients.len() + coefficients;
        while log.coefficients.len() < end {
            let missing = end - log.coefficients.len();
            if decode::coefficients(&mut self.source, missing, &mut log.coefficients) == 0 {
                let left = self.source.offset() - offset - 4 + self.source.ensure(1) as u64;
                return Err(self.missing(offset, Malformation::SizeBeyondEnd { polynomial, size, left }));
            }
            if decode::memory(log) as u64 > self.limit {
                return Err((offset, self.too_large()));
            }
        }
        Ok(())
    }
}

/// Where reading failed, and why.
type Failure = (u64, Malformation);

// The window must be able to show every ordinary polynomial at once.
const _: () = assert!(WINDOW >= 4 + 8 * MAX_COEFFICIENTS);
