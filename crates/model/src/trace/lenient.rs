//! The original's reading, bit for bit (oracle-behaviour.md 5): what it believes, what it passes over, where it stops.
//!
//! A stream that has run out stays failed; a value that is only partly there takes the bytes that are there as its
//! low-order ones; polynomials are read without any check. The one thing not reproduced is how the original dies of
//! nonsense counts: [`Cause::Memory`] is the answer instead.
//!
//! Memory is bounded by what a record of the scene can hold ([`record_memory`]). Polynomials beyond that are counted and
//! not kept: the reference never logs so many, so their number alone is the finding.
use super::{
    decode,
    error::{List, Malformation, TraceError},
    frame::{LoggedImpulse, PolynomialLog},
    layout::Layout,
    source::Source,
};
use crate::{
    scene::{Collision, Scene},
    sim::State,
};
use fosssim_num::{polynomial::MAX_COEFFICIENTS, tolerances::LEADING_COEFFICIENT};
use std::io::Read;

/// Memory that the lists of one record may take together at most, in bytes, whatever the scene.
const LIMIT: usize = 256 * 1024 * 1024;

/// Memory that they may take in any scene, in bytes. Lowered, impulse lists that are padded beyond reason are refused
/// earlier than the original runs out of memory.
const FLOOR: usize = 32 * 1024 * 1024;

/// Memory of the longest polynomial that a detection logs, in bytes.
const POLYNOMIAL_MEMORY: usize = size_of::<f64>() * MAX_COEFFICIENTS + size_of::<usize>();

/// Of a polynomial with more coefficients so many are kept; any number above [`MAX_COEFFICIENTS`] is as wrong.
const LONGEST_POLYNOMIAL: usize = 4096;

/// Memory that the lists of one record of this scene's traces may take, in bytes: what the polynomials of all detection
/// passes take that a step can make (collisions.md 4 and 5), within bounds.
#[must_use]
pub fn record_memory(scene: &Scene) -> usize {
    let particles = scene.particles.len();
    let of_particles = particles.saturating_mul(particles.saturating_sub(1));
    let of_edges = particles.saturating_mul(4 * scene.edges.len());
    let of_half_planes = particles.saturating_mul(2 * scene.half_planes.len());
    let pass = of_particles.saturating_add(of_edges).saturating_add(of_half_planes);
    pass.saturating_mul(most_passes(scene)).saturating_mul(POLYNOMIAL_MEMORY).clamp(FLOOR, LIMIT)
}

/// The detection passes that a step makes at most.
fn most_passes(scene: &Scene) -> usize {
    match scene.collision {
        // Two passes of the geometric part, and one more for each change of the zones: with every change a particle or
        // the half-plane flag comes to a zone, or two zones become one.
        Collision::Hybrid { max_iterations, .. } => {
            usize::try_from(max_iterations).unwrap_or(0).saturating_add(2 + 3 * scene.particles.len())
        }
        _ => 1,
    }
}

/// The original stores as many impulses as the count says before it looks at the stream, and runs out of the corpus's
/// 6 GiB of address space above this count (48 bytes each, in an array that doubles).
const STORABLE_IMPULSES: usize = 1 << 26;

/// As many polynomials fit there (24 bytes each without their coefficients, in an array that doubles).
const STORABLE_POLYNOMIALS: u64 = 1 << 27;

/// And a polynomial of so many coefficients.
const STORABLE_COEFFICIENTS: usize = 1 << 28;

/// A record as the original reads it. Buffers are reused from record to record.
#[derive(Debug, Clone, Default)]
pub struct LenientFrame {
    /// Positions and velocities.
    pub state: State,
    /// The impulse list; empty where the layout has none.
    pub impulses: Vec<LoggedImpulse>,
    /// The polynomial list **without its small leading coefficients** (|c| < 1e-12; a NaN is kept); empty where the
    /// layout has none. Its beginning only where it is longer than the reader's limit allows.
    pub polynomials: PolynomialLog,
    /// The number of polynomials in the list, those that are not kept included.
    pub logged: usize,
    /// Whether the list is written in the trace exactly as `polynomials` says: nothing was trimmed, cut or negative.
    pub plain: bool,
    /// The first damage that the original passes over in this record.
    pub note: Option<TraceError>,
}

impl LenientFrame {
    /// Whether the polynomial list is longer than what was kept of it.
    #[must_use]
    pub fn is_cut(&self) -> bool {
        self.logged > self.polynomials.len()
    }

    /// Gives back the memory of lists that are larger than nearly all lists are.
    pub fn shrink(&mut self) {
        /// In bytes. Lowered, ordinary records are allocated again and again.
        const ORDINARY: usize = 4 << 20;
        if decode::IMPULSE_MEMORY * self.impulses.capacity() > ORDINARY {
            self.impulses = Vec::new();
        }
        let log = &self.polynomials;
        if 8 * log.coefficients.capacity() + size_of::<usize>() * log.ends.capacity() > ORDINARY {
            self.polynomials = PolynomialLog::default();
            self.logged = 0;
        }
    }
}

/// Why the original goes no further.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{at}")]
pub struct Stop {
    /// What could not be read.
    pub cause: Cause,
    /// The damage.
    pub at: TraceError,
}

/// What could not be read; the original has a message for each of the first two.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// "Failed to load timestep".
    State,
    /// "Error while trying to deserialize time step impulses".
    Impulses,
    /// The original runs out of memory (SIGABRT), or would with more bytes than we read.
    Memory,
    /// A limit of ours: the record is larger than any sound one of the scene, and the original reads on.
    Limit,
    /// The stream reported an error. The original takes it for the end of the file.
    Io,
}

/// Reads records as the original does.
#[derive(Debug)]
pub struct Lenient<R> {
    source: Source<R>,
    layout: Layout,
    record: u64,
    begin: u64,
    /// Once a read has found fewer bytes than it wanted, no read finds any.
    failed: bool,
    note: Option<TraceError>,
    limit: usize,
}

impl<'a> Lenient<&'a [u8]> {
    /// A reader of a trace in memory.
    #[must_use]
    pub fn of_slice(trace: &'a [u8], layout: Layout) -> Self {
        let mut reader = Self::new(trace, layout);
        reader.source = reader.source.with_length(trace.len() as u64);
        reader
    }
}

impl<R: Read> Lenient<R> {
    /// A reader at the beginning of `stream`, which needs no buffer of its own.
    pub fn new(stream: R, layout: Layout) -> Self {
        Self { source: Source::new(stream, None), layout, record: 0, begin: 0, failed: false, note: None, limit: LIMIT }
    }

    /// Bounds the memory that the lists of one record may take, in bytes; see [`record_memory`].
    #[must_use]
    pub fn with_limit(mut self, bytes: usize) -> Self {
        self.limit = bytes;
        self
    }

    /// Replaces `frame` by the next record, whether or not the scene has so many.
    ///
    /// # Errors
    /// [`Stop`]; `frame` is unspecified then.
    pub fn next(&mut self, frame: &mut LenientFrame) -> Result<(), Stop> {
        self.begin = self.source.offset();
        self.note = None;
        frame.impulses.clear();
        frame.polynomials.clear();
        frame.logged = 0;
        frame.plain = true;
        self.state(&mut frame.state)?;
        if self.layout.impulses {
            self.impulses(&mut frame.impulses)?;
        }
        if self.layout.polynomials {
            self.polynomials(frame)?;
        }
        frame.note = self.note.take();
        self.record += 1;
        Ok(())
    }

    /// Number of records read.
    #[must_use]
    pub fn records(&self) -> u64 {
        self.record
    }

    /// Byte offset of the last record (of the next one before the first call of [`Lenient::next`]).
    #[must_use]
    pub fn record_offset(&self) -> u64 {
        self.begin
    }

    /// Byte offset of what is read next.
    #[must_use]
    pub fn offset(&self) -> u64 {
        self.source.offset()
    }

    /// Whether bytes follow; the original never looks at those behind the last record.
    pub fn has_more(&mut self) -> bool {
        self.source.ensure(1) > 0
    }

    fn error(&self, offset: u64, what: Malformation) -> TraceError {
        TraceError { offset, frame: self.record, step: self.layout.step_of(self.record), what }
    }

    fn stop(&self, cause: Cause, offset: u64, what: Malformation) -> Stop {
        match self.source.error().cloned() {
            Some((kind, message)) if matches!(cause, Cause::State | Cause::Impulses) => {
                let at = self.error(self.source.offset(), Malformation::Io { kind, message });
                Stop { cause: Cause::Io, at }
            }
            _ => Stop { cause, at: self.error(offset, what) },
        }
    }

    /// Memory that the polynomials take so far, in bytes.
    fn is_full(&self, frame: &LenientFrame) -> bool {
        decode::memory(&frame.polynomials) > self.limit
    }

    fn note(&mut self, offset: u64, what: Malformation) {
        if self.note.is_none() {
            self.note = Some(self.error(offset, what));
        }
    }

    /// Reads into `value`: bytes that are missing leave the high-order ones as they are.
    fn bytes<const N: usize>(&mut self, value: &mut [u8; N]) {
        if !self.failed {
            let there = self.source.ensure(N).min(N);
            value[..there].copy_from_slice(&self.source.window()[..there]);
            self.source.consume(there);
            self.failed = there < N;
        }
    }

    fn state(&mut self, state: &mut State) -> Result<(), Stop> {
        self.failed = self.failed || !decode::state(&mut self.source, self.layout.particles, state);
        if !self.failed {
            return Ok(());
        }
        let left = self.source.offset() - self.begin + self.source.ensure(1) as u64;
        let what = match (left, self.record) {
            (0, 0) => Malformation::Empty,
            (0, records) => Malformation::TooFewRecords { records, expected: self.layout.records() },
            _ => Malformation::State { needs: self.layout.state_bytes() as u64, left },
        };
        Err(self.stop(Cause::State, self.begin, what))
    }

    fn impulses(&mut self, impulses: &mut Vec<LoggedImpulse>) -> Result<(), Stop> {
        let (list, offset) = (List::Impulses, self.source.offset());
        let mut bytes = [0; 4];
        self.bytes(&mut bytes);
        let begin = self.source.offset();
        if self.failed {
            return Err(self.stop(Cause::Impulses, offset, Malformation::CountCut { list, left: begin - offset }));
        }
        let count = i32::from_le_bytes(bytes);
        if count < 0 {
            self.note(offset, Malformation::NegativeCount { list, count });
        }
        let entries = usize::try_from(count).unwrap_or(0);
        while impulses.len() < entries {
            if impulses.len() * decode::IMPULSE_MEMORY > self.limit {
                let what = Malformation::FrameTooLarge { limit: self.limit as u64 };
                return Err(self.stop(Cause::Limit, offset, what));
            }
            if decode::impulses(&mut self.source, entries - impulses.len(), impulses) == 0 {
                let left = self.source.offset() - begin + self.source.ensure(1) as u64;
                let needs = entries as u64 * list.entry_bytes();
                let cause = if entries > STORABLE_IMPULSES { Cause::Memory } else { Cause::Impulses };
                return Err(self.stop(cause, offset, Malformation::CountBeyondEnd { list, count, needs, left }));
            }
        }
        Ok(())
    }

    fn polynomials(&mut self, frame: &mut LenientFrame) -> Result<(), Stop> {
        let (list, offset) = (List::Polynomials, self.source.offset());
        let mut bytes = [0; 4];
        self.bytes(&mut bytes);
        let begin = self.source.offset();
        let count = i32::from_le_bytes(bytes);
        if self.failed {
            frame.plain = false;
            self.note(offset, Malformation::CountCut { list, left: begin - offset });
        } else if count < 0 {
            self.note(offset, Malformation::NegativeCount { list, count });
        }
        let entries = u64::try_from(count).unwrap_or(0);
        let mut done = 0;
        while done < entries && !self.failed {
            if self.is_full(frame) {
                let (used, ordinary) = decode::pass_over(self.source.window(), entries - done);
                self.source.consume(used);
                done += ordinary;
            } else {
                let log = &mut frame.polynomials;
                let (used, ordinary, trimmed) = decode::polynomials::<true>(self.source.window(), entries - done, log);
                self.source.consume(used);
                frame.plain &= !trimmed;
                done += ordinary;
            }
            if entries > STORABLE_POLYNOMIALS && self.source.offset() - begin > self.limit as u64 {
                let what = Malformation::FrameTooLarge { limit: self.limit as u64 };
                return Err(self.stop(Cause::Memory, offset, what));
            }
            if done < entries && !self.ordinary_in_window() {
                self.polynomial(frame, done, count)?;
                done += 1;
            }
        }
        // Every polynomial behind the end has size 0.
        let missing = entries - done;
        if missing > 0 && entries > STORABLE_POLYNOMIALS {
            let left = self.source.offset() - begin;
            let what = Malformation::CountBeyondEnd { list, count, needs: 4 * entries, left };
            return Err(self.stop(Cause::Memory, offset, what));
        }
        let room = self.limit.saturating_sub(decode::memory(&frame.polynomials)) / size_of::<usize>();
        let log = &mut frame.polynomials;
        let empty = usize::try_from(missing).unwrap_or(usize::MAX).min(room);
        log.ends.resize(log.ends.len() + empty, log.coefficients.len());
        frame.logged = usize::try_from(entries).unwrap_or(usize::MAX);
        Ok(())
    }

    /// Whether the next polynomial has an ordinary size and is wholly in the window now.
    fn ordinary_in_window(&mut self) -> bool {
        if self.source.ensure(4) < 4 {
            return false;
        }
        let size = i32::from_le_bytes(self.source.window()[..4].try_into().expect("four bytes"));
        usize::try_from(size)
            .is_ok_and(|size| size <= MAX_COEFFICIENTS && self.source.ensure(4 + 8 * size) >= 4 + 8 * size)
    }

    /// Reads one polynomial the long way: any size, the stream may end anywhere.
    fn polynomial(&mut self, frame: &mut LenientFrame, number: u64, count: i32) -> Result<(), Stop> {
        let offset = self.source.offset();
        let mut bytes = [0; 4];
        self.bytes(&mut bytes);
        let size = i32::from_le_bytes(bytes);
        if self.failed {
            self.note(offset, Malformation::PolynomialCut { polynomial: number, count });
        } else if size < 0 {
            self.note(offset, Malformation::NegativeSize { polynomial: number, size });
        }
        let size = usize::try_from(size).unwrap_or(0);
        if size > STORABLE_COEFFICIENTS {
            let what = Malformation::FrameTooLarge { limit: 8 * STORABLE_COEFFICIENTS as u64 };
            return Err(self.stop(Cause::Memory, offset, what));
        }
        let whole = !self.failed;
        let begin = self.source.offset();
        let keeps = !self.is_full(frame);
        let log = &mut frame.polynomials;
        let start = log.coefficients.len();
        let most = start + if keeps { LONGEST_POLYNOMIAL } else { 0 };
        let mut is_leading = true;
        // What was read so far and not dropped, as the original keeps it, coefficient by coefficient.
        let mut value = [0; 8];
        for read in 0..size {
            self.bytes(&mut value);
            let coefficient = f64::from_le_bytes(value);
            is_leading &= coefficient.abs() < LEADING_COEFFICIENT;
            frame.plain &= !is_leading;
            // Once the stream has failed, all the others repeat this one.
            let times = if self.failed { size - read } else { 1 };
            if !is_leading {
                log.coefficients.resize((log.coefficients.len() + times).min(most), coefficient);
            }
            if self.failed {
                break;
            }
        }
        if keeps {
            log.ends.push(log.coefficients.len());
        }
        frame.plain &= !self.failed && bytes[3] < 0x80;
        if whole && self.failed {
            let left = self.source.offset() - begin;
            let size = i32::from_le_bytes(bytes);
            self.note(offset, Malformation::SizeBeyondEnd { polynomial: number, size, left });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::{Frame, Writer};

    const LAYOUT: Layout = Layout { particles: 0, impulses: true, polynomials: true, steps: 0 };

    #[test]
    fn a_record_may_hold_what_the_scenes_passes_log() {
        let memory = |particles: usize, collision: &str| {
            let particle = |number: usize| format!(r#"<particle m="1" px="{number}" py="0" vx="0" vy="0" fixed="0"/>"#);
            let head = r#"<duration time="1"/><integrator type="explicit-euler" dt="1"/>"#;
            let particles: String = (0..particles).map(particle).collect();
            let xml = format!("<scene>{head}<collision {collision}/>{particles}</scene>");
            record_memory(&crate::scene::read("scene", xml.as_bytes()).unwrap().scene)
        };
        let hybrid = |rounds: u32| format!(r#"type="hybrid" maxiters="{rounds}" k="0""#);
        assert_eq!(memory(20, r#"type="continuous-time""#), FLOOR);
        assert_eq!(memory(20, &hybrid(10)), FLOOR);
        assert_eq!(memory(20, &hybrid(10_000)), 20 * 19 * (10_000 + 2 + 60) * POLYNOMIAL_MEMORY);
        assert_eq!(memory(1000, &hybrid(10_000)), LIMIT);
    }

    #[test]
    fn polynomials_beyond_the_limit_are_counted_and_not_kept() {
        // More than the window holds, of every size, then another record.
        let polynomials: Vec<Vec<f64>> = (0..60_000).map(|number| vec![1.5; number % 9]).collect();
        let list: Vec<&[f64]> = polynomials.iter().map(Vec::as_slice).collect();
        let bytes = [record(&list), record(&[&[2.0]])].concat();
        for limit in [0, 1, 4096, 100_000] {
            let mut reader = Lenient::new(&bytes[..], LAYOUT).with_limit(limit);
            let mut frame = LenientFrame::default();
            reader.next(&mut frame).unwrap();
            assert!(frame.is_cut() && frame.logged == 60_000 && frame.note.is_none(), "{limit}");
            // What is in the window is decoded at one go.
            assert!(decode::memory(&frame.polynomials) <= limit + 4 * super::super::source::WINDOW);
            let kept: Vec<&[f64]> = frame.polynomials.iter().collect();
            assert_eq!(kept, list[..kept.len()]);
            reader.next(&mut frame).unwrap();
            assert_eq!((frame.logged, frame.is_cut(), frame.polynomials.get(0)), (1, false, &[2.0][..]));
            assert!(!reader.has_more());
        }
    }

    #[test]
    fn a_cut_behind_the_limit_leaves_the_count() {
        let bytes = record(&[[1.0; 6].as_slice(); 60_000]);
        for cut in [bytes.len() - 1, bytes.len() - 48, bytes.len() - 60] {
            let mut reader = Lenient::new(&bytes[..cut], LAYOUT).with_limit(1000);
            let mut frame = LenientFrame::default();
            reader.next(&mut frame).unwrap();
            assert!(frame.note.is_some() && frame.logged == 60_000, "cut at {cut}");
            assert_eq!(reader.next(&mut frame).unwrap_err().cause, Cause::State);
        }
    }

    #[test]
    fn a_monstrous_polynomial_is_kept_in_part() {
        let monster = vec![1.0; 1_000_000];
        let (frame, _) = read(&record(&[&[1.0], &monster, &[2.0]]));
        assert_eq!((frame.logged, frame.is_cut()), (3, false));
        assert_eq!(frame.polynomials.get(1).len(), LONGEST_POLYNOMIAL);
        assert_eq!(frame.polynomials.get(2), [2.0]);
    }

    /// A record without particles that holds these polynomials.
    fn record(polynomials: &[&[f64]]) -> Vec<u8> {
        let mut frame = Frame::default();
        polynomials.iter().for_each(|p| frame.polynomials.push(p));
        let mut writer = Writer::new(Vec::new(), LAYOUT);
        writer.frame(&frame);
        writer.finish().unwrap().0
    }

    /// Reads one record, and gives the frame and what reading another one stops at.
    fn read(bytes: &[u8]) -> (LenientFrame, Stop) {
        let mut reader = Lenient::of_slice(bytes, LAYOUT);
        let mut frame = LenientFrame::default();
        reader.next(&mut frame).unwrap();
        let stop = reader.next(&mut LenientFrame::default()).unwrap_err();
        (frame, stop)
    }

    #[test]
    fn a_missing_coefficient_repeats_the_one_before() {
        let bytes = record(&[&[1.0, 2.0, 3.0], &[4.0, 5.0, 6.0], &[7.0]]);
        let (frame, stop) = read(&bytes[..8 + 28 + 4 + 16]);
        let read: Vec<&[f64]> = frame.polynomials.iter().collect();
        assert_eq!(read, [&[1.0, 2.0, 3.0][..], &[4.0, 5.0, 5.0], &[]]);
        assert!(!frame.plain);
        let note = frame.note.unwrap();
        assert_eq!(note.what, Malformation::SizeBeyondEnd { polynomial: 1, size: 3, left: 16 });
        assert_eq!(note.offset, 36);
        assert_eq!(stop.cause, Cause::State, "a failed stream has not even a state of zero bytes");
    }

    #[test]
    fn a_cut_coefficient_keeps_the_high_order_bytes_of_the_one_before() {
        let (a, b) = (f64::from_bits(0x3ff0_0000_0000_1111), f64::from_bits(0x4008_2222_3333_4444));
        let bytes = record(&[&[a, b]]);
        let (frame, _) = read(&bytes[..8 + 4 + 8 + 3]);
        assert_eq!(frame.polynomials.get(0)[1].to_bits(), 0x3ff0_0000_0033_4444);
        // Without one before, the other bytes are 0; what results is tiny here, hence dropped with all that follow.
        let (frame, _) = read(&bytes[..8 + 4 + 7]);
        assert_eq!(frame.polynomials.get(0), [0.0; 0]);
        let (frame, _) = read(&record(&[&[f64::from_bits(0x00ff_0000_0000_0001)]])[..8 + 4 + 7]);
        assert_eq!(frame.polynomials.len(), 1);
    }

    #[test]
    fn polynomials_behind_a_cut_are_empty() {
        let bytes = record(&[&[1.0], &[2.0], &[3.0]]);
        for cut in 8 + 12..8 + 12 + 4 {
            let (frame, _) = read(&bytes[..cut]);
            assert_eq!(frame.polynomials.iter().collect::<Vec<_>>(), [&[1.0][..], &[], &[]], "cut at {cut}");
            assert_eq!(frame.note.unwrap().what, Malformation::PolynomialCut { polynomial: 1, count: 3 });
        }
    }

    #[test]
    fn small_leading_coefficients_are_dropped_and_nan_stops_the_dropping() {
        let bytes = record(&[&[1e-13, -1e-13, 2.0, 0.0], &[0.0, 0.0], &[0.0, f64::NAN, 1.0], &[1e-12]]);
        let mut frame = LenientFrame::default();
        Lenient::of_slice(&bytes, LAYOUT).next(&mut frame).unwrap();
        let log = &frame.polynomials;
        assert_eq!((log.get(0), log.get(1), log.get(3)), (&[2.0, 0.0][..], &[][..], &[1e-12][..]));
        assert!(log.get(2)[0].is_nan() && log.get(2)[1] == 1.0);
        assert!(!frame.plain && frame.note.is_none());
    }

    #[test]
    fn a_sound_list_is_plain() {
        let bytes = record(&[&[1.0, 0.0], &[], &[f64::NAN; 6], &[2.0; 9]]);
        let mut frame = LenientFrame::default();
        Lenient::of_slice(&bytes, LAYOUT).next(&mut frame).unwrap();
        assert!(frame.plain);
        assert_eq!(frame.polynomials.get(3), [2.0; 9]);
    }

    #[test]
    fn negative_counts_and_sizes_are_zero_and_skip_nothing() {
        let mut bytes = record(&[&[], &[1.0]]);
        bytes[0..4].copy_from_slice(&(-3_i32).to_le_bytes());
        bytes[8..12].copy_from_slice(&(-1_i32).to_le_bytes());
        let (frame, stop) = read(&bytes);
        assert_eq!(frame.polynomials.iter().collect::<Vec<_>>(), [&[][..], &[1.0]]);
        assert_eq!(frame.note.unwrap().what, Malformation::NegativeCount { list: List::Impulses, count: -3 });
        assert!(!frame.plain);
        assert_eq!(stop.cause, Cause::Impulses, "at the end of the file the count is missing");
    }

    #[test]
    fn nonsense_counts_cost_no_memory() {
        let count = |count: i32| count.to_le_bytes();
        let cases = [
            (vec![count(i32::MAX)], Cause::Memory),
            (vec![count(1000)], Cause::Impulses),
            (vec![count(0), count(i32::MAX)], Cause::Memory),
            (vec![count(0), count(1), count(i32::MAX)], Cause::Memory),
        ];
        for (words, cause) in cases {
            let stop = Lenient::of_slice(&words.concat(), LAYOUT).next(&mut LenientFrame::default()).unwrap_err();
            assert_eq!(stop.cause, cause);
        }
        let (frame, _) = read(&[count(0), count(1_000_000)].concat());
        assert_eq!(frame.polynomials.len(), 1_000_000, "the original makes as many empty ones");
    }

    #[test]
    fn endless_lists_end_at_the_limit() {
        let count = |count: i32| count.to_le_bytes();
        // Impulses; empty polynomials; a polynomial of zeros, each dropped, and empty ones.
        let heads =
            [vec![count(i32::MAX)], vec![count(0), count(i32::MAX)], vec![count(0), count(i32::MAX), count(99)]];
        for head in heads {
            let head = head.concat();
            let mut reader = Lenient::new((&head[..]).chain(std::io::repeat(0)), LAYOUT);
            reader.limit = 1 << 20;
            let expected = if head.len() == 4 { Cause::Limit } else { Cause::Memory };
            assert_eq!(reader.next(&mut LenientFrame::default()).unwrap_err().cause, expected);
            assert!(reader.offset() < 1 << 21);
        }
    }

    #[test]
    fn an_error_of_the_stream_is_named() {
        struct Broken;
        impl Read for Broken {
            fn read(&mut self, _: &mut [u8]) -> std::io::Result<usize> {
                Err(std::io::Error::other("cable unplugged"))
            }
        }
        let stop = Lenient::new(Broken, LAYOUT).next(&mut LenientFrame::default()).unwrap_err();
        assert_eq!(stop.cause, Cause::Io);
        assert!(stop.to_string().ends_with("reading failed: cable unplugged"), "{stop}");
    }
}
