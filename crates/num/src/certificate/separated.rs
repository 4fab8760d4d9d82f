//! Whether a polynomial is clearly free of multiple zeros, by Euclid's algorithm for it and its derivative.
//!
//! A sample that falls on a double zero is decided by rounding, even where the polynomial is far from zero within the
//! step. The last remainder of Euclid's algorithm is the discriminant up to a factor; it is compared with what a
//! relative change of the coefficients could make of it (to first order, carried along with each coefficient).
use super::super::tolerances::DISCRIMINANT_MARGIN;

/// A coefficient, and how much it changes per relative change of the polynomial's coefficients, at most.
#[derive(Clone, Copy, Default)]
struct Entry {
    value: f64,
    change: f64,
}

impl Entry {
    /// `self - factor * other`.
    #[inline(always)]
    fn less(self, factor: Self, other: Self) -> Self {
        Self {
            value: self.value - factor.value * other.value,
            change: self.change + factor.value.abs() * other.change + factor.change * other.value.abs(),
        }
    }

    /// `self / other`, where `reciprocal` is that of the other's value.
    #[inline(always)]
    fn over(self, other: Self, reciprocal: f64) -> Self {
        let value = self.value * reciprocal;
        Self { value, change: (self.change + value.abs() * other.change) * reciprocal.abs() }
    }

    /// Whether it stays clear of zero. NaN does not.
    #[inline(always)]
    fn is_clear(self) -> bool {
        self.value.abs() > DISCRIMINANT_MARGIN * self.change
    }
}

/// Whether no change of the coefficients (highest power first) by [`DISCRIMINANT_MARGIN`] of their moduli makes two
/// zeros coincide. `false` also where an intermediate remainder is of lower degree than usual.
#[inline]
pub(super) fn zeros_are_separated<const LENGTH: usize>(coefficients: &[f64; LENGTH]) -> bool {
    let mut dividend = [Entry::default(); LENGTH];
    let mut divisor = [Entry::default(); LENGTH];
    #[expect(clippy::cast_precision_loss, reason = "degrees up to five")]
    for i in 0..LENGTH {
        let value = coefficients[i];
        dividend[i] = Entry { value, change: value.abs() };
        let value = value * (LENGTH - 1 - i) as f64;
        divisor[i] = Entry { value, change: value.abs() };
    }
    for degree in (2..LENGTH).rev() {
        let leading = divisor[0];
        if !leading.is_clear() {
            return false;
        }
        // Two steps of the division leave a remainder of degree `degree - 2`.
        let reciprocal = 1.0 / leading.value;
        for _ in 0..2 {
            let factor = dividend[0].over(leading, reciprocal);
            for i in 1..=degree {
                let other = if i < degree { divisor[i] } else { Entry::default() };
                dividend[i - 1] = dividend[i].less(factor, other);
            }
            dividend[degree] = Entry::default();
        }
        std::mem::swap(&mut dividend, &mut divisor);
    }
    divisor[0].is_clear()
}

#[cfg(test)]
mod tests {
    use super::zeros_are_separated;

    #[test]
    fn different_zeros_are_separated_even_if_of_different_size() {
        assert!(zeros_are_separated(&[1.0, -6.0, 11.0, -6.0]));
        // (z - 1)(z - 1000)(z - 2)(z + 3000) and a pair at +-i.
        assert!(zeros_are_separated(&[1.0, 1997.0, -3_005_998.0, 9_004_000.0, -6_000_000.0]));
        assert!(zeros_are_separated(&[1.0, -10.0, 36.0, -60.0, 35.0, -50.0]));
    }

    #[test]
    fn multiple_zeros_are_not() {
        // (z - 1)^2 (z + 2), the same with a change of 1e-12, and (z - 1)^2 (z - 2)(z - 3)(z - 4).
        assert!(!zeros_are_separated(&[1.0, 0.0, -3.0, 2.0]));
        assert!(!zeros_are_separated(&[1.0, 1e-12, -3.0, 2.0]));
        assert!(!zeros_are_separated(&[1.0, -11.0, 45.0, -85.0, 74.0, -24.0]));
        assert!(zeros_are_separated(&[1.0, -11.0, 45.0, -85.0, 74.0, -24.1]));
        assert!(!zeros_are_separated(&[1.0, f64::NAN, 45.0, -85.0]));
    }
}
