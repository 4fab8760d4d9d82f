//! The two extreme choices of a detection's coefficients, and the results that follow from their signs and Bernstein
//! coefficients.
//!
//! Levels 0 and 1 of [`super::decide`] check one polynomial at a time. Every comparison allows for the rounding of
//! the computation itself, so its result is proved (rounding as in Higham, *Accuracy and Stability of Numerical
//! Algorithms*, section 3.1).
use super::{BoundedValue, Level, MAX_COEFFICIENTS, MAX_POLYNOMIALS, UNIT_ROUNDOFF};

/// One end of every coefficient's interval.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum IntervalEnd {
    /// The largest values.
    Upper,
    /// The smallest values.
    Lower,
}

/// A bound that exceeds the total effect of underflow on a sum or a convex combination of six numbers, fifty times in a
/// row.
const UNDERFLOW_BOUND: f64 = f64::MIN_POSITIVE * (1.0 / 1_048_576.0);

/// The bound on the error of the Bernstein coefficients, in units of the sum of the absolute power coefficients.
const CONVERSION_BOUND: f64 = 16.0 * UNIT_ROUNDOFF;

/// The number of roundings up to a Bernstein coefficient. A weight, a product, all sums except the first, and the sum
/// of the absolute coefficients are rounded. The proof allows for twice as many.
const ROUNDING_COUNT: usize = 1 + 1 + (MAX_COEFFICIENTS - 1) + 1;
const _: () = assert!(CONVERSION_BOUND >= 2.0 * ROUNDING_COUNT as f64 * UNIT_ROUNDOFF, "the margin of the proof");

/// A polynomial whose coefficients have no errors.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ExactPolynomial {
    /// The coefficients, lowest power first. Zeros follow after `length`.
    pub(crate) coefficients: [f64; MAX_COEFFICIENTS],
    /// The number of coefficients.
    pub(crate) length: usize,
    /// The sum of the original coefficients' bounds: the largest change by one unit within `[0, 1]`, divided by `u`.
    pub(crate) bound: f64,
}

/// The Bernstein coefficients on a piece of `[0, 1]`. The last `6 - length` are unused.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BernsteinForm {
    /// The coefficients in the Bernstein basis; only the first `length` are used.
    pub(crate) values: [f64; MAX_COEFFICIENTS],
    /// The number of coefficients.
    pub(crate) length: usize,
    /// The maximum error of each coefficient.
    pub(crate) error: f64,
    /// The index of the polynomial in the problem.
    pub(crate) index: usize,
}

/// The polynomials of a detection for one extreme choice of coefficients.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Problem {
    list: [ExactPolynomial; MAX_POLYNOMIALS],
    count: usize,
}

impl Problem {
    /// Creates the choice at the ends `ends`, rounded outward; coefficients without error are unchanged.
    ///
    /// # Panics
    /// Panics if there are too many polynomials or coefficients.
    #[inline]
    pub(crate) fn new(polynomials: &[&[BoundedValue]], units: f64, ends: IntervalEnd) -> Self {
        assert!(polynomials.len() <= MAX_POLYNOMIALS, "a detection has at most MAX_POLYNOMIALS polynomials");
        let empty = ExactPolynomial { coefficients: [0.0; MAX_COEFFICIENTS], length: 0, bound: 0.0 };
        let mut problem = Self { list: [empty; MAX_POLYNOMIALS], count: polynomials.len() };
        for (exactly, polynomial) in problem.list.iter_mut().zip(polynomials) {
            assert!(polynomial.len() <= MAX_COEFFICIENTS, "a polynomial has at most MAX_COEFFICIENTS coefficients");
            exactly.length = polynomial.len();
            for (value, &coefficient) in exactly.coefficients.iter_mut().zip(polynomial.iter().rev()) {
                *value = interval_end(coefficient, units, ends);
                exactly.bound += coefficient.bound;
            }
        }
        problem
    }

    /// Returns the polynomials.
    #[inline]
    pub(crate) fn polynomials(&self) -> &[ExactPolynomial] {
        &self.list[..self.count]
    }

    /// Returns whether all coefficients are finite.
    #[inline]
    pub(crate) fn is_finite(&self) -> bool {
        self.polynomials().iter().all(|polynomial| {
            // A product with 0 is 0 for finite numbers, and NaN for others.
            polynomial.coefficients.iter().map(|value| value * 0.0).sum::<f64>() == 0.0
        })
    }

    /// Returns the level of a proof, by one polynomial alone, that there is no hit within the step. The second value
    /// says by how many units of their bounds the coefficients may additionally be wrong. Returns `None` if no
    /// polynomial proves this. A problem without polynomials never hits.
    #[inline]
    pub(crate) fn find_exclusion(&self) -> Option<(Level, f64)> {
        if self.count == 0 {
            return Some((Level::Range, f64::INFINITY));
        }
        let by = |test: fn(&ExactPolynomial) -> Option<f64>, level| {
            self.polynomials().iter().find_map(test).map(|slack| (level, slack))
        };
        by(ExactPolynomial::try_signs, Level::Range).or_else(|| by(ExactPolynomial::try_bernstein, Level::Bernstein))
    }

    /// Returns whether all polynomials are positive at 0. The answer is exact, because no arithmetic is needed.
    #[inline]
    pub(crate) fn starts_positive(&self) -> bool {
        self.polynomials().iter().all(|polynomial| polynomial.coefficients[0] > 0.0)
    }

    /// Returns whether two problems of the same shape have the same coefficients.
    pub(crate) fn has_equal_coefficients(&self, other: &Self) -> bool {
        let pairs = self.polynomials().iter().zip(other.polynomials());
        pairs.into_iter().all(|(one, two)| one.coefficients == two.coefficients)
    }

    /// Returns the coefficients, highest power first, with their number.
    pub(crate) fn coefficients_highest_first(&self) -> [([f64; MAX_COEFFICIENTS], usize); MAX_POLYNOMIALS] {
        self.list.map(|polynomial| {
            let mut list = [0.0; MAX_COEFFICIENTS];
            for (entry, value) in list.iter_mut().zip(polynomial.coefficients[..polynomial.length].iter().rev()) {
                *entry = *value;
            }
            (list, polynomial.length)
        })
    }

    /// Returns the largest difference between the binary exponents of two nonzero coefficients of one polynomial.
    pub(crate) fn exponent_spread(&self) -> u64 {
        let spread = |polynomial: &ExactPolynomial| {
            let exponents =
                polynomial.coefficients.iter().filter(|value| **value != 0.0).map(|value| value.abs().to_bits() >> 52);
            exponents.clone().max().unwrap_or(0) - exponents.min().unwrap_or(0)
        };
        self.polynomials().iter().map(spread).max().unwrap_or(0)
    }

    /// Returns the number of units by which the bounds can grow while a hit stays a hit, at least 0. It is the smallest
    /// of the polynomials' values over their bounds, at the best of several times from `first` on. The times are spread
    /// evenly over the rest of the step, and more closely after `first`, because a hit may be short.
    pub(crate) fn hit_slack(&self, first: f64) -> f64 {
        let slack_at = |t: f64| {
            let slacks = self.polynomials().iter().map(|polynomial| polynomial.slack_at(t));
            slacks.fold(f64::INFINITY, f64::min)
        };
        let rest = 1.0 - first;
        let mut best = slack_at(1.0);
        let mut fraction = 0.5;
        for step in 1..16_u8 {
            fraction *= 0.25;
            best = best.max(slack_at(first + rest * (f64::from(step) / 16.0))).max(slack_at(first + rest * fraction));
        }
        best
    }
}

/// Returns one end of the interval that contains a coefficient, rounded outward.
#[inline]
fn interval_end(coefficient: BoundedValue, units: f64, ends: IntervalEnd) -> f64 {
    if units == 0.0 || coefficient.bound == 0.0 {
        return coefficient.value;
    }
    // The factor and the last two terms cover the rounding of the products and of the sum, and underflow.
    let reach = units * UNIT_ROUNDOFF * coefficient.bound * (1.0 + 8.0 * UNIT_ROUNDOFF)
        + coefficient.value.abs() * (2.0 * UNIT_ROUNDOFF)
        + f64::MIN_POSITIVE;
    match ends {
        IntervalEnd::Upper => coefficient.value + reach,
        IntervalEnd::Lower => coefficient.value - reach,
    }
}

/// Returns a distance from zero in units of a bound.
#[inline]
pub(crate) fn slack(distance: f64, bound: f64) -> f64 {
    // One percent less covers the rounding of the bound and of the quotient.
    if bound > 0.0 { (0.99 * distance / (bound * UNIT_ROUNDOFF)).max(0.0) } else { f64::INFINITY }
}

impl ExactPolynomial {
    /// Returns the slack of a proof by level 0, or `None` if the signs do not exclude a hit. They exclude a hit if no
    /// coefficient is positive, or if the positive terms cannot compensate a negative constant.
    #[inline]
    fn try_signs(&self) -> Option<f64> {
        let (mut greatest, mut size) = (self.coefficients[0], self.coefficients[0].abs());
        let mut none_positive = !(self.coefficients[0] > 0.0);
        for &value in &self.coefficients[1..] {
            none_positive &= !(value > 0.0);
            greatest += value.max(0.0);
            size += value.abs();
        }
        let distance = -greatest - CONVERSION_BOUND * size;
        if distance > 0.0 || none_positive { Some(slack(distance, self.bound)) } else { None }
    }

    /// Returns the slack of a proof by level 1, or `None` if not all Bernstein coefficients are negative.
    #[inline]
    fn try_bernstein(&self) -> Option<f64> {
        // The polynomial is positive at 0, so no search is needed.
        if self.coefficients[0] > 0.0 {
            return None;
        }
        let control = self.compute_bernstein();
        let greatest =
            control.values[..control.length].iter().fold(f64::NEG_INFINITY, |maximum, &value| maximum.max(value));
        let distance = -greatest - control.error;
        (distance > 0.0).then(|| slack(distance, self.bound))
    }

    /// Returns the Bernstein coefficients on `[0, 1]`. An overflow makes the error infinite, so that nothing is
    /// concluded from it.
    #[inline]
    pub(crate) fn compute_bernstein(&self) -> BernsteinForm {
        let values = match self.length {
            0 | 1 => self.coefficients,
            2 => self.convert([1.0, 1.0]),
            3 => self.convert([1.0, 0.5, 1.0]),
            4 => self.convert([1.0, 1.0 / 3.0, 1.0 / 3.0, 1.0]),
            5 => self.convert([1.0, 0.25, 1.0 / 6.0, 0.25, 1.0]),
            _ => self.convert([1.0, 0.2, 0.1, 0.1, 0.2, 1.0]),
        };
        let size: f64 = self.coefficients.iter().map(|value| value.abs()).sum();
        BernsteinForm { values, length: self.length, error: CONVERSION_BOUND * size + UNDERFLOW_BOUND, index: 0 }
    }

    /// Returns the Bernstein coefficients on `[0, end]`, for an end that is a power of two between `2^-150` and 1:
    /// scaling is exact except for underflow.
    pub(crate) fn compute_bernstein_until(&self, end: f64) -> BernsteinForm {
        let (mut stretched, mut power) = (*self, 1.0);
        for value in &mut stretched.coefficients {
            *value *= power;
            power *= end;
        }
        stretched.compute_bernstein()
    }

    /// Returns the polynomial's coefficients in a Bernstein basis. Entry k is the sum of (k over i) times coefficient i
    /// times reciprocal i, added up as in Pascal's triangle.
    #[inline(always)]
    fn convert<const LENGTH: usize>(&self, reciprocals: [f64; LENGTH]) -> [f64; MAX_COEFFICIENTS] {
        let mut values = [0.0; MAX_COEFFICIENTS];
        for i in 0..LENGTH {
            values[i] = self.coefficients[i] * reciprocals[i];
        }
        for row in 1..LENGTH {
            for i in (row..LENGTH).rev() {
                values[i] += values[i - 1];
            }
        }
        values
    }

    /// Returns by how many units of the bound the value at `t` in `[0, 1]` exceeds zero, or 0 if it does not.
    fn slack_at(&self, t: f64) -> f64 {
        let (value, error) = self.value_at(t);
        if value > error { slack(value - error, self.bound) } else { 0.0 }
    }

    /// Returns the value at `t` in `[0, 1]`, and its maximum error.
    pub(crate) fn value_at(&self, t: f64) -> (f64, f64) {
        let (mut value, mut size) = (0.0, 0.0);
        for &coefficient in self.coefficients[..self.length].iter().rev() {
            value = value * t + coefficient;
            size = size * t + coefficient.abs();
        }
        (value, CONVERSION_BOUND * size + UNDERFLOW_BOUND)
    }
}
