//! Collects the factors by which a program multiplies its polynomials, as the trace's polynomials show them.
use fosssim_model::sim::{PairKind, PairKindMap};
use fosssim_num::tolerances::FAIR_OUTLIER_DEVIATIONS;

/// The factors that polynomials of one kind of pair and one number show: the smallest factor, the largest, and the
/// distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FactorStatistics {
    least: f64,
    greatest: f64,
    /// The factor that was added last.
    last: f64,
    count: u64,
    /// The sum of the factors' binary exponents, and the sum of the squared exponents.
    exponents: i64,
    squares: i64,
}

/// The factors for each kind of pair and each number of a polynomial.
pub type FactorsByPolynomial = PairKindMap<[FactorStatistics; PairKind::MAX_POLYNOMIALS]>;

impl Default for FactorStatistics {
    fn default() -> Self {
        Self { least: f64::INFINITY, greatest: f64::NEG_INFINITY, last: 1.0, count: 0, exponents: 0, squares: 0 }
    }
}

impl FactorStatistics {
    /// Adds a positive, finite factor.
    #[inline]
    pub(super) fn add_factor(&mut self, factor: f64) {
        let exponent = (factor.to_bits() >> 52).cast_signed() - 1023;
        (self.least, self.greatest) = (self.least.min(factor), self.greatest.max(factor));
        self.last = factor;
        self.count += 1;
        self.exponents += exponent;
        self.squares += exponent * exponent;
    }

    /// Adds `count` factors of 1.
    pub(super) fn add_unit_factors(&mut self, count: u64) {
        if count > 0 {
            (self.least, self.greatest) = (self.least.min(1.0), self.greatest.max(1.0));
            self.count += count;
        }
    }

    /// Adds the factors of a later step.
    pub(super) fn add(&mut self, other: &Self) {
        if other.count > 0 {
            (self.least, self.greatest) = (self.least.min(other.least), self.greatest.max(other.greatest));
            self.last = other.last;
            self.count += other.count;
            self.exponents += other.exponents;
            self.squares += other.squares;
        }
    }

    /// Returns the last factor, or 1 if there are no factors.
    pub(super) fn last(&self) -> f64 {
        self.last
    }

    /// Returns the smallest and the largest factor, or `None` if there are no factors.
    pub fn range(&self) -> Option<[f64; 2]> {
        (self.count > 0).then_some([self.least, self.greatest])
    }

    /// Returns the smallest and the largest usual factor, or `None` if there are no factors. Outliers are left out,
    /// because they prove nothing about missing coefficients.
    pub(super) fn usual_range(&self) -> Option<[f64; 2]> {
        let [lowest, highest] = self.range()?;
        let average = |sum: i64| sum as f64 / self.count as f64;
        let mean = average(self.exponents);
        let spread = (average(self.squares) - mean * mean).max(0.0).sqrt();
        let reach = 1.0 + FAIR_OUTLIER_DEVIATIONS * spread;
        Some([lowest.max(power_of_two(mean - reach)), highest.min(power_of_two(mean + reach + 1.0))])
    }
}

/// Returns 2 to the power `power`, rounded down. Beyond the normal numbers, the result is 0 or infinity.
fn power_of_two(power: f64) -> f64 {
    if power < -1022.0 {
        return 0.0;
    }
    if power >= 1024.0 {
        return f64::INFINITY;
    }
    #[expect(clippy::cast_possible_truncation, reason = "between the exponents of normal numbers")]
    let exponent = power.floor() as i64;
    f64::from_bits((exponent + 1023).cast_unsigned() << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factors_from(factors: impl IntoIterator<Item = f64>) -> FactorStatistics {
        let mut all = FactorStatistics::default();
        factors.into_iter().for_each(|factor| all.add_factor(factor));
        all
    }

    #[test]
    fn one_among_dozens_vouches_for_nothing() {
        let with = |others: usize| {
            factors_from(std::iter::repeat_n(1.0, others).chain([1e-13])).usual_range().expect("factors")
        };
        assert_eq!(with(5), [1e-13, 1.0]);
        let [least, greatest] = with(30);
        assert!(least > 1e-9 && greatest == 1.0, "{least}");
    }

    #[test]
    fn frequent_factors_are_usual() {
        assert_eq!(factors_from([3.0, 3.0, 3.0]).usual_range(), Some([3.0; 2]));
        assert_eq!(
            factors_from((0..300).map(|n| if n % 5 == 0 { 1e-6 } else { 2.0 })).usual_range(),
            Some([1e-6, 2.0])
        );
        // The polynomials are divided by their sizes.
        let sizes = factors_from((1..500).map(|n| 1.0 / f64::from(n)));
        assert_eq!(sizes.usual_range().map(|[least, _]| least), Some(1.0 / 499.0));
        for factor in [5e-324, 1e-300, 1.0, 1e300, f64::MAX] {
            assert_eq!(factors_from([factor; 9]).usual_range(), Some([factor; 2]));
        }
        assert_eq!(FactorStatistics::default().usual_range(), None);
    }

    #[test]
    fn two_steps_tell_what_one_tells() {
        let (mut one, all) = (factors_from([1.0, 5.0]), factors_from([1.0, 5.0, 0.25, 1e-7]));
        one.add(&factors_from([0.25, 1e-7]));
        one.add(&FactorStatistics::default());
        assert_eq!(one, all);
    }
}
