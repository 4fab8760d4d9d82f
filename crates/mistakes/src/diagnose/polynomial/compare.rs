//! Compares a logged polynomial with a given one, up to a positive scale and round-off.
//!
//! [`fosssim_judge::fair`] decides about right polynomials; this module compares with wrong formulas, within the same
//! bounds. Coefficients are aligned at the constant term. Missing coefficients are small ones that the course's library
//! has dropped.
use fosssim_judge::fair::compare::compare;
use fosssim_num::{
    bounded::{BoundedValue, UNIT_ROUNDOFF},
    tolerances::{FAIR_NORM_UNITS, FAIR_UNITS, MIN_LEADING_COEFFICIENT},
};

fosssim_model::drops_leading!();

/// The largest allowed deviation of a coefficient, relative to its bound; both sides are rounded.
const COEFFICIENT_TOLERANCE: f64 = 2.0 * FAIR_UNITS * UNIT_ROUNDOFF;

/// Returns the logged coefficient of a power, or `None` if it was dropped.
pub(super) fn logged_at(logged: &[f64], power: usize) -> Option<f64> {
    logged.len().checked_sub(power + 1).map(|index| logged[index])
}

/// Returns the expected coefficient of a power, or 0 if the power is above the degree.
pub(super) fn expected_at(expected: &[BoundedValue], power: usize) -> BoundedValue {
    expected.len().checked_sub(power + 1).map_or(BoundedValue::default(), |index| expected[index])
}

/// Returns whether one logged coefficient is `scale` times the expected one. A NaN is never such a multiple.
pub(super) fn coefficient_matches(expected: BoundedValue, logged: Option<f64>, scale: f64) -> bool {
    let room = COEFFICIENT_TOLERANCE * scale.abs() * expected.bound;
    match logged {
        Some(value) => (value - scale * expected.value).abs() <= room,
        None => (scale * expected.value).abs() <= MIN_LEADING_COEFFICIENT + room,
    }
}

/// Returns whether the logged polynomial is `scale` times the expected one. A program may also compute its coefficients
/// from values of the polynomial. Then all coefficients have the rounding error of the largest one.
pub(super) fn polynomial_matches(expected: &[BoundedValue], logged: &[f64], scale: f64) -> bool {
    let norm: f64 = expected.iter().map(|coefficient| coefficient.bound).sum();
    let min_bound = FAIR_NORM_UNITS * UNIT_ROUNDOFF / COEFFICIENT_TOLERANCE * norm;
    (0..expected.len().max(logged.len())).all(|power| {
        let BoundedValue { value, bound } = expected_at(expected, power);
        coefficient_matches(BoundedValue { value, bound: bound.max(min_bound) }, logged_at(logged, power), scale)
    })
}

/// Returns the scale that brings the expected polynomial closest to the logged one. Each coefficient is weighted by its
/// precision. Returns `None` if no coefficient exceeds round-off, or if the scale is not positive.
pub(super) fn fit_scale(expected: &[BoundedValue], logged: &[f64]) -> Option<f64> {
    fit_scale_to_powers(expected, logged, |_| true)
}

/// Returns the same scale as [`fit_scale`], but computed only from the coefficients for whose powers `power` is true.
pub(super) fn fit_scale_to_powers(
    expected: &[BoundedValue],
    logged: &[f64],
    power: impl Fn(usize) -> bool,
) -> Option<f64> {
    let (mut above, mut below) = (0.0, 0.0);
    for power in (0..expected.len()).filter(|&index| power(index)) {
        let (coefficient, Some(value)) = (expected_at(expected, power), logged_at(logged, power)) else { continue };
        if exceeds_round_off(coefficient) {
            let share = coefficient.value / coefficient.bound.max(coefficient.value.abs());
            above += value / coefficient.value * share * share;
            below += share * share;
        }
    }
    let scale = above / below;
    (scale > 0.0 && scale.is_finite()).then_some(scale)
}

/// Returns whether a coefficient exceeds round-off.
pub(super) fn exceeds_round_off(coefficient: BoundedValue) -> bool {
    coefficient.value.abs() > FAIR_UNITS * UNIT_ROUNDOFF * coefficient.bound
}

/// Returns whether the logged polynomial is right: the expected polynomial times a positive scale.
pub(super) fn is_right(expected: &[BoundedValue], logged: &[f64]) -> bool {
    compare(expected, logged, &[1.0]).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(values: &[f64]) -> Vec<BoundedValue> {
        values.iter().map(|&value| BoundedValue::from_rounded(value)).collect()
    }

    #[test]
    fn a_positive_scale_is_right_and_a_negative_one_is_not() {
        let expected = exact(&[-3.0, 0.1, 7.0]);
        assert!(is_right(&expected, &[-3.0, 0.1, 7.0]));
        assert!(is_right(&expected, &[-3.0 * 0.7, 0.1 * 0.7, 7.0 * 0.7]));
        assert!(!is_right(&expected, &[3.0, -0.1, -7.0]));
        assert!(!is_right(&expected, &[-3.0, 0.1, 7.000_001]));
        assert!(!is_right(&expected, &[f64::NAN, 0.1, 7.0]));
        assert!(!is_right(&expected, &[]));
    }

    #[test]
    fn dropped_small_coefficients_are_right_and_dropped_large_ones_are_not() {
        assert!(is_right(&exact(&[5e-13, 2.0, 1.0]), &[2.0, 1.0]));
        assert!(!is_right(&exact(&[5e-11, 2.0, 1.0]), &[2.0, 1.0]));
        assert!(is_right(&exact(&[0.0, 0.0]), &[]));
    }

    #[test]
    fn a_longer_polynomial_is_right_only_with_leading_zeros() {
        assert!(is_right(&exact(&[2.0, 1.0]), &[0.0, 2.0, 1.0]));
        assert!(!is_right(&exact(&[2.0, 1.0]), &[2.0, 1.0, 0.0]));
    }
}
