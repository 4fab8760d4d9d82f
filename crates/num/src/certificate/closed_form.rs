//! Proves for polynomials of degree at most two that the root finder's positive set in `[0, 1]` is empty.
//!
//! In the comments, u is 2^-53 and every claim is about the *computed* positive set.
use super::{
    super::{
        polynomial::evaluate,
        tolerances::{
            LINE_NEAR_LIMIT, PARABOLA_COMPLEX_FACTOR, PARABOLA_MARGIN, PARABOLA_MAX_PRODUCT, PARABOLA_MIN_PRODUCT,
            PARABOLA_MIN_ZERO_PRODUCT, PARABOLA_NEAR_LIMIT, SEARCH_MAX_COEFFICIENT, SEARCH_MIN_COEFFICIENT,
        },
    },
    Level,
};

/// Returns the level of the proof that a polynomial of degree at most two is not positive within the step, or `None` if
/// there is no proof. Small leading coefficients must have been removed. NaN and infinities never give a wrong `Some`.
#[inline]
pub(super) fn find_exclusion(coefficients: &[f64]) -> Option<Level> {
    let (level, excluded) = match *coefficients {
        [] => (Level::Vanishing, true),
        [c] => (Level::Vanishing, c <= 0.0),
        [a, b] if a == 0.0 || b == 0.0 => (Level::Vanishing, b <= 0.0),
        [a, b] => (Level::Line, is_line_excluded(a, b)),
        [a, b, c] if a == 0.0 || (b == 0.0 && c == 0.0) => (Level::Vanishing, c <= 0.0),
        [a, b, c] => (Level::Parabola, is_parabola_excluded(a, b, c)),
        _ => (Level::Vanishing, false),
    };
    excluded.then_some(level)
}

/// Returns whether the line `a t + b` is provably not positive within the step. Neither number may be zero.
#[inline]
fn is_line_excluded(a: f64, b: f64) -> bool {
    if a < 0.0 {
        // The line is positive before its zero at a positive time. Only rounding could hide this.
        if b > 0.0 {
            return false;
        }
        // The zero z = -b/a is negative. The sample at z + 1 has the value a, with a rounding error of at most 4u|b|,
        // far less than |a|.
        if b >= a * LINE_NEAR_LIMIT {
            return true;
        }
    }
    is_line_excluded_exactly(a, b)
}

/// Returns whether the root finder would find that the line `a t + b` is not positive within the step. It performs the
/// root finder's own operations: one zero, and a sample on each side of it.
fn is_line_excluded_exactly(a: f64, b: f64) -> bool {
    let zero = -b / a;
    let before = evaluate(&[a, b], zero - 1.0) > 0.0;
    let after = evaluate(&[a, b], zero + 1.0) > 0.0;
    let meets = (before && zero > 0.0) || (after && zero <= 1.0);
    !meets && !zero.is_nan()
}

/// Returns whether the parabola `a t² + b t + c` is provably not positive within the step. The number `a` must not be
/// zero, and `b` and `c` must not both be zero.
#[inline]
fn is_parabola_excluded(a: f64, b: f64, c: f64) -> bool {
    c < 0.0 && (has_no_real_zero(a, b, c) || is_negative_on_unit(a, b, c))
}

/// Returns whether the parabola clearly has no real zero. The only sample is then the one at 0, which is c.
///
/// The relative distance of the discriminant from 0 is 2^-20, and its rounding error is a few u. The imaginary part is
/// at least 2^-10 sqrt(c/a), and exceeds the 1e-8 below which a zero counts as real.
#[inline]
fn has_no_real_zero(a: f64, b: f64, c: f64) -> bool {
    let product = 4.0 * a * c;
    // Moderate products exclude overflow and underflow in the closed form. A NaN fails the test.
    a < 0.0
        && b * b < product * PARABOLA_COMPLEX_FACTOR
        && c <= a * PARABOLA_MIN_ZERO_PRODUCT
        && (PARABOLA_MIN_PRODUCT..PARABOLA_MAX_PRODUCT).contains(&product)
        && (SEARCH_MIN_COEFFICIENT..SEARCH_MAX_COEFFICIENT).contains(&-a)
}

/// Returns whether the parabola is below zero on `[0, 1]` with a margin, and its zeros are near.
///
/// The computed zeros are those of a parabola whose coefficients differ by a few u times the sum of the absolute
/// coefficients. This is far less than the margin, so no zero is in `[0, 1]`. Their absolute value is at most r = 2^23,
/// so the rounding error of a value is at most 8 u r^2 |a| = 2^-4 |a|. The samples beyond the outermost zeros have an
/// absolute value of at least |a|. The sample between two zeros on either side of `[0, 1]` has one of at least |a|/4.
#[inline]
fn is_negative_on_unit(a: f64, b: f64, c: f64) -> bool {
    let size = a.abs() + b.abs() + c.abs();
    let below = -PARABOLA_MARGIN * size;
    c < below
        && c + 0.5 * b < below
        && (a + b) + c < below
        && b.abs() <= a.abs() * PARABOLA_NEAR_LIMIT
        && c.abs() <= a.abs() * (PARABOLA_NEAR_LIMIT * PARABOLA_NEAR_LIMIT)
        && (PARABOLA_MIN_PRODUCT..PARABOLA_MAX_PRODUCT).contains(&size)
}
