//! The blocks of a record as bytes (trace-format.md 1): little-endian, packed, into buffers that are reused.
//!
//! Nothing here writes to a stream; [`super::Writer`] does. No function checks what it encodes.
use super::frame::{LoggedImpulse, PolynomialLog};
use crate::sim::State;
use fosssim_num::polynomial::MAX_COEFFICIENTS;

/// Bytes of an encoded impulse: three `i32`, three `f64`.
pub(crate) const IMPULSE_BYTES: usize = 36;

/// Bytes of the largest polynomial that the simulator logs.
const POLYNOMIAL_BYTES: usize = 4 + 8 * MAX_COEFFICIENTS;

/// A list in encoded form: how many entries, and their bytes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Encoded {
    pub(crate) count: usize,
    pub(crate) bytes: Vec<u8>,
}

impl Encoded {
    /// Empties the list and keeps its memory.
    pub(crate) fn clear(&mut self) {
        self.count = 0;
        self.bytes.clear();
    }
}

/// Appends `values` one after the other.
// Not for inlining: it would be compiled where a recorder is used, at that crate's level.
pub(crate) fn numbers(out: &mut Vec<u8>, values: &[f64]) {
    let start = out.len();
    out.resize(start + 8 * values.len(), 0);
    for (place, value) in out[start..].chunks_exact_mut(8).zip(values) {
        place.copy_from_slice(&value.to_le_bytes());
    }
}

/// Appends positions and velocities.
pub(crate) fn state(out: &mut Vec<u8>, state: &State) {
    numbers(out, &state.positions);
    numbers(out, &state.velocities);
}

/// Appends a list's count. Counts above the 32-bit range cannot be written; the format has no room for them.
///
/// # Panics
/// With a count above `i32::MAX`.
#[inline]
pub(crate) fn count(out: &mut Vec<u8>, count: usize) {
    let count = i32::try_from(count).expect("a list has fewer than 2^31 entries");
    out.extend_from_slice(&count.to_le_bytes());
}

/// Appends one impulse.
#[inline]
pub(crate) fn impulse(out: &mut Vec<u8>, impulse: &LoggedImpulse) {
    let mut bytes = [0; IMPULSE_BYTES];
    bytes[0..4].copy_from_slice(&impulse.kind.to_le_bytes());
    bytes[4..8].copy_from_slice(&impulse.first.to_le_bytes());
    bytes[8..12].copy_from_slice(&impulse.second.to_le_bytes());
    bytes[12..20].copy_from_slice(&impulse.normal.x.to_le_bytes());
    bytes[20..28].copy_from_slice(&impulse.normal.y.to_le_bytes());
    bytes[28..36].copy_from_slice(&impulse.time.to_le_bytes());
    out.extend_from_slice(&bytes);
}

/// Appends one polynomial, highest power first.
#[inline]
pub(crate) fn polynomial(out: &mut Vec<u8>, coefficients: &[f64]) {
    if coefficients.len() <= MAX_COEFFICIENTS {
        // A copy of constant length and a cut are several times faster than a copy of variable length.
        let mut bytes = [0; POLYNOMIAL_BYTES];
        #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "at most six")]
        let size = coefficients.len() as i32;
        bytes[0..4].copy_from_slice(&size.to_le_bytes());
        for (place, value) in bytes[4..].chunks_exact_mut(8).zip(coefficients) {
            place.copy_from_slice(&value.to_le_bytes());
        }
        let end = out.len() + 4 + 8 * coefficients.len();
        out.extend_from_slice(&bytes);
        out.truncate(end);
    } else {
        count(out, coefficients.len());
        numbers(out, coefficients);
    }
}

/// Appends all polynomials of a log, without their count.
pub(crate) fn polynomials(out: &mut Vec<u8>, log: &PolynomialLog) {
    for coefficients in log.iter() {
        polynomial(out, coefficients);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_is_its_size_and_its_coefficients() {
        let mut bytes = Vec::new();
        polynomial(&mut bytes, &[-0.25, 0.25]);
        assert_eq!(bytes, [2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xd0, 0xbf, 0, 0, 0, 0, 0, 0, 0xd0, 0x3f]);
        bytes.clear();
        polynomial(&mut bytes, &[]);
        assert_eq!(bytes, [0, 0, 0, 0]);
    }

    #[test]
    fn long_polynomials_are_encoded_like_short_ones() {
        let mut bytes = Vec::new();
        polynomial(&mut bytes, &[1.0; 9]);
        assert_eq!(bytes.len(), 4 + 72);
        assert_eq!(bytes[0], 9);
        assert_eq!(bytes[4..12], 1.0_f64.to_le_bytes());
        assert_eq!(bytes[68..], 1.0_f64.to_le_bytes());
    }
}
