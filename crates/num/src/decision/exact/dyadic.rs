//! Times as dyadic fractions, which are integers divided by a power of two.
use num_bigint::BigInt;

/// The nonnegative number `numerator / 2^exponent`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct DyadicNumber {
    /// The nonnegative numerator.
    pub(super) numerator: BigInt,
    /// The exponent of the denominator.
    pub(super) exponent: u64,
}

impl DyadicNumber {
    /// The number 0.
    pub(super) const ZERO: Self = Self { numerator: BigInt::ZERO, exponent: 0 };

    /// Returns the number 1.
    pub(super) fn one() -> Self {
        Self { numerator: BigInt::from(1), exponent: 0 }
    }

    /// Returns the numerator of the number as a fraction with the denominator `2^exponent`. The exponent must be at
    /// least the number's own.
    fn numerator_over(&self, exponent: u64) -> BigInt {
        &self.numerator << (exponent - self.exponent)
    }

    /// Returns the midpoint of two times.
    pub(super) fn midpoint(&self, other: &Self) -> Self {
        let exponent = self.exponent.max(other.exponent);
        Self { numerator: self.numerator_over(exponent) + other.numerator_over(exponent), exponent: exponent + 1 }
    }

    /// Returns whether the time is 1.
    pub(super) fn is_one(&self) -> bool {
        self.numerator == BigInt::from(1) << self.exponent
    }

    /// Returns the largest double that is not above the number, and the smallest that is not below it.
    pub(super) fn enclosure(&self) -> [f64; 2] {
        let bits = self.numerator.bits();
        let dropped = bits.saturating_sub(53);
        let top = u64::try_from(&self.numerator >> dropped).unwrap_or(0);
        let exact = self.numerator == BigInt::from(top) << dropped;
        // The value is between top and top + 1 (or at top) times 2^scale, and is at most 1.
        let scale = i128::from(dropped) - i128::from(self.exponent);
        let Ok(scale) = i32::try_from(scale) else { return [0.0, f64::from_bits(1)] };
        if scale < -1074 {
            // The time is subnormal, so the enclosure is coarse. Zero itself is exact.
            return if top == 0 { [0.0; 2] } else { [0.0, scale_by_power(top + 1, -1074)] };
        }
        [scale_by_power(top, scale), scale_by_power(if exact { top } else { top + 1 }, scale)]
    }
}

/// Returns `integer * 2^exponent` for an integer up to `2^53`. The result is exact for exponents in `-1074..=0` if it
/// is at most 1.
fn scale_by_power(integer: u64, exponent: i32) -> f64 {
    let power = |exponent: i32| f64::from_bits(u64::try_from(exponent + 1023).unwrap_or(0) << 52);
    let half = exponent / 2;
    integer as f64 * power(half) * power(exponent - half)
}

#[cfg(test)]
mod tests {
    use super::DyadicNumber;
    use num_bigint::BigInt;

    fn dyadic(numerator: &str, exponent: u64) -> DyadicNumber {
        DyadicNumber { numerator: numerator.parse::<BigInt>().expect("a number"), exponent }
    }

    #[test]
    fn fractions_that_are_doubles_are_enclosed_by_themselves() {
        assert_eq!(DyadicNumber::ZERO.enclosure(), [0.0; 2]);
        assert_eq!(dyadic("1024", 10).enclosure(), [1.0; 2]);
        assert_eq!(dyadic("3", 3).enclosure(), [0.375; 2]);
        assert_eq!(dyadic("1", 1074).enclosure(), [f64::from_bits(1); 2]);
    }

    #[test]
    fn others_lie_between_neighbors() {
        // This is 2^60 + 1 over 2^61, just above one half.
        assert_eq!(dyadic("1152921504606846977", 61).enclosure(), [0.5, 0.5_f64.next_up()]);
        // This is 2^54 - 1 over 2^54, which is rounded up to 1.
        assert_eq!(dyadic("18014398509481983", 54).enclosure(), [1.0_f64.next_down(), 1.0]);
        let [lo, hi] = dyadic("5", 1080).enclosure();
        assert!(lo == 0.0 && hi > 0.0);
    }

    #[test]
    fn midpoints() {
        assert_eq!(DyadicNumber::ZERO.midpoint(&DyadicNumber::one()).enclosure(), [0.5; 2]);
        assert_eq!(dyadic("1", 2).midpoint(&DyadicNumber::one()).enclosure(), [0.625; 2]);
        assert!(dyadic("4", 2).is_one() && !dyadic("3", 2).is_one());
    }
}
