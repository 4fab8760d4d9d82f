//! Finds the coefficients of a wrong polynomial that a person would call wrong.
//!
//! Any positive factor is right, so the coefficients are first divided by the factor on which most of them agree; 1 is
//! preferred. The original rescales by sums of absolute values instead (oracle-behavior.md 6.2), where one wrong
//! coefficient moves all the others. That comparison is kept in
//! [`RescaledCoefficient`](super::finding::RescaledCoefficient).

/// The relative difference below which coefficients agree.
const RATIO_TOLERANCE: f64 = 1e-9;

/// The accepted rounding error of a sum whose terms cancel, relative to the sum of their absolute values.
const CANCELLATION_FLOOR: f64 = 1e-13;

/// Returns the positive factor of the trace's polynomial on which most coefficients agree, or 1 if no factor is better.
/// Both lists have the highest power first and are aligned at the constant term.
pub fn find_factor(expected: &[f64], actual: &[f64]) -> f64 {
    let agreeing = |factor: f64| {
        let agrees = |power: &usize| {
            coefficient_of_power(expected, *power) != 0.0 && coefficient_agrees(expected, actual, *power, factor)
        };
        (0..expected.len()).filter(agrees).count()
    };
    // The coefficient from which a factor was computed always agrees with it, which proves nothing.
    let mut best = (agreeing(1.0).max(1), 1.0);
    for power in (0..expected.len().min(actual.len())).rev() {
        let ratio = coefficient_of_power(actual, power) / coefficient_of_power(expected, power);
        if ratio > 0.0 && ratio.is_finite() {
            let count = agreeing(ratio);
            if count > best.0 {
                best = (count, ratio);
            }
        }
    }
    best.1
}

/// Returns the powers of t whose coefficients differ with `factor`, the highest first.
pub fn find_differing_powers(expected: &[f64], actual: &[f64], factor: f64) -> Vec<usize> {
    let powers = (0..expected.len().max(actual.len())).rev();
    powers.filter(|&power| !coefficient_agrees(expected, actual, power, factor)).collect()
}

fn coefficient_agrees(expected: &[f64], actual: &[f64], power: usize, factor: f64) -> bool {
    let sum: f64 = expected.iter().map(|coefficient| coefficient.abs()).sum();
    let right = factor * coefficient_of_power(expected, power);
    (coefficient_of_power(actual, power) - right).abs()
        <= RATIO_TOLERANCE * right.abs() + CANCELLATION_FLOOR * factor * sum
}

/// Returns the coefficient of a power, or 0 if the list is too short.
fn coefficient_of_power(coefficients: &[f64], power: usize) -> f64 {
    coefficients.len().checked_sub(power + 1).map_or(0.0, |index| coefficients[index])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_after_the_best_factor_are_named() {
        let expected = [-0.2, 4.0, -3.0, 1.44, 0.5];
        for (scale, power) in [(1.0, 1), (1.0, 0), (3.0, 4), (0.125, 2)] {
            let mut actual = expected.map(|value| scale * value);
            actual[4 - power] *= 3.0;
            assert_eq!(find_factor(&expected, &actual), scale);
            assert_eq!(find_differing_powers(&expected, &actual, scale), [power]);
        }
    }

    #[test]
    fn without_agreement_the_factor_is_one() {
        assert_eq!(find_factor(&[1.0, 2.0], &[-1.0, -2.0]), 1.0);
        assert_eq!(find_factor(&[1.0, 2.0], &[3.0, 5.0]), 1.0);
        assert_eq!(find_differing_powers(&[1.0, 2.0], &[3.0, 5.0], 1.0), [1, 0]);
        assert_eq!(find_differing_powers(&[1.0, 2.0], &[f64::NAN, 2.0], 1.0), [1]);
        assert_eq!(find_differing_powers(&[1.0, 2.0], &[2.0], 1.0), [1]);
    }
}
