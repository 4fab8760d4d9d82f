//! Properties of the root finder and of first times that hold for any input.
use fosssim_oracle::num::{
    first_time::{first_time, positive_set},
    polynomial::Polynomial,
    rpoly::{MAX_DEGREE, zeros},
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Multiplies by `z^2 + u z + v`.
fn times_quadratic(coefficients: &mut Vec<f64>, u: f64, v: f64) {
    coefficients.extend([0.0, 0.0]);
    for i in (1..coefficients.len()).rev() {
        coefficients[i] += u * coefficients[i - 1] + if i > 1 { v * coefficients[i - 2] } else { 0.0 };
    }
}

/// Returns zeros in different cells of a grid, so that none is ill-conditioned: real ones in even cells, pairs in odd
/// ones.
fn separated_zeros() -> impl Strategy<Value = Vec<(f64, f64)>> {
    let cells = prop::sample::subsequence((-4..=4).collect::<Vec<i32>>(), 1..=6);
    (cells, prop::collection::vec((-0.3..0.3_f64, 0.5..2.0_f64, any::<bool>()), 6)).prop_map(|(cells, details)| {
        let mut zeros = Vec::new();
        for (cell, (shift, height, real)) in cells.into_iter().zip(details) {
            let re = f64::from(cell) + shift;
            if real && zeros.len() < MAX_DEGREE {
                zeros.push((re, 0.0));
            } else if zeros.len() + 2 <= MAX_DEGREE {
                zeros.extend([(re, height), (re, -height)]);
            }
        }
        zeros
    })
}

/// Returns coefficients of moderate size, including zeros and integers.
fn coefficients() -> impl Strategy<Value = Vec<f64>> {
    let number = prop_oneof![
        1 => Just(0.0),
        3 => (-9..=9_i32).prop_map(f64::from),
        6 => -10.0..10.0_f64,
        1 => -1e-6..1e-6_f64,
    ];
    prop::collection::vec(number, 0..=6)
}

fn time(lists: &[&Vec<f64>]) -> f64 {
    let polynomials: Vec<Polynomial> = lists.iter().map(|list| Polynomial::trimmed(list)).collect();
    first_time(&polynomials).expect("moderate coefficients end")
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 4_000,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn separated_zeros_are_found(expected in separated_zeros(), leading in prop_oneof![-5.0..-0.1, 0.1..5.0]) {
        let mut product = vec![leading];
        let mut reals = expected.iter().filter(|zero| zero.1 == 0.0).map(|zero| zero.0);
        for &(re, im) in expected.iter().filter(|zero| zero.1 > 0.0) {
            times_quadratic(&mut product, -2.0 * re, re * re + im * im);
        }
        while let Some(first) = reals.next() {
            if let Some(second) = reals.next() {
                times_quadratic(&mut product, -(first + second), first * second);
            } else {
                product.push(0.0);
                for i in (1..product.len()).rev() {
                    product[i] -= first * product[i - 1];
                }
            }
        }
        let found = zeros(&product).expect("moderate coefficients end");
        prop_assert_eq!(usize::try_from(found.count()), Ok(expected.len()), "{:?}", found);
        for (re, im) in expected {
            let nearest = found.as_slice().iter().map(|z| (z.0 - re).hypot(z.1 - im)).fold(f64::INFINITY, f64::min);
            prop_assert!(nearest < 1e-5, "{re} {im} is {nearest:e} from the nearest of {found:?}");
        }
    }

    #[test]
    fn complex_zeros_come_in_pairs_and_give_the_sum_of_zeros(mut list in coefficients()) {
        // The list is at least a line.
        list.splice(0..0, [1.0, -2.0].into_iter().take(2_usize.saturating_sub(list.len())));
        let found = zeros(&list).expect("moderate coefficients end");
        let sum: f64 = found.as_slice().iter().map(|zero| zero.1).sum();
        prop_assert_eq!(sum, 0.0);
        if usize::try_from(found.count()) == Ok(list.len() - 1) {
            let sum: f64 = found.as_slice().iter().map(|zero| zero.0).sum();
            let size: f64 = found.as_slice().iter().map(|zero| zero.0.abs()).sum();
            prop_assert!((sum + list[1] / list[0]).abs() <= 1e-6 * (size + 1.0), "{list:?} {found:?}");
        }
    }

    #[test]
    fn a_first_time_is_a_time(a in coefficients(), b in coefficients()) {
        let time = time(&[&a, &b]);
        prop_assert!(time >= 0.0 && time.is_sign_positive(), "{time}");
    }

    #[test]
    fn the_order_of_polynomials_does_not_matter(a in coefficients(), b in coefficients(), c in coefficients()) {
        let expected = time(&[&a, &b, &c]).to_bits();
        prop_assert_eq!(time(&[&c, &a, &b]).to_bits(), expected);
        prop_assert_eq!(time(&[&b, &a, &c]).to_bits(), expected);
    }

    #[test]
    fn one_more_polynomial_is_never_earlier(a in coefficients(), b in coefficients(), c in coefficients()) {
        prop_assert!(time(&[&a, &b, &c]) >= time(&[&a, &b]));
        prop_assert!(time(&[&a, &b]) >= time(&[&a]));
    }

    #[test]
    fn a_polynomial_and_its_negative_are_positive_in_different_places(list in coefficients()) {
        let negative: Vec<f64> = list.iter().map(|c| -c).collect();
        let (above, below) = (positive_set(&list).expect("ends"), positive_set(&negative).expect("ends"));
        for interval in above.intersection::<7>(&below).as_slice() {
            // The closed forms round the two differently, by a few units in the last place.
            prop_assert!(interval.hi - interval.lo <= 1e-12 * (1.0 + interval.lo.abs()), "{interval:?}");
        }
    }

    #[test]
    fn positive_sets_are_sorted_and_apart(list in coefficients()) {
        let set = positive_set(&list).expect("ends");
        for interval in set.as_slice() {
            prop_assert!(interval.lo <= interval.hi);
        }
        for pair in set.as_slice().windows(2) {
            prop_assert!(pair[0].hi < pair[1].lo);
        }
    }
}
