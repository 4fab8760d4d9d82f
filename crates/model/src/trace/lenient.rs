//! The original's trace reader, reproduced bit for bit (oracle-behavior.md 5): what it accepts, what it skips, and
//! where it stops.
//!
//! A stream that has ended stays failed; the bytes of an incomplete value become its low-order bytes; polynomials are
//! read without any check. The original's crash on nonsense counts is not reproduced: the result is
//! [`ReadFailure::Memory`] instead.
//!
//! Memory is bounded by the maximum size of a record of the scene ([`record_memory`]). Polynomials beyond that are
//! counted and not kept. The reference never logs as many, so their number alone is the finding.
use super::{
    decode,
    error::{RecordList, TraceError, TraceFormatError},
    frame::{LoggedImpulse, PolynomialLog},
    layout::Layout,
    source::Source,
};
use crate::{
    scene::{Collision, Scene},
    sim::State,
};
use fosssim_num::{polynomial::MAX_COEFFICIENTS, tolerances::MIN_LEADING_COEFFICIENT};
use serde::{Deserialize, Serialize};
use std::io::Read;

crate::drops_leading!();

/// The maximum memory of the lists of one record in any scene, in bytes.
const MAX_RECORD_BYTES: usize = 256 * 1024 * 1024;

/// The memory that the lists may take in every scene, in bytes. With a lower limit, excessively padded impulse lists
/// would be rejected before the original runs out of memory.
const MIN_RECORD_BYTES: usize = 32 * 1024 * 1024;

/// The memory of the longest polynomial that a detection logs, in bytes.
const MAX_POLYNOMIAL_BYTES: usize = size_of::<f64>() * MAX_COEFFICIENTS + size_of::<usize>();

/// The maximum number of coefficients that are kept of a polynomial. Every number above [`MAX_COEFFICIENTS`] is equally
/// wrong.
const MAX_KEPT_COEFFICIENTS: usize = 4096;

/// Returns the memory that the lists of one record of the scene's traces may take, in bytes. It is the memory of the
/// polynomials of all possible detection passes of a step (collisions.md 4 and 5), within bounds.
pub fn record_memory(scene: &Scene) -> usize {
    let particle_count = scene.particles.len();
    let particle_polynomials = particle_count.saturating_mul(particle_count.saturating_sub(1));
    let edge_polynomials = particle_count.saturating_mul(4 * scene.edges.len());
    let half_plane_polynomials = particle_count.saturating_mul(2 * scene.half_planes.len());
    let pass = particle_polynomials.saturating_add(edge_polynomials).saturating_add(half_plane_polynomials);
    pass.saturating_mul(max_passes(scene))
        .saturating_mul(MAX_POLYNOMIAL_BYTES)
        .clamp(MIN_RECORD_BYTES, MAX_RECORD_BYTES)
}

/// Returns the maximum number of detection passes in a step.
fn max_passes(scene: &Scene) -> usize {
    match scene.collision {
        // Two passes of the geometric part, and one more for each change of the zones: every change adds a particle or
        // the half-plane flag to a zone, or joins two zones.
        Collision::Hybrid { max_iterations, .. } => {
            usize::try_from(max_iterations).unwrap_or(0).saturating_add(2 + 3 * scene.particles.len())
        }
        _ => 1,
    }
}

/// The maximum number of impulses that the original can store. It allocates memory for the declared count before it
/// reads the stream, and a larger count exceeds the corpus's 6 GiB of address space (48 bytes each, in an array that
/// doubles).
const STORABLE_IMPULSES: usize = 1 << 26;

/// The maximum number of polynomials that the original can store (24 bytes each without their coefficients, in an array
/// that doubles).
const STORABLE_POLYNOMIALS: u64 = 1 << 27;

/// The maximum number of coefficients of a polynomial that the original can store.
const STORABLE_COEFFICIENTS: usize = 1 << 28;

/// The maximum number of notes that are kept per record.
pub(super) const MAX_NOTES: usize = 16;

/// A record as read by the original. Buffers are reused from record to record.
#[derive(Debug, Clone, Default)]
pub struct LenientFrame {
    /// Positions and velocities.
    pub state: State,
    /// The impulse list; empty if the layout has none.
    pub impulses: Vec<LoggedImpulse>,
    /// The polynomial list **without its small leading coefficients** (|c| < 1e-12; a NaN is kept); empty if the layout
    /// has none. If the list exceeds the reader's limit, only its beginning is kept.
    pub polynomials: PolynomialLog,
    /// The number of polynomials in the list, including those that are not kept.
    pub logged_polynomials: usize,
    /// Whether the trace's list is identical to `polynomials`: nothing was trimmed, truncated or negative.
    pub is_unchanged: bool,
    /// The first damage in the record that the original ignores.
    pub note: Option<TraceError>,
}

impl LenientFrame {
    /// Returns whether only a part of the polynomial list was kept.
    pub fn is_cut(&self) -> bool {
        self.logged_polynomials > self.polynomials.len()
    }

    /// Frees the memory of lists that are much larger than usual.
    pub fn shrink(&mut self) {
        /// The size up to which memory is kept, in bytes. With a lower size, ordinary records would be allocated again
        /// and again.
        const MAX_REUSED_BYTES: usize = 4 << 20;
        if decode::IMPULSE_MEMORY_BYTES * self.impulses.capacity() > MAX_REUSED_BYTES {
            self.impulses = Vec::new();
        }
        let log = &self.polynomials;
        if 8 * log.coefficients.capacity() + size_of::<usize>() * log.coefficient_ends.capacity() > MAX_REUSED_BYTES {
            self.polynomials = PolynomialLog::default();
            self.logged_polynomials = 0;
        }
    }
}

/// The reason why the original stops reading.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{error}")]
pub struct ReadStop {
    /// The part that could not be read.
    pub cause: ReadFailure,
    /// The damage and its place.
    pub error: TraceError,
}

/// The part of a record that could not be read, or the reason. The original has a message for each of the first two.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ReadFailure {
    /// "Failed to load timestep": the bytes end before or inside positions and velocities.
    State,
    /// "Error while trying to deserialize time step impulses": the bytes end inside the impulse list.
    Impulses,
    /// A count is larger than any file allows: the original runs out of memory (SIGABRT), or would with more bytes than
    /// this reader reads.
    Memory,
    /// A limit of this program is exceeded: the record is larger than any correct record of the scene, and the original
    /// continues reading.
    Limit,
    /// The reader reported an error of the operating system. The original takes it for the end of the file.
    Io,
}

/// Reads records like the original.
#[derive(Debug)]
pub struct LenientReader<R> {
    pub(super) source: Source<R>,
    layout: Layout,
    record: u64,
    record_start: u64,
    /// Whether a read has found too few bytes. Every later read then finds none.
    has_failed: bool,
    notes: Vec<TraceError>,
    limit: usize,
    /// Whether damage stops the reading and all coefficients are kept, as in [`Reader`](super::Reader).
    is_strict: bool,
}

impl<'a> LenientReader<&'a [u8]> {
    /// Returns a reader of a trace in memory.
    pub fn from_slice(trace: &'a [u8], layout: Layout) -> Self {
        let mut reader = Self::new(trace, layout);
        reader.source = reader.source.with_length(trace.len() as u64);
        reader
    }
}

impl<R: Read> LenientReader<R> {
    /// Creates a reader at the beginning of `stream`, which needs no buffer of its own.
    pub fn new(stream: R, layout: Layout) -> Self {
        let (source, notes) = (Source::new(stream), Vec::new());
        Self {
            source,
            layout,
            record: 0,
            record_start: 0,
            has_failed: false,
            notes,
            limit: MAX_RECORD_BYTES,
            is_strict: false,
        }
    }

    /// Lets the first damage stop the reading.
    pub(super) fn into_strict(mut self) -> Self {
        self.is_strict = true;
        self
    }

    /// Limits the memory that the lists of one record may take, in bytes; see [`record_memory`].
    #[must_use]
    pub fn with_limit(mut self, bytes: usize) -> Self {
        self.limit = bytes;
        self
    }

    /// Replaces `frame` by the next record, whether or not the scene has that many records.
    ///
    /// # Errors
    /// Fails with the [`ReadStop`] after the last readable record. In that case `frame` is unspecified.
    pub fn next(&mut self, frame: &mut LenientFrame) -> Result<(), ReadStop> {
        self.record_start = self.source.offset();
        self.notes.clear();
        frame.impulses.clear();
        frame.polynomials.clear();
        frame.logged_polynomials = 0;
        frame.is_unchanged = true;
        self.read_state(&mut frame.state)?;
        if self.layout.has_impulses {
            self.read_impulses(&mut frame.impulses)?;
        }
        if self.layout.has_polynomials {
            self.read_polynomials(frame)?;
        }
        frame.note = self.notes.first().cloned();
        self.record += 1;
        Ok(())
    }

    /// Returns the number of records read.
    pub fn record_count(&self) -> u64 {
        self.record
    }

    /// Returns the byte offset of the record that was read last. Before the first call of [`LenientReader::next`],
    /// returns the offset of the first record.
    pub fn record_offset(&self) -> u64 {
        self.record_start
    }

    /// Returns the byte offset of the next read.
    pub fn offset(&self) -> u64 {
        self.source.offset()
    }

    /// Returns whether bytes follow; the original never reads bytes after the last record.
    pub fn has_more(&mut self) -> bool {
        self.source.ensure(1) > 0
    }

    fn error(&self, offset: u64, format_error: TraceFormatError) -> TraceError {
        TraceError::new(self.layout, self.record, offset, format_error)
    }

    fn stop(&self, cause: ReadFailure, offset: u64, format_error: TraceFormatError) -> ReadStop {
        match self.source.error() {
            Some(error) if matches!(cause, ReadFailure::State | ReadFailure::Impulses) => {
                ReadStop { cause: ReadFailure::Io, error: self.error(self.source.offset(), error) }
            }
            _ => ReadStop { cause, error: self.error(offset, format_error) },
        }
    }

    /// Returns whether the polynomials fill the allowed memory.
    fn is_full(&self, frame: &LenientFrame) -> bool {
        decode::memory_bytes(&frame.polynomials) > self.limit
    }

    /// Returns the notes about the record that was read last.
    pub(super) fn notes(&self) -> &[TraceError] {
        &self.notes
    }

    /// Records damage at which no reader stops.
    fn record_format_error(&mut self, offset: u64, format_error: TraceFormatError) {
        if self.notes.len() < MAX_NOTES {
            self.notes.push(self.error(offset, format_error));
        }
    }

    /// Records damage that the original ignores and the strict reader reports.
    fn record_damage(&mut self, offset: u64, format_error: TraceFormatError) -> Result<(), ReadStop> {
        if self.is_strict {
            return Err(self.stop(ReadFailure::State, offset, format_error));
        }
        self.record_format_error(offset, format_error);
        Ok(())
    }

    /// Stops the strict reader at a record whose polynomials take too much memory.
    fn check_memory(&self, frame: &LenientFrame, offset: u64) -> Result<(), ReadStop> {
        if self.is_strict && self.is_full(frame) {
            let format_error = TraceFormatError::FrameTooLarge { limit: self.limit as u64 };
            return Err(self.stop(ReadFailure::Limit, offset, format_error));
        }
        Ok(())
    }

    /// Reads into `value`; if bytes are missing, the high-order bytes stay unchanged.
    fn read_bytes<const N: usize>(&mut self, value: &mut [u8; N]) {
        if !self.has_failed {
            let available = self.source.ensure(N).min(N);
            value[..available].copy_from_slice(&self.source.window()[..available]);
            self.source.consume(available);
            self.has_failed = available < N;
        }
    }

    /// Reads a count or size.
    fn read_integer(&mut self) -> i32 {
        let mut bytes = [0; 4];
        self.read_bytes(&mut bytes);
        i32::from_le_bytes(bytes)
    }

    fn read_state(&mut self, state: &mut State) -> Result<(), ReadStop> {
        // The original took the previous record for complete, although the bytes ended in it.
        let complete_records = self.record - u64::from(self.has_failed && self.record > 0);
        self.has_failed = self.has_failed || !decode::decode_state(&mut self.source, self.layout.particles, state);
        if !self.has_failed {
            return Ok(());
        }
        let left = self.source.offset() - self.record_start + self.source.ensure(1) as u64;
        let what = TraceFormatError::missing_state(self.layout, self.record, complete_records, left);
        Err(self.stop(ReadFailure::State, self.record_start, what))
    }

    fn read_impulses(&mut self, impulses: &mut Vec<LoggedImpulse>) -> Result<(), ReadStop> {
        let (list, offset) = (RecordList::Impulses, self.source.offset());
        let count = self.read_integer();
        let begin = self.source.offset();
        if self.has_failed {
            return Err(self.stop(
                ReadFailure::Impulses,
                offset,
                TraceFormatError::CountCut { list, left: begin - offset },
            ));
        }
        if count < 0 {
            self.record_damage(offset, TraceFormatError::NegativeCount { list, count })?;
        }
        let entries = usize::try_from(count).unwrap_or(0);
        while impulses.len() < entries {
            if impulses.len() * decode::IMPULSE_MEMORY_BYTES > self.limit {
                let what = TraceFormatError::FrameTooLarge { limit: self.limit as u64 };
                return Err(self.stop(ReadFailure::Limit, offset, what));
            }
            if decode::decode_impulses(&mut self.source, entries - impulses.len(), impulses) == 0 {
                let left = self.source.offset() - begin + self.source.ensure(1) as u64;
                let needs = entries as u64 * list.entry_bytes();
                let cause = if entries > STORABLE_IMPULSES { ReadFailure::Memory } else { ReadFailure::Impulses };
                return Err(self.stop(cause, offset, TraceFormatError::CountBeyondEnd { list, count, needs, left }));
            }
        }
        Ok(())
    }

    fn read_polynomials(&mut self, frame: &mut LenientFrame) -> Result<(), ReadStop> {
        let (list, offset) = (RecordList::Polynomials, self.source.offset());
        let count = self.read_integer();
        let begin = self.source.offset();
        if self.has_failed {
            frame.is_unchanged = false;
            self.record_damage(offset, TraceFormatError::CountCut { list, left: begin - offset })?;
        } else if count < 0 {
            self.record_damage(offset, TraceFormatError::NegativeCount { list, count })?;
        }
        let entries = u64::try_from(count).unwrap_or(0);
        let mut read_count = 0;
        while read_count < entries && !self.has_failed {
            let (window, max_count) = (self.source.window(), entries - read_count);
            let (used, decoded_count, trimmed) = if self.is_full(frame) {
                decode::skip_short_polynomials(window, max_count)
            } else if self.is_strict {
                decode::decode_polynomials::<false>(window, max_count, &mut frame.polynomials)
            } else {
                decode::decode_polynomials::<true>(window, max_count, &mut frame.polynomials)
            };
            self.source.consume(used);
            self.check_memory(frame, offset)?;
            frame.is_unchanged &= !trimmed;
            read_count += decoded_count;
            if entries > STORABLE_POLYNOMIALS && self.source.offset() - begin > self.limit as u64 {
                let what = TraceFormatError::FrameTooLarge { limit: self.limit as u64 };
                return Err(self.stop(ReadFailure::Memory, offset, what));
            }
            if read_count < entries && !decode::has_short_polynomial(&mut self.source) {
                self.read_polynomial(frame, read_count, count)?;
                read_count += 1;
            }
        }
        // Every polynomial after the end has size 0.
        let missing = entries - read_count;
        if missing > 0 && entries > STORABLE_POLYNOMIALS {
            let left = self.source.offset() - begin;
            let what = TraceFormatError::CountBeyondEnd { list, count, needs: 4 * entries, left };
            return Err(self.stop(ReadFailure::Memory, offset, what));
        }
        let room = self.limit.saturating_sub(decode::memory_bytes(&frame.polynomials)) / size_of::<usize>();
        let log = &mut frame.polynomials;
        let empty = usize::try_from(missing).unwrap_or(usize::MAX).min(room);
        log.coefficient_ends.resize(log.coefficient_ends.len() + empty, log.coefficients.len());
        frame.logged_polynomials = usize::try_from(entries).unwrap_or(usize::MAX);
        Ok(())
    }

    /// Reads one polynomial without the fast path. The polynomial may have any size, and the stream may end at any
    /// byte.
    fn read_polynomial(&mut self, frame: &mut LenientFrame, number: u64, count: i32) -> Result<(), ReadStop> {
        let offset = self.source.offset();
        let written = self.read_integer();
        if self.has_failed {
            self.record_damage(offset, TraceFormatError::PolynomialCut { polynomial: number, count })?;
        } else if written < 0 {
            self.record_format_error(offset, TraceFormatError::NegativeSize { polynomial: number, size: written });
        }
        let size = usize::try_from(written).unwrap_or(0);
        if self.is_strict && size > MAX_COEFFICIENTS {
            self.record_format_error(
                offset,
                TraceFormatError::OversizedPolynomial { polynomial: number, size: written },
            );
        } else if size > STORABLE_COEFFICIENTS {
            let what = TraceFormatError::FrameTooLarge { limit: 8 * STORABLE_COEFFICIENTS as u64 };
            return Err(self.stop(ReadFailure::Memory, offset, what));
        }
        let is_complete = !self.has_failed;
        let begin = self.source.offset();
        let has_room = !self.is_full(frame);
        let start = frame.polynomials.coefficients.len();
        let max_length =
            if self.is_strict { usize::MAX } else { start + if has_room { MAX_KEPT_COEFFICIENTS } else { 0 } };
        let mut is_leading = !self.is_strict;
        // The bytes of each coefficient that were read, as the original keeps them.
        let mut value = [0; 8];
        for read in 0..size {
            self.read_bytes(&mut value);
            if self.is_strict {
                self.check_memory(frame, offset)?;
                if self.has_failed {
                    break;
                }
            }
            let coefficient = f64::from_le_bytes(value);
            is_leading &= coefficient.abs() < MIN_LEADING_COEFFICIENT;
            frame.is_unchanged &= !is_leading;
            // After the stream has failed, all other coefficients are equal to this one.
            let times = if self.has_failed { size - read } else { 1 };
            if !is_leading {
                let log = &mut frame.polynomials;
                log.coefficients.resize((log.coefficients.len() + times).min(max_length), coefficient);
            }
            if self.has_failed {
                break;
            }
        }
        if has_room {
            frame.polynomials.coefficient_ends.push(frame.polynomials.coefficients.len());
        }
        frame.is_unchanged &= !self.has_failed && written >= 0;
        if is_complete && self.has_failed {
            let left = self.source.offset() - begin;
            self.record_damage(offset, TraceFormatError::SizeBeyondEnd { polynomial: number, size: written, left })?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
