//! Polynomials of degree at most five (six while zeros are searched), in fixed storage, highest power first.
use super::number_serde::WrittenNumber;
use serde::{Deserialize, Serialize};

/// The maximum number of coefficients of a detection polynomial (degree 5).
pub const MAX_COEFFICIENTS: usize = 6;

/// A real polynomial, **highest power first**, after removal of the small leading coefficients.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(into = "Vec<WrittenNumber>", try_from = "Vec<WrittenNumber>")]
pub struct Polynomial {
    length: u8,
    /// The coefficients, at the end of the array, after zeros.
    storage: [f64; MAX_COEFFICIENTS],
}

impl From<Polynomial> for Vec<WrittenNumber> {
    fn from(polynomial: Polynomial) -> Self {
        polynomial.coefficients().iter().copied().map(WrittenNumber).collect()
    }
}

impl TryFrom<Vec<WrittenNumber>> for Polynomial {
    type Error = &'static str;

    fn try_from(form: Vec<WrittenNumber>) -> Result<Self, Self::Error> {
        let coefficients: Vec<f64> = form.into_iter().map(|number| number.0).collect();
        let is_short_enough = coefficients.len() <= MAX_COEFFICIENTS;
        is_short_enough
            .then(|| Self::untrimmed(&coefficients))
            .ok_or("a detection polynomial must have at most six coefficients")
    }
}

impl Polynomial {
    /// Drops leading coefficients with `|c| < 1e-12` (root-finder.md 15.1, the dropping build; a NaN stops the
    /// dropping). The result may be empty.
    ///
    /// # Panics
    /// Panics if there are more than [`MAX_COEFFICIENTS`] coefficients.
    #[inline]
    pub fn trimmed(coefficients: &[f64]) -> Self {
        let mut polynomial = Self::untrimmed(coefficients);
        polynomial.trim();
        polynomial
    }

    /// Drops leading coefficients in place, like [`Polynomial::trimmed`]. If polynomials are created for many pairs,
    /// this is faster, because none is copied.
    #[inline]
    pub fn trim(&mut self) {
        while let Some(leading) = self.storage[MAX_COEFFICIENTS - usize::from(self.length)..].first_mut() {
            if !is_small(*leading) {
                break;
            }
            *leading = 0.0;
            self.length -= 1;
        }
    }

    /// Creates a polynomial without dropping small leading coefficients, as the library of later milestones does
    /// (root-finder.md 15.1, the non-dropping build).
    ///
    /// # Panics
    /// Panics if there are more than [`MAX_COEFFICIENTS`] coefficients.
    #[inline]
    pub fn untrimmed(coefficients: &[f64]) -> Self {
        let mut storage = [0.0; MAX_COEFFICIENTS];
        storage[MAX_COEFFICIENTS - coefficients.len()..].copy_from_slice(coefficients);
        #[expect(clippy::cast_possible_truncation, reason = "at most six, else the copy above has panicked")]
        Self { length: coefficients.len() as u8, storage }
    }

    /// Returns the coefficients, highest power first. The list is empty if all coefficients were too small.
    #[inline]
    pub fn coefficients(&self) -> &[f64] {
        &self.storage[MAX_COEFFICIENTS - usize::from(self.length)..]
    }

    /// Returns the value at `t`, see [`evaluate`].
    #[inline]
    pub fn evaluate(&self, t: f64) -> f64 {
        evaluate(self.coefficients(), t)
    }
}

/// Returns the list without its small leading coefficients (root-finder.md 15.1, the dropping build; a NaN stops the
/// dropping). The result may be empty.
#[inline]
pub fn trim(coefficients: &[f64]) -> &[f64] {
    let mut rest = coefficients;
    while let [first, others @ ..] = rest
        && is_small(*first)
    {
        rest = others;
    }
    rest
}

#[inline]
fn is_small(leading: f64) -> bool {
    leading.abs() < super::tolerances::MIN_LEADING_COEFFICIENT
}

/// Returns the value at `t` by Horner's rule started from `+0` (root-finder.md 15.2: `0 * inf` is NaN, which is not
/// positive).
#[inline]
pub fn evaluate(coefficients: &[f64], t: f64) -> f64 {
    coefficients.iter().fold(0.0, |value, &c| value * t + c)
}

#[cfg(test)]
mod tests {
    use super::Polynomial;

    #[test]
    fn only_small_leading_coefficients_are_dropped() {
        assert_eq!(Polynomial::trimmed(&[1e-13, -9e-13, 1.0, 0.0]).coefficients(), [1.0, 0.0]);
        assert_eq!(Polynomial::trimmed(&[1e-12, 1.0]).coefficients(), [1e-12, 1.0]);
        assert_eq!(Polynomial::trimmed(&[0.0, 1e-13]).coefficients(), [0.0; 0]);
        assert_eq!(Polynomial::untrimmed(&[0.0, 1e-13]).coefficients(), [0.0, 1e-13]);
        assert_eq!(Polynomial::trimmed(&[f64::NAN, 1.0]).coefficients().len(), 2);
    }

    #[test]
    fn a_zero_coefficient_at_an_infinite_time_is_not_a_number() {
        assert!(Polynomial::trimmed(&[-1.0, 0.0]).evaluate(0.0) == 0.0);
        assert!(Polynomial::trimmed(&[1.0]).evaluate(f64::INFINITY).is_nan());
    }
}
