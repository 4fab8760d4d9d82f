//! Decodes bytes to the blocks of a record.
//!
//! The functions decode in bulk from the source's window, and never allocate memory for bytes that have not arrived.
use super::{
    encode::IMPULSE_BYTES,
    frame::{LoggedImpulse, PolynomialLog},
    source::{Source, WINDOW_BYTES},
};
use crate::sim::State;
use fosssim_num::{
    polynomial::{MAX_COEFFICIENTS, trim},
    tolerances::MIN_LEADING_COEFFICIENT,
    vector::Vec2,
};
use std::io::Read;

crate::drops_leading!();

/// The memory of a decoded polynomial in addition to its coefficients, in bytes.
const POLYNOMIAL_OVERHEAD_BYTES: usize = size_of::<usize>();

/// The number of polynomials for which memory is reserved at a time.
const RESERVED_POLYNOMIALS: usize = 64;

/// The memory of a decoded impulse, in bytes.
pub(crate) const IMPULSE_MEMORY_BYTES: usize = size_of::<LoggedImpulse>();

#[inline]
fn decode_number(bytes: &[u8]) -> f64 {
    f64::from_le_bytes(bytes.try_into().expect("eight bytes"))
}

#[inline]
fn decode_integer(bytes: &[u8]) -> i32 {
    i32::from_le_bytes(bytes.try_into().expect("four bytes"))
}

/// Replaces `out` by the next `count` numbers, or fewer if the source ends. An incomplete number stays in the source.
/// Returns whether there were enough numbers.
pub(crate) fn decode_numbers<R: Read>(source: &mut Source<R>, count: usize, out: &mut Vec<f64>) -> bool {
    out.clear();
    while out.len() < count {
        let byte_count = (8 * (count - out.len())).min(WINDOW_BYTES);
        let available = source.ensure(byte_count).min(byte_count) / 8 * 8;
        if available == 0 {
            return false;
        }
        out.extend(source.window()[..available].chunks_exact(8).map(decode_number));
        source.consume(available);
    }
    true
}

/// Replaces `state` by the next record's. Returns false if the source ends first.
pub(crate) fn decode_state<R: Read>(source: &mut Source<R>, particles: usize, state: &mut State) -> bool {
    decode_numbers(source, 2 * particles, &mut state.positions)
        && decode_numbers(source, 2 * particles, &mut state.velocities)
}

/// Appends up to `count` impulses from the window, and returns their number; 0 only at the end of the source.
pub(crate) fn decode_impulses<R: Read>(source: &mut Source<R>, count: usize, out: &mut Vec<LoggedImpulse>) -> usize {
    let wanted = count.min(WINDOW_BYTES / IMPULSE_BYTES) * IMPULSE_BYTES;
    let available = source.ensure(wanted).min(wanted) / IMPULSE_BYTES;
    let bytes = &source.window()[..available * IMPULSE_BYTES];
    out.extend(bytes.chunks_exact(IMPULSE_BYTES).map(|b| LoggedImpulse {
        kind: decode_integer(&b[0..4]),
        first: decode_integer(&b[4..8]),
        second: decode_integer(&b[8..12]),
        normal: Vec2::new(decode_number(&b[12..20]), decode_number(&b[20..28])),
        time: decode_number(&b[28..36]),
    }));
    source.consume(available * IMPULSE_BYTES);
    available
}

/// Returns the size of the next polynomial, and the bytes after its size. Returns `None` if the polynomial has more
/// than 6 coefficients or is not completely in `bytes`.
#[inline(always)]
fn decode_short_size(bytes: &[u8]) -> Option<(usize, &[u8])> {
    let (head, rest) = bytes.split_first_chunk::<4>()?;
    let size = u32::from_le_bytes(*head) as usize;
    (size <= MAX_COEFFICIENTS && 8 * size <= rest.len()).then_some((size, rest))
}

/// Returns whether the next polynomial has at most six coefficients and is completely in the window.
pub(crate) fn has_short_polynomial<R: Read>(source: &mut Source<R>) -> bool {
    if source.ensure(4) < 4 {
        return false;
    }
    usize::try_from(decode_integer(&source.window()[..4]))
        .is_ok_and(|size| size <= MAX_COEFFICIENTS && source.ensure(4 + 8 * size) >= 4 + 8 * size)
}

/// Appends short polynomials (at most six coefficients) until the first longer one, at most `max_count`. Returns the
/// number of bytes used, the number of polynomials, and, with `TRIM`, whether any leading coefficient was dropped.
pub(crate) fn decode_polynomials<const TRIM: bool>(
    bytes: &[u8],
    max_count: u64,
    log: &mut PolynomialLog,
) -> (usize, u64, bool) {
    let (mut at, mut done, mut trimmed) = (0, 0, false);
    let PolynomialLog { coefficients, coefficient_ends: ends } = log;
    let mut used = coefficients.len();
    while done < max_count
        && let Some((size, rest)) = decode_short_size(&bytes[at..])
    {
        // A copy of constant length, of which a part counts, is fastest; memory is reserved for many at a time.
        if coefficients.len() < used + MAX_COEFFICIENTS {
            let more = usize::try_from(max_count - done).unwrap_or(usize::MAX).min(RESERVED_POLYNOMIALS);
            coefficients.resize(used + more * MAX_COEFFICIENTS, 0.0);
        }
        let slots = &mut coefficients[used..used + MAX_COEFFICIENTS];
        let numbers = rest.as_chunks::<8>().0;
        match numbers.first_chunk::<MAX_COEFFICIENTS>() {
            Some(six) => slots.copy_from_slice(&six.map(f64::from_le_bytes)),
            None => slots.iter_mut().zip(numbers).for_each(|(slot, bytes)| *slot = f64::from_le_bytes(*bytes)),
        }
        let mut kept_size = size;
        if TRIM && size > 0 && slots[0].abs() < MIN_LEADING_COEFFICIENT {
            let list = trim(&slots[..size]);
            kept_size = list.len();
            slots.copy_within(size - kept_size..size, 0);
            trimmed = true;
        }
        used += kept_size;
        ends.push(used);
        at += 4 + 8 * size;
        done += 1;
    }
    coefficients.truncate(used);
    (at, done, trimmed)
}

/// Skips short polynomials, and returns the same as [`decode_polynomials`]; nothing is dropped.
pub(crate) fn skip_short_polynomials(bytes: &[u8], max_count: u64) -> (usize, u64, bool) {
    let (mut at, mut done) = (0, 0);
    while done < max_count
        && let Some((size, _)) = decode_short_size(&bytes[at..])
    {
        at += 4 + 8 * size;
        done += 1;
    }
    (at, done, false)
}

/// Returns the memory of the log's content, in bytes.
pub(crate) fn memory_bytes(log: &PolynomialLog) -> usize {
    8 * log.coefficients.len() + POLYNOMIAL_OVERHEAD_BYTES * log.coefficient_ends.len()
}
