//! [`compare`](super::super::compare::compare) in lanes, where logged polynomials are right with the factor that fits
//! best, or where nothing is to be right: the same operations in the same order.
use crate::fair::compare::{LEAST, MOST};
use fosssim_num::{
    bounded::{Bounded, UNIT_ROUNDOFF},
    lanes::{Lanes, Mask, Simd},
    tolerances::{FAIR_CLEAR, FAIR_LOSS, FAIR_NORM_UNITS, FAIR_UNITS, LEADING_COEFFICIENT},
};

/// A coefficient within this many units of its bound may be round-off.
const UNIT: f64 = FAIR_UNITS * UNIT_ROUNDOFF;

/// What the comparison says.
pub(super) struct Fit<S: Simd> {
    /// Where it is right.
    pub is_right: Mask<S>,
    /// The factor; NaN where the polynomial tells none.
    pub scale: Lanes<S>,
    /// The largest used share of the tolerance; 0 where it is not above the share that was asked about.
    pub share: Lanes<S>,
}

/// Compares with logged coefficients of which the first `missing` were dropped, and are 0 here; all are finite. `own`
/// are the expected values, 0 where the reference drops them, and their number. Shares up to `known` do not matter.
#[inline(always)]
pub(super) fn fits<S: Simd, const LENGTH: usize>(
    expected: &[Bounded<Lanes<S>>; LENGTH],
    own: &([Lanes<S>; LENGTH], Lanes<S>),
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
    for (r, s) in expected.iter().zip(actual) {
        is_any_significant = is_any_significant | (UNIT * r.bound).lt(r.value.abs());
        is_any_logged = is_any_logged | !s.is_zero();
    }
    let says_nothing = !((UNIT * norm).lt(sum) & is_any_significant);
    let is_moderate = norm.at_least(LEAST) & norm.below(MOST);
    let is_quiet = says_nothing & (is_moderate | (norm.is_zero() & !is_any_logged));
    let at_once = at_once(own, actual, missing);
    let is_clear = at_once.is_clear & is_moderate & !says_nothing;
    // What neither has kept is right, whatever else it says.
    let is_quiet = is_quiet | at_once.is_empty;
    let may_be_more = is_clear & ((1.0 - 1e-12) * (known * at_once.tolerance)).lt(at_once.worst);
    let clear_share =
        if may_be_more.any() { may_be_more.choose(at_once.worst / at_once.tolerance, zero) } else { zero };
    if (is_clear | is_quiet).all() {
        let scale = (is_clear & !at_once.is_empty).choose(at_once.scale, zero.like(f64::NAN));
        return Fit { is_right: is_clear | is_quiet, scale, share: clear_share };
    }
    let (mut products, mut squares, mut shown) = (zero, zero, zero);
    let mut units = [zero; LENGTH];
    for (number, (r, s)) in expected.iter().zip(actual).enumerate() {
        units[number] = (2.0 * FAIR_UNITS * r.bound).max(FAIR_NORM_UNITS * norm);
        let is_significant = (UNIT * r.bound).lt(r.value.abs());
        let counts = is_significant & missing.le(zero.like(number as f64));
        let weight = r.value / units[number];
        products = products + counts.choose(weight * (*s / r.value) * weight, zero);
        squares = squares + counts.choose(weight * weight, zero);
        shown = shown + counts.as_numbers();
    }
    let scale = products / squares;
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
    // A single coefficient claims a factor, for which others have to vouch where more is gone than the reference drops.
    let is_shown = missing.le(own.1) | zero.like(2.0).le(shown);
    let fits = fits & is_shown & !is_quiet;
    let share = is_clear.choose(clear_share, fits.choose(share, zero));
    let scale = is_clear.choose(at_once.scale, fits.choose(scale, zero.like(f64::NAN)));
    Fit { is_right: is_clear | fits | is_quiet, scale, share }
}

/// [`Likeness`](crate::fair::compare::Likeness) in lanes.
struct AtOnce<S: Simd> {
    scale: Lanes<S>,
    worst: Lanes<S>,
    tolerance: Lanes<S>,
    /// Right at once, if the polynomial says anything.
    is_clear: Mask<S>,
    /// Neither has kept a coefficient.
    is_empty: Mask<S>,
}

#[inline(always)]
fn at_once<S: Simd, const LENGTH: usize>(
    (own, dropped): &([Lanes<S>; LENGTH], Lanes<S>),
    actual: &[Lanes<S>; LENGTH],
    missing: Lanes<S>,
) -> AtOnce<S> {
    let zero = missing.like(0.0);
    let (mut sum, mut logged) = (zero, zero);
    for (own, theirs) in own.iter().zip(actual) {
        sum = sum + own.abs();
        logged = logged + theirs.abs();
    }
    let scale = logged / sum;
    let mut worst = zero;
    for (own, theirs) in own.iter().zip(actual) {
        worst = worst.max((*theirs - scale * *own).abs());
    }
    let tolerance = FAIR_NORM_UNITS * UNIT_ROUNDOFF * logged;
    let has_kept = dropped.equals(missing);
    let is_moderate = sum.at_least(LEAST) & sum.below(MOST) & logged.at_least(LEAST) & logged.below(MOST);
    let is_near = missing.is_zero() | scale.le(zero.like(FAIR_LOSS));
    let is_clear = has_kept & is_moderate & is_near & worst.le(FAIR_CLEAR * tolerance);
    AtOnce { scale, worst, tolerance, is_clear, is_empty: has_kept & missing.equals(zero.like(LENGTH as f64)) }
}
