//! Polynomials in the bytes of a trace, written once when they are computed.
//!
//! A detection pass that only logs polynomials writes them here (trace-format.md 1: little-endian, packed, a 32-bit
//! size before the coefficients), and the recorder and the comparison of a step use the bytes unchanged.
use fosssim_num::polynomial::MAX_COEFFICIENTS;
use std::ops::Range;

/// A list of polynomials in a trace's bytes, without the list's count. Its memory is reused from step to step. Its
/// bytes may be kept for a caller that writes the lists of several steps together.
#[derive(Debug, Clone, Default)]
pub struct PolynomialBytes {
    /// The list occupies `bytes[start..used_bytes]`. Earlier lists may precede it, and free space follows.
    bytes: Vec<u8>,
    start: usize,
    used_bytes: usize,
    count: usize,
    max_modulus: f64,
}

/// The number of bytes of the largest polynomial that a detection logs.
const MAX_BYTES: usize = 4 + 8 * MAX_COEFFICIENTS;

/// The maximum number of bytes by which larger lists grow; small lists double. A hostile trace may make a step's list
/// take hundreds of megabytes, but not twice as many.
const MAX_GROWTH: usize = 16 << 20;

impl PolynomialBytes {
    /// Removes all lists, and begins an empty one.
    pub fn clear(&mut self) {
        self.used_bytes = 0;
        self.begin_list();
    }

    /// Begins a new list after the existing ones.
    pub(crate) fn begin_list(&mut self) {
        (self.start, self.count, self.max_modulus) = (self.used_bytes, 0, 0.0);
    }

    /// Returns the range of the list within [all bytes](Self::all_bytes).
    pub(crate) fn range(&self) -> Range<usize> {
        self.start..self.used_bytes
    }

    /// Returns the bytes of all lists.
    pub(crate) fn all_bytes(&self) -> &[u8] {
        &self.bytes[..self.used_bytes]
    }

    /// Returns the number of polynomials.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the list's bytes.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes[self.range()]
    }

    /// Returns the bytes of each polynomial's coefficients.
    pub fn iter(&self) -> impl Iterator<Item = &[u8]> {
        let mut rest = self.bytes();
        std::iter::from_fn(move || {
            let (size, behind) = rest.split_first_chunk::<4>()?;
            let own;
            (own, rest) = behind.split_at(8 * u32::from_le_bytes(*size) as usize);
            Some(own)
        })
    }

    /// Returns an upper bound of the absolute values of all coefficients, ignoring NaN. The bound may come from a pair
    /// that is not logged.
    pub fn max_modulus(&self) -> f64 {
        self.max_modulus
    }

    /// Appends one polynomial, highest power first.
    ///
    /// # Panics
    /// Panics if there are more than [`MAX_COEFFICIENTS`] coefficients.
    #[inline]
    pub fn push(&mut self, coefficients: &[f64]) {
        assert!(coefficients.len() <= MAX_COEFFICIENTS, "detection polynomials are of degree five at most");
        let mut largest = self.max_modulus;
        // A copy of constant length, of which only a part counts, is several times faster than a copy of variable
        // length.
        let mut polynomial = [0; MAX_BYTES];
        #[expect(clippy::cast_possible_truncation, reason = "at most six")]
        let size = coefficients.len() as u32;
        polynomial[..4].copy_from_slice(&size.to_le_bytes());
        for (bytes, coefficient) in polynomial[4..].chunks_exact_mut(8).zip(coefficients) {
            bytes.copy_from_slice(&coefficient.to_le_bytes());
            largest = if coefficient.abs() > largest { coefficient.abs() } else { largest };
        }
        self.reserve(MAX_BYTES)[..MAX_BYTES].copy_from_slice(&polynomial);
        self.max_modulus = largest;
        self.count_added(4 + 8 * coefficients.len(), 1);
    }

    /// Returns the free memory after the list, at least `bytes` bytes.
    #[inline]
    pub(super) fn reserve(&mut self, bytes: usize) -> &mut [u8] {
        if self.bytes.len() - self.used_bytes < bytes {
            self.grow(bytes);
        }
        &mut self.bytes[self.used_bytes..]
    }

    /// Appends `polynomials` polynomials, whose `bytes` bytes are already in the [reserved](Self::reserve) memory.
    #[inline]
    pub(super) fn count_added(&mut self, bytes: usize, polynomials: usize) {
        self.used_bytes += bytes;
        self.count += polynomials;
    }

    /// Raises the bound of absolute values to `largest`.
    #[inline]
    pub(super) fn raise_max_modulus(&mut self, largest: f64) {
        self.max_modulus = self.max_modulus.max(largest);
    }

    #[cold]
    fn grow(&mut self, bytes: usize) {
        let size = self.bytes.len();
        let new_size = (self.used_bytes + bytes).max(size + size.min(MAX_GROWTH));
        self.bytes.reserve_exact(new_size - size);
        self.bytes.resize(new_size, 0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A long list takes little more memory than its bytes.
    #[test]
    fn long_lists_do_not_double() {
        let mut list = PolynomialBytes::default();
        while list.bytes().len() < 5 * MAX_GROWTH {
            list.push(&[0.5; 6]);
        }
        assert!(list.bytes.capacity() <= list.bytes().len() + MAX_GROWTH, "{}", list.bytes.capacity());
    }

    #[test]
    fn polynomials_stand_one_behind_the_other() {
        let mut list = PolynomialBytes::default();
        list.push(&[1.0, -3.0]);
        list.push(&[]);
        list.push(&[0.5; 6]);
        assert_eq!((list.count(), list.max_modulus()), (3, 3.0));
        assert_eq!(list.bytes().len(), 20 + 4 + 52);
        assert_eq!(list.bytes()[..4], [2, 0, 0, 0]);
        assert_eq!(list.bytes()[12..20], (-3.0_f64).to_le_bytes());
        assert_eq!(list.bytes()[20..28], [0, 0, 0, 0, 6, 0, 0, 0]);
        list.begin_list();
        list.push(&[1.0]);
        assert_eq!((list.count(), list.max_modulus(), list.bytes().len(), list.range()), (1, 1.0, 12, 76..88));
        assert_eq!(list.all_bytes()[..4], [2, 0, 0, 0]);
        list.clear();
        list.push(&[f64::NAN]);
        assert_eq!((list.count(), list.max_modulus(), list.bytes().len()), (1, 0.0, 12));
    }
}
