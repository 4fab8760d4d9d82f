//! Constants, lines and parabolas: when the root finder certainly finds them nowhere positive in `[0, 1]`.
//!
//! Below, u is 2^-53 and every claim is about the *computed* positive set.
use super::{
    super::{
        polynomial::evaluate,
        tolerances::{
            LINE_NEAR, PARABOLA_COMPLEX, PARABOLA_LARGEST, PARABOLA_MARGIN, PARABOLA_NEAR, PARABOLA_ROOM,
            PARABOLA_SMALLEST, SEARCH_LARGEST_COEFFICIENT, SEARCH_SMALLEST_COEFFICIENT,
        },
    },
    Level,
};

/// Returns whether a polynomial of degree at most two (as it is solved, small leading coefficients dropped) is
/// certainly not positive within the step. NaN and infinities never give a wrong `Some`.
#[inline]
pub(super) fn never_positive(coefficients: &[f64]) -> Option<Level> {
    let (level, excluded) = match *coefficients {
        [] => (Level::Vanishing, true),
        [c] => (Level::Vanishing, c <= 0.0),
        [a, b] if a == 0.0 || b == 0.0 => (Level::Vanishing, b <= 0.0),
        [a, b] => (Level::Line, line(a, b)),
        [a, b, c] if a == 0.0 || (b == 0.0 && c == 0.0) => (Level::Vanishing, c <= 0.0),
        [a, b, c] => (Level::Parabola, parabola(a, b, c)),
        _ => (Level::Vanishing, false),
    };
    excluded.then_some(level)
}

/// Returns whether the line `a t + b` is excluded, neither zero.
#[inline]
fn line(a: f64, b: f64) -> bool {
    if a < 0.0 {
        // Positive before its zero at a positive time; only rounding could hide it.
        if b > 0.0 {
            return false;
        }
        // The zero z = -b/a is negative; the sample at z + 1 has the value a, rounded with an error of at most
        // 4u|b|, far less than |a|.
        if b >= a * LINE_NEAR {
            return true;
        }
    }
    exact_line(a, b)
}

/// Runs the root finder's own operations: one zero and the samples on its two sides.
fn exact_line(a: f64, b: f64) -> bool {
    let zero = -b / a;
    let before = evaluate(&[a, b], zero - 1.0) > 0.0;
    let after = evaluate(&[a, b], zero + 1.0) > 0.0;
    let meets = (before && zero > 0.0) || (after && zero <= 1.0);
    !meets && !zero.is_nan()
}

/// Returns whether the parabola `a t^2 + b t + c` is excluded, `a` not zero and not both others.
#[inline]
fn parabola(a: f64, b: f64, c: f64) -> bool {
    c < 0.0 && (misses(a, b, c) || negative(a, b, c))
}

/// Returns whether it has no real zero, clearly: then the only sample is the one at 0, which is c.
///
/// The discriminant's relative distance from 0 is 2^-20, its rounding a few u. The imaginary part is at least
/// 2^-10 sqrt(c/a), hence above the 1e-8 below which a zero counts as real.
#[inline]
fn misses(a: f64, b: f64, c: f64) -> bool {
    let product = 4.0 * a * c;
    // Moderate products exclude overflow and underflow in the closed form; NaN fails.
    a < 0.0
        && b * b < product * PARABOLA_COMPLEX
        && c <= a * PARABOLA_ROOM
        && (PARABOLA_SMALLEST..PARABOLA_LARGEST).contains(&product)
        && (SEARCH_SMALLEST_COEFFICIENT..SEARCH_LARGEST_COEFFICIENT).contains(&-a)
}

/// Returns whether it is below zero on `[0, 1]` with margin, and its zeros are near.
///
/// The computed zeros are those of a parabola whose coefficients differ by a few u times the sum of the moduli, far
/// less than the margin, so none is in `[0, 1]`. They are of modulus at most r = 2^23, so a value is rounded by at most
/// 8 u r^2 |a| = 2^-4 |a|, while the samples beyond the outermost zeros have a modulus of at least |a|, and the one
/// between two zeros on either side of `[0, 1]` at least |a|/4.
#[inline]
fn negative(a: f64, b: f64, c: f64) -> bool {
    let size = a.abs() + b.abs() + c.abs();
    let below = -PARABOLA_MARGIN * size;
    c < below
        && c + 0.5 * b < below
        && (a + b) + c < below
        && b.abs() <= a.abs() * PARABOLA_NEAR
        && c.abs() <= a.abs() * (PARABOLA_NEAR * PARABOLA_NEAR)
        && (PARABOLA_SMALLEST..PARABOLA_LARGEST).contains(&size)
}
