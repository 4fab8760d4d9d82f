//! [`compare`](super::super::compare::compare) in lanes, where logged polynomials are right with the factor that fits best, or
//! where nothing is to be right: the same operations in the same order.
use fosssim_num::{
    bounded::{Bounded, UNIT_ROUNDOFF},
    lanes::{Lanes, Mask, Simd},
    tolerances::{FAIR_NORM_UNITS, FAIR_UNITS, LEADING_COEFFICIENT},
};

/// A coefficient within this many units of its bound may be round-off.
const UNIT: f64 = FAIR_UNITS * UNIT_ROUNDOFF;

/// Bounds and factors between these neither overflow nor underflow on the way; beyond, a close look is taken.
const LEAST: f64 = 1e-100;
const MOST: f64 = 1e100;

/// What the comparison says.
pub(super) struct Fit<S: Simd> {
    /// Where it is right.
    pub is_right: Mask<S>,
    /// The factor; NaN where the polynomial tells none.
    pub scale: Lanes<S>,
    /// The largest used share of the tolerance; 0 where it is not above the share that was asked about.
    pub share: Lanes<S>,
}

/// Compares with logged coefficients of which the first `missing` were dropped, and are 0 here; all are finite. Shares up to
/// `known` do not matter.
#[inline(always)]
pub(super) fn fits<S: Simd, const LENGTH: usize>(
    expected: &[Bounded<Lanes<S>>; LENGTH],
    actual: &[Lanes<S>; LENGTH],
    missing: Lanes<S>,
    known: Lanes<S>,
) -> Fit<S> {
    let (zero, none) = (known.like(0.0), known.lt(known));
    let (mut norm, mut sum) = (expected[0].bound, expected[0].value.abs());
    for r in &expected[1..] {
        norm = norm + r.bound;
        sum = sum + r.value.abs();
    }
    let (mut is_any_significant, mut is_any_logged) = (none, none);
    let (mut products, mut squares) = (zero, zero);
    let mut units = [zero; LENGTH];
    for (number, (r, s)) in expected.iter().zip(actual).enumerate() {
        units[number] = (2.0 * FAIR_UNITS * r.bound).max(FAIR_NORM_UNITS * norm);
        let is_significant = (UNIT * r.bound).lt(r.value.abs());
        is_any_significant = is_any_significant | is_significant;
        is_any_logged = is_any_logged | !s.is_zero();
        let counts = is_significant & missing.le(zero.like(number as f64));
        let weight = r.value / units[number];
        products = products + counts.choose(weight * (*s / r.value) * weight, zero);
        squares = squares + counts.choose(weight * weight, zero);
    }
    let scale = products / squares;
    let says_nothing = !((UNIT * norm).lt(sum) & is_any_significant);
    let is_moderate = norm.at_least(LEAST) & norm.below(MOST);
    let is_quiet = says_nothing & (is_moderate | (norm.is_zero() & !is_any_logged));
    let mut fits = is_moderate & !says_nothing & zero.lt(squares) & scale.at_least(LEAST) & scale.below(MOST);
    let (mut residuals, mut tolerances) = ([zero; LENGTH], [zero; LENGTH]);
    let mut may_be_more = none;
    for (number, (r, s)) in expected.iter().zip(actual).enumerate() {
        let tolerance = UNIT_ROUNDOFF * scale * units[number];
        let residual = (*s - scale * r.value).abs();
        let was_dropped =
            zero.like(number as f64).lt(missing) & residual.lt(tolerance + zero.like(LEADING_COEFFICIENT));
        fits = fits & (residual.le(tolerance) | was_dropped);
        may_be_more = may_be_more | ((1.0 - 1e-12) * (known * tolerance)).lt(residual);
        (residuals[number], tolerances[number]) = (residual, tolerance);
    }
    let mut share = zero;
    if (fits & may_be_more).any() {
        for (residual, tolerance) in residuals.iter().zip(&tolerances) {
            let used = *residual / *tolerance;
            share = (share.lt(used) & residual.le(*tolerance)).choose(used, share);
        }
    }
    let share = fits.choose(share, zero);
    Fit { is_right: fits | is_quiet, scale: fits.choose(scale, zero.like(f64::NAN)), share }
}
