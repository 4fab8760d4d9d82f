use super::*;

/// Returns numbers from 0 to 1, the same ones in every run.
fn numbers() -> impl FnMut() -> f64 {
    let mut seed = 1_u64;
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The quick comparison gives the same result as the complete one, bit for bit.
#[test]
fn the_quick_comparison_agrees_with_the_complete_one() {
    let mut next = numbers();
    let mut answered = 0;
    for round in 0..20_000 {
        let length = 2 + round % 5;
        let expected: Vec<BoundedValue> = (0..length)
            .map(|_| {
                let value = (next() - 0.5) * [1.0, 1e-9, 1e3][(next() * 3.0) as usize];
                BoundedValue { value, bound: value.abs() * 40.0 * next() }
            })
            .collect();
        let (factor, noise) = (4.0 * next(), [0.0, 1e-15, 1e-13][round % 3]);
        let actual: Vec<f64> = expected.iter().map(|r| factor * (r.value + noise * (next() - 0.5) * r.bound)).collect();
        if let Some(found) = match_if_right(&expected, &actual) {
            let close = compare_any_kind(&expected, &actual, &[1.0]).expect("right");
            let bits = |found: Match| (found.scale.map(f64::to_bits), found.tolerance_share.to_bits());
            assert_eq!(bits(found), bits(close));
            answered += 1;
        }
    }
    assert!(answered > 5000, "{answered}");
}

/// Polynomials that the quick comparison accepts are also right in the complete one, with the same factor except for
/// round-off.
#[test]
fn quickly_accepted_polynomials_are_right() {
    let mut next = numbers();
    let mut answered = 0;
    for round in 0..40_000 {
        let length = 2 + round % 5;
        let expected: Vec<BoundedValue> = (0..length)
            .map(|_| {
                let value = (next() - 0.5) * [1.0, 1e-9, 1e3, 1e-13][(next() * 4.0) as usize];
                BoundedValue { value, bound: value.abs() * (1.0 + 40.0 * next()) }
            })
            .collect();
        let factor = [1.0, 0.25, 1.0 / 3.0, 3.0, 1e7][round / 5 % 5];
        let noise = [0.0, 1e-16, 1e-15, 4e-15][round / 25 % 4];
        let size: f64 = expected.iter().map(|r| r.value.abs()).sum();
        let kept = expected.iter().skip_while(|r| r.value.abs() < MIN_LEADING_COEFFICIENT);
        let actual: Vec<f64> = kept.map(|r| factor * (r.value + noise * (next() - 0.5) * size)).collect();
        let Some(found) = match_if_clear(&expected, &actual) else { continue };
        if let Some(scale) = found.scale {
            let close = compare_any_kind(&expected, &actual, &[1.0]);
            // Multiplication by a factor near 1 may have moved lost coefficients to four times the library's bound.
            let has_lost = actual.len() < expected.len();
            assert!(has_lost || close.is_ok(), "{expected:?} {actual:?}");
            assert!((scale / factor - 1.0).abs() < 1e-14 && found.tolerance_share <= FAIR_CLEAR_SHARE, "{found:?}");
            answered += 1;
        }
    }
    assert!(answered > 15_000, "{answered}");
    assert_eq!(match_if_clear(&parabola(), &parabola().map(|c| -c.value)), None);
}

fn parabola() -> [BoundedValue; 3] {
    [-0.37, 2.2, -0.71].map(|value: f64| BoundedValue { value, bound: 8.0 * value.abs() })
}

#[test]
fn every_positive_factor_is_right_and_no_other() {
    let right = parabola();
    for factor in [1.0, 3.0, 1e-6, 1e9, 0.1] {
        let logged = right.map(|c| factor * c.value);
        let found = compare(&right, &logged, &[1.0]).expect("right");
        assert!((found.scale.expect("a factor") / factor - 1.0).abs() < 1e-15);
    }
    for factor in [-1.0, 0.0, f64::NAN, f64::INFINITY] {
        assert!(compare(&right, &right.map(|c| factor * c.value), &[1.0]).is_err(), "{factor}");
    }
}

#[test]
fn the_wrong_coefficient_is_named_in_spite_of_a_factor() {
    let right = parabola();
    let mut logged = right.map(|c| 3.0 * c.value);
    logged[1] *= 2.0;
    let Err(Mismatch::Coefficient { power, expected, actual, .. }) = compare(&right, &logged, &[1.0]) else {
        panic!("a wrong coefficient")
    };
    assert_eq!((power, actual), (1, logged[1]));
    assert!((expected - 6.6).abs() < 1e-12);
}

/// Polynomials that the quick comparison rejects for every factor are also wrong in the complete one, whatever the
/// hints. The quick comparison rejects more than half of the wrong ones.
#[test]
fn polynomials_without_a_fitting_factor_are_wrong() {
    let mut next = numbers();
    let (mut wrong, mut certain) = (0, 0);
    for round in 0..40_000 {
        let length = 2 + round % 5;
        let mut expected: Vec<BoundedValue> = (0..length)
            .map(|_| {
                let value = (next() - 0.5) * [1.0, 1e-9, 1e3, 0.0][(next() * 4.0) as usize];
                BoundedValue { value, bound: value.abs() * 40.0 * next() + [0.0, 1.0][round / 5 % 2] }
            })
            .collect();
        let factor = [1.0, 0.25, 1.0 / 3.0, 1e-7, -1.0][round / 10 % 5];
        let noise = [0.0, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-6][round / 50 % 7];
        let mut logged: Vec<f64> = expected.iter().map(|r| factor * r.value * (1.0 + noise * next())).collect();
        if round % 3 == 0 {
            logged[(next() * length as f64) as usize] += noise * factor.abs() * next();
        }
        if round % 4 == 0 {
            // The course's library drops small leading coefficients.
            let dropped = 1.2e-12 * (next() - 0.5);
            expected[0].value = dropped / factor.abs();
            logged.remove(0);
        }
        let is_wrong = compare(&expected, &logged, &[factor.abs(), 1.0]).is_err();
        let is_certain = is_wrong_with_every_factor(&expected, &logged);
        assert!(is_wrong || !is_certain, "{expected:?} {logged:?}");
        wrong += u32::from(is_wrong);
        certain += u32::from(is_certain);
    }
    assert!(certain > wrong / 2 && certain > 2000, "{certain} of {wrong}");
}

#[test]
fn one_part_in_a_billion_is_wrong_and_a_few_roundings_are_not() {
    let right = parabola();
    let mut logged = right.map(|c| c.value);
    logged[2] *= 1.0 + 1e-9;
    assert!(compare(&right, &logged, &[1.0]).is_err());
    logged[2] = right[2].value * (1.0 + 1e-15);
    assert!(compare(&right, &logged, &[1.0]).expect("round-off").tolerance_share > 0.0);
}

/// Small leading coefficients are dropped after scaling. Others may not be missing.
#[test]
fn only_small_leading_coefficients_may_be_missing() {
    let right = [1e-7, 2.2, -0.71].map(|value: f64| BoundedValue { value, bound: 8.0 * value.abs() });
    assert!(compare(&right, &[2.2e-6, -0.71e-6], &[1.0]).is_ok(), "dropped at scale 1e-6: 1e-13");
    assert!(compare(&right, &[2.2, -0.71], &[1.0]).is_err(), "not small at scale 1");
}

/// A program that divides polynomials by their size turns round-off into ordinary numbers.
#[test]
fn a_polynomial_of_round_off_may_have_any_value() {
    let right = [1e-16, 0.0].map(|value: f64| BoundedValue { value, bound: 1.0 });
    for logged in [&[] as &[f64], &[1e-11], &[-1.0, 0.3], &[1e100]] {
        assert_eq!(compare(&right, logged, &[1.0]), Ok(Match { scale: None, tolerance_share: 0.0 }), "{logged:?}");
    }
    assert!(compare(&right, &[f64::NAN], &[1.0]).is_err());
    assert!(compare(&right, &[f64::INFINITY, 1.0], &[1.0]).is_err());
}

/// If nothing moves, there is no round-off either.
#[test]
fn exact_zeros_must_be_zero() {
    let right = [BoundedValue::from_exact(0.0); 2];
    assert!(compare(&right, &[], &[1.0]).is_ok() && compare(&right, &[0.0, -0.0], &[1.0]).is_ok());
    assert!(compare(&right, &[1e-11], &[1.0]).is_err());
}

/// If the trace's own states contain NaN, its polynomials contain NaN as well, and that is not a second error.
#[test]
fn no_number_stands_where_none_is_expected() {
    let (lost, kept) = (BoundedValue { value: f64::NAN, bound: f64::NAN }, BoundedValue::from_rounded(0.3));
    assert!(compare(&[lost, kept], &[f64::NAN, 0.3], &[1.0]).is_ok());
    assert!(compare(&[lost, kept], &[f64::INFINITY, 0.3], &[1.0]).is_ok());
    for logged in [&[1.0, 0.3], &[f64::NAN, f64::NAN]] {
        assert!(compare(&[lost, kept], logged, &[1.0]).is_err(), "{logged:?}");
    }
}

/// Newton's divided differences of values at 0, 1/4, 1/2, 3/4 and 1 have coefficients with up to some hundred times the
/// round-off of all values. Within the step, these errors cancel.
#[test]
fn round_off_that_cancels_within_the_step_is_right() {
    let right = [1e-3, -2e-3, 0.4, -1.1, 0.7].map(|value: f64| BoundedValue { value, bound: 4.0 * value.abs() });
    // The quartic t (t - 1/4) (t - 3/4) (t - 1) is small in the whole step.
    let small = [1.0, -2.0, 1.1875, -0.1875, 0.0];
    let turned = |size: f64| -> Vec<f64> {
        right.iter().zip(small).map(|(right, small)| right.value + size * UNIT_ROUNDOFF * small).collect()
    };
    assert!(compare(&right, &turned(8e3), &[1.0]).is_ok());
    assert!(compare(&right, &turned(8e5), &[1.0]).is_err());
}

#[test]
fn garbage_of_constant_size_check() {
    assert!(compare(&parabola(), &[1e-11; 3], &[1.0]).is_err());
    assert!(compare(&parabola(), &[0.0; 3], &[1.0]).is_err());
    assert!(compare(&parabola(), &[], &[1.0]).is_err());
    assert!(compare(&parabola(), &[1.0; 9], &[1.0]).is_err());
}

/// Sums that may overflow or underflow are not accepted by the quick comparison, even if they fit.
#[test]
fn extreme_sums_get_the_complete_comparison() {
    let is_clear = |own: f64, logged: f64| Similarity::measure(&[own, -own], &[logged, -logged]).is_clear(true);
    for moderate in [1e-99, 1.0, 1e99] {
        assert!(is_clear(moderate, 1.0) && is_clear(1.0, moderate), "{moderate}");
    }
    for extreme in [0.0, 5e-324, 1e-101, 1e100, f64::MAX, f64::INFINITY, f64::NAN] {
        assert!(!is_clear(extreme, 1.0) && !is_clear(1.0, extreme), "{extreme}");
    }
}
