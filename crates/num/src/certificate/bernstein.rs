//! Decides for polynomials of degree three to five whether the root finder's positive set in `[0, 1]` is certainly
//! empty.
//!
//! On an interval a polynomial lies between its smallest and its largest Bernstein coefficient (for instance Farouki,
//! *The Bernstein polynomial basis: a centennial retrospective*, CAGD 29, 2012). If all of them are negative with a
//! margin, and the zeros are near (a bound after Fujiwara, 1916) and separated, the root finder has always agreed. The
//! header of [`super`] lists what is only measured.
use super::{
    super::tolerances::{BERNSTEIN_MARGIN, BERNSTEIN_NEAR_LIMIT},
    separated_zeros::are_zeros_separated,
};

/// Returns whether a polynomial of degree three to five is provably not positive in `[0, 1]`. NaN gives `false`.
#[inline]
pub(super) fn is_never_positive(coefficients: &[f64]) -> bool {
    match *coefficients {
        // The value at 0 is the cheapest test, and is positive for most polynomials that are positive anywhere.
        [.., last] if last >= 0.0 => false,
        [a, b, c, d] => is_negative_on_unit(&[a, b, c, d], &[1.0, 1.0 / 3.0, 1.0 / 3.0, 1.0]),
        [a, b, c, d, e] => is_negative_on_unit(&[a, b, c, d, e], &[1.0, 0.25, 1.0 / 6.0, 0.25, 1.0]),
        [a, b, c, d, e, f] => is_negative_on_unit(&[a, b, c, d, e, f], &[1.0, 0.2, 0.1, 0.1, 0.2, 1.0]),
        _ => false,
    }
}

/// Returns whether all Bernstein coefficients are negative with a margin, and the zeros are near and separated. The
/// inputs are the coefficients, highest power first, and the reciprocals of the binomial coefficients.
#[inline(always)]
fn is_negative_on_unit<const LENGTH: usize>(coefficients: &[f64; LENGTH], reciprocals: &[f64; LENGTH]) -> bool {
    let mut near_limit = coefficients[0].abs();
    let mut size = near_limit;
    let mut zeros_are_near = true;
    for coefficient in &coefficients[1..] {
        near_limit *= BERNSTEIN_NEAR_LIMIT;
        let modulus = coefficient.abs();
        size += modulus;
        zeros_are_near &= modulus <= near_limit;
    }
    let mut control = [0.0; LENGTH];
    for i in 0..LENGTH {
        control[i] = coefficients[LENGTH - 1 - i] * reciprocals[i];
    }
    // Pascal's triangle is added up, so that entry k becomes the sum of (k over i) times entry i.
    for row in 1..LENGTH {
        for i in (row..LENGTH).rev() {
            control[i] += control[i - 1];
        }
    }
    let below = -BERNSTEIN_MARGIN * size;
    zeros_are_near && control.iter().all(|&value| value < below) && are_zeros_separated(coefficients)
}
