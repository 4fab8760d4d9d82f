//! Polynomials of degree at most five (six while searching zeros), in fixed storage, highest power first.

/// The largest number of coefficients of a detection polynomial (degree 5).
pub const MAX_COEFFICIENTS: usize = 6;

/// A real polynomial, **highest power first**, after removal of the small leading coefficients.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Polynomial {
    length: u8,
    coefficients: [f64; MAX_COEFFICIENTS],
}

impl Polynomial {
    /// Drops leading coefficients with `|c| < 1e-12` (root-finder.md 15.1, the dropping build; a NaN stops the
    /// dropping). The result may be empty.
    ///
    /// # Panics
    /// With more than [`MAX_COEFFICIENTS`] coefficients.
    #[inline]
    #[must_use]
    pub fn trimmed(coefficients: &[f64]) -> Self {
        let mut start = 0;
        while start < coefficients.len() && coefficients[start].abs() < super::tolerances::LEADING_COEFFICIENT {
            start += 1;
        }
        Self::untrimmed(&coefficients[start..])
    }

    /// Takes the list as it is (the non-dropping build of later milestones).
    ///
    /// # Panics
    /// With more than [`MAX_COEFFICIENTS`] coefficients.
    #[inline]
    #[must_use]
    pub fn untrimmed(coefficients: &[f64]) -> Self {
        let mut storage = [0.0; MAX_COEFFICIENTS];
        storage[..coefficients.len()].copy_from_slice(coefficients);
        #[expect(clippy::cast_possible_truncation, reason = "at most six, else the copy above has panicked")]
        Self { length: coefficients.len() as u8, coefficients: storage }
    }

    /// The coefficients, highest power first; empty when all were too small.
    #[inline]
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients[..usize::from(self.length)]
    }

    /// The value at `t` by Horner's rule started from `+0` (root-finder.md 15.2: `0 * inf` is NaN, hence not positive).
    #[inline]
    #[must_use]
    pub fn evaluate(&self, t: f64) -> f64 {
        self.coefficients().iter().fold(0.0, |value, &c| value * t + c)
    }
}
