//! Encodes the blocks of a record (trace-format.md 1): little-endian, packed, into reused buffers.
//!
//! This module does not write to a stream; [`super::Writer`] does. No function checks its input.
use super::frame::LoggedImpulse;
use crate::sim::State;

/// The size of an encoded impulse in bytes: three `i32`, three `f64`.
pub(crate) const IMPULSE_BYTES: usize = 36;

/// Appends `values` one after the other.
// This function is not inlined, because it would then be compiled in the crate of each recorder, at that crate's
// optimization level.
pub(crate) fn append_numbers(out: &mut Vec<u8>, values: &[f64]) {
    let start = out.len();
    out.resize(start + 8 * values.len(), 0);
    for (bytes, value) in out[start..].chunks_exact_mut(8).zip(values) {
        bytes.copy_from_slice(&value.to_le_bytes());
    }
}

/// Appends positions and velocities.
pub(crate) fn append_state(out: &mut Vec<u8>, state: &State) {
    append_numbers(out, &state.positions);
    append_numbers(out, &state.velocities);
}

/// Appends a list's count. The format has no room for counts above the 32-bit range.
///
/// # Panics
/// Panics if the count exceeds `i32::MAX`.
#[inline]
pub(crate) fn append_count(out: &mut Vec<u8>, count: usize) {
    let count = i32::try_from(count).expect("a list has fewer than 2^31 entries");
    out.extend_from_slice(&count.to_le_bytes());
}

/// Appends one impulse.
#[inline]
pub(crate) fn encode_impulse(out: &mut Vec<u8>, impulse: &LoggedImpulse) {
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
pub(crate) fn encode_polynomial(out: &mut Vec<u8>, coefficients: &[f64]) {
    append_count(out, coefficients.len());
    append_numbers(out, coefficients);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_is_its_size_and_its_coefficients() {
        let mut bytes = Vec::new();
        encode_polynomial(&mut bytes, &[-0.25, 0.25]);
        assert_eq!(bytes, [2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xd0, 0xbf, 0, 0, 0, 0, 0, 0, 0xd0, 0x3f]);
        bytes.clear();
        encode_polynomial(&mut bytes, &[]);
        assert_eq!(bytes, [0, 0, 0, 0]);
    }

    #[test]
    fn long_polynomials_are_encoded_like_short_ones() {
        let mut bytes = Vec::new();
        encode_polynomial(&mut bytes, &[1.0; 9]);
        assert_eq!(bytes.len(), 4 + 72);
        assert_eq!(bytes[0], 9);
        assert_eq!(bytes[4..12], 1.0_f64.to_le_bytes());
        assert_eq!(bytes[68..], 1.0_f64.to_le_bytes());
    }
}
