//! Tests whether a polynomial clearly has no multiple zeros, by Euclid's algorithm for it and its derivative.
//!
//! A sample at a double zero is decided by rounding, even if the polynomial is far from zero within the step. The last
//! remainder of Euclid's algorithm is the discriminant up to a factor. It is compared with its largest change for a
//! relative change of the coefficients (to first order, computed together with each coefficient).
use super::super::tolerances::DISCRIMINANT_MARGIN;

/// The coefficients of a polynomial of degree below `LENGTH`, with 0 after the last.
#[derive(Clone, Copy)]
struct PerturbedCoefficients<const LENGTH: usize> {
    values: [f64; LENGTH],
    /// The largest change of each coefficient per relative change of the first polynomial's coefficients.
    changes: [f64; LENGTH],
}

impl<const LENGTH: usize> PerturbedCoefficients<LENGTH> {
    /// Returns whether the leading coefficient is clearly not zero. A NaN is not clearly different from zero.
    #[inline(always)]
    fn has_clear_leading(&self) -> bool {
        self.values[0].abs() > DISCRIMINANT_MARGIN * self.changes[0]
    }

    /// Subtracts the multiple of the divisor that cancels the leading coefficient, and shifts by one entry. This is one
    /// step of the division. All entries are computed, because entries after the last stay 0 and code without branches
    /// processes several together.
    #[inline(always)]
    fn subtract(&mut self, divisor: &Self, reciprocal: f64) {
        let Self { values, changes } = self;
        let factor = values[0] * reciprocal;
        let change = (changes[0] + factor.abs() * divisor.changes[0]) * reciprocal.abs();
        for i in 1..LENGTH {
            values[i - 1] = values[i] - factor * divisor.values[i];
            changes[i - 1] = changes[i] + factor.abs() * divisor.changes[i] + change * divisor.values[i].abs();
        }
        (values[LENGTH - 1], changes[LENGTH - 1]) = (0.0, 0.0);
    }
}

/// Returns whether no change of the coefficients (highest power first) by [`DISCRIMINANT_MARGIN`] of their absolute
/// values makes two zeros coincide. An intermediate remainder of an unusually low degree gives `false`, too.
#[inline]
pub(super) fn are_zeros_separated<const LENGTH: usize>(coefficients: &[f64; LENGTH]) -> bool {
    let mut dividend = PerturbedCoefficients { values: *coefficients, changes: coefficients.map(f64::abs) };
    #[expect(clippy::cast_precision_loss, reason = "degrees up to five")]
    let values = std::array::from_fn(|i| coefficients[i] * (LENGTH - 1 - i) as f64);
    let mut divisor = PerturbedCoefficients { values, changes: values.map(f64::abs) };
    for _ in 2..LENGTH {
        if !divisor.has_clear_leading() {
            return false;
        }
        // Two steps of the division leave a remainder that is shorter by two than the dividend.
        let reciprocal = 1.0 / divisor.values[0];
        dividend.subtract(&divisor, reciprocal);
        dividend.subtract(&divisor, reciprocal);
        (dividend, divisor) = (divisor, dividend);
    }
    divisor.has_clear_leading()
}

#[cfg(test)]
mod tests {
    use super::are_zeros_separated;

    #[test]
    fn different_zeros_are_separated_even_if_of_different_size() {
        assert!(are_zeros_separated(&[1.0, -6.0, 11.0, -6.0]));
        // The zeros are those of (z - 1)(z - 1000)(z - 2)(z + 3000), and a pair at +-i.
        assert!(are_zeros_separated(&[1.0, 1997.0, -3_005_998.0, 9_004_000.0, -6_000_000.0]));
        assert!(are_zeros_separated(&[1.0, -10.0, 36.0, -60.0, 35.0, -50.0]));
    }

    #[test]
    fn multiple_zeros_are_not() {
        // The polynomials are (z - 1)^2 (z + 2), the same with a change of 1e-12, and (z - 1)^2 (z - 2)(z - 3)(z - 4).
        assert!(!are_zeros_separated(&[1.0, 0.0, -3.0, 2.0]));
        assert!(!are_zeros_separated(&[1.0, 1e-12, -3.0, 2.0]));
        assert!(!are_zeros_separated(&[1.0, -11.0, 45.0, -85.0, 74.0, -24.0]));
        assert!(are_zeros_separated(&[1.0, -11.0, 45.0, -85.0, 74.0, -24.1]));
        assert!(!are_zeros_separated(&[1.0, f64::NAN, 45.0, -85.0]));
    }
}
