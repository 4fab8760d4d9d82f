//! Compares a logged polynomial with the expected one, up to a positive factor and round-off (numerics.md 2).
use super::formulas::BoundedCoefficients;
use fosssim_num::{
    bounded::{BoundedValue, UNIT_ROUNDOFF},
    polynomial::MAX_COEFFICIENTS,
    tolerances::{FAIR_CLEAR_SHARE, FAIR_LOSS_FACTOR, FAIR_NORM_UNITS, FAIR_UNITS, MIN_LEADING_COEFFICIENT},
};

fosssim_model::drops_leading!();

/// The comparison of a polynomial that is right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Match {
    /// The positive factor of the logged polynomial, or `None` if its coefficients do not show it.
    pub scale: Option<f64>,
    /// The largest share of its tolerance that a coefficient uses, from 0 to 1. For a polynomial that is accepted
    /// without bounds, this is an upper bound of at most a quarter.
    pub tolerance_share: f64,
}

/// The fault of a wrong polynomial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mismatch {
    /// The logged polynomial has more coefficients than allowed.
    TooLong,
    /// A coefficient is wrong.
    Coefficient {
        /// The power of t that the coefficient belongs to.
        power: usize,
        /// The right coefficient, scaled to the logged polynomial.
        expected: f64,
        /// The logged coefficient, or 0 if it is missing.
        actual: f64,
        /// The largest allowed absolute deviation.
        tolerance: f64,
    },
}

/// Compares two polynomials. `expected` is complete; `actual` is the logged list, from which the course's library has
/// dropped small leading coefficients. `hints` are factors of other polynomials of the same kind. They are tried if the
/// polynomial is wrong with the factor that is fitted to its own coefficients.
///
/// If the expected polynomial is zero except for round-off, every finite polynomial is right, because some programs
/// divide polynomials by their size. [`round_off_factor`] returns the factor that such a polynomial needs. If the
/// expected polynomial is exactly zero, the logged one must be zero. If an expected coefficient is not finite because
/// of the trace's own state, the logged coefficient must not be finite either.
#[inline]
pub fn compare(expected: &[BoundedValue], actual: &[f64], hints: &[f64]) -> Result<Match, Mismatch> {
    match match_if_clear(expected, actual).or_else(|| match_if_right(expected, actual)) {
        Some(found) => Ok(found),
        None => compare_any_kind(expected, actual, hints),
    }
}

/// The comparison of two coefficient lists of equal length, without bounds.
///
/// The factor is the ratio of the sums of absolute values. Bounds are at least as large as the values, so a deviation
/// below [`FAIR_NORM_UNITS`] of the sum of the absolute coefficients is right. Nearly all right coefficients deviate
/// much less. They are called right by a wide margin.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Similarity {
    /// The sum of the expected coefficients' absolute values.
    pub sum: f64,
    /// The sum of the logged coefficients' absolute values.
    pub logged_sum: f64,
    /// The factor of the logged coefficients: `logged_sum / sum`.
    pub scale: f64,
    /// The largest deviation of a logged coefficient from `scale` times the expected one.
    pub worst_deviation: f64,
}

/// The smallest sum of absolute coefficients with which the comparison cannot underflow. Below it, and above
/// [`MAX_SAFE_SUM`], bounds are computed.
const MIN_SAFE_SUM: f64 = 1e-100;
pub(super) const MAX_SAFE_SUM: f64 = 1e100;

impl Similarity {
    /// The placeholder for polynomials that are not compared.
    pub const NOT_COMPARED: Self = Self { sum: 0.0, logged_sum: 0.0, scale: 0.0, worst_deviation: 0.0 };

    /// Returns the sums, the factor and the largest deviation of the coefficients `logged` from the expected
    /// coefficients `own`. Both lists have the same length.
    #[inline(always)]
    pub fn measure(own: &[f64], logged: &[f64]) -> Self {
        // The compiler unrolls loops of a known length.
        match own.len() {
            2 => Self::compare_lists::<2>(own, logged),
            3 => Self::compare_lists::<3>(own, logged),
            5 => Self::compare_lists::<5>(own, logged),
            6 => Self::compare_lists::<6>(own, logged),
            _ => Self::from_lists(own, logged),
        }
    }

    #[inline(always)]
    fn compare_lists<const LENGTH: usize>(own: &[f64], logged: &[f64]) -> Self {
        match (own.first_chunk::<LENGTH>(), logged.first_chunk::<LENGTH>()) {
            (Some(own), Some(logged)) => Self::from_lists(own, logged),
            _ => Self::NOT_COMPARED,
        }
    }

    #[inline(always)]
    fn from_lists(own: &[f64], theirs: &[f64]) -> Self {
        let (mut sum, mut logged) = (0.0, 0.0);
        for (own, theirs) in own.iter().zip(theirs) {
            sum += own.abs();
            logged += theirs.abs();
        }
        let scale = logged / sum;
        let both = own.iter().zip(theirs);
        let worst = both.fold(0.0_f64, |worst, (own, theirs)| worst.max((theirs - scale * own).abs()));
        Self { sum, logged_sum: logged, scale, worst_deviation: worst }
    }

    /// Returns the match of two polynomials that agree.
    #[inline(always)]
    pub fn as_match(&self) -> Match {
        Match { scale: Some(self.scale), tolerance_share: self.worst_deviation / self.tolerance() }
    }

    /// Returns the smallest tolerance of a coefficient.
    #[inline(always)]
    fn tolerance(&self) -> f64 {
        FAIR_NORM_UNITS * UNIT_ROUNDOFF * self.logged_sum
    }

    /// Returns whether the coefficients are right by a wide margin. `is_whole` is whether no leading coefficient was
    /// dropped. If one was, the factor must be at most [`FAIR_LOSS_FACTOR`], so that the dropped coefficient is small
    /// in both lists.
    #[inline(always)]
    pub fn is_clear(&self, is_whole: bool) -> bool {
        let is_moderate = |sum: f64| (MIN_SAFE_SUM..MAX_SAFE_SUM).contains(&sum);
        is_moderate(self.sum)
            & is_moderate(self.logged_sum)
            & (is_whole | (self.scale <= FAIR_LOSS_FACTOR))
            & (self.worst_deviation <= FAIR_CLEAR_SHARE * self.tolerance())
    }
}

/// Compares like [`compare`], but without bounds of the coefficients. Returns `None` if the comparison needs them.
fn match_if_clear(expected: &[BoundedValue], actual: &[f64]) -> Option<Match> {
    let dropped_count = expected.iter().take_while(|r| r.value.abs() < MIN_LEADING_COEFFICIENT).count();
    let kept_coefficients = &expected[dropped_count..];
    if kept_coefficients.len() != actual.len() {
        return None;
    }
    if kept_coefficients.is_empty() {
        return Some(Match { scale: None, tolerance_share: 0.0 });
    }
    let mut values = [0.0; MAX_COEFFICIENTS];
    values.iter_mut().zip(kept_coefficients).for_each(|(value, own)| *value = own.value);
    let similarity = Similarity::measure(values.get(..kept_coefficients.len())?, actual);
    let is_right =
        similarity.is_clear(dropped_count == 0) && bound_sum(expected).is_finite() && !is_round_off(expected);
    is_right.then(|| similarity.as_match())
}

/// Returns whether a logged polynomial is provably wrong with every factor, without a search for the best factor.
/// If the result is `false`, the polynomial may be right or wrong.
///
/// A polynomial that [`compare`] accepts stays near the expected one times its factor at any time within the step. It
/// deviates by less than `MAX_DEVIATION` units of all bounds together. Together, the tolerances of six coefficients are
/// at most `2 FAIR_UNITS + 6 FAIR_NORM_UNITS` units of the sum of bounds. If values are compared instead, their
/// tolerances are smaller. Each time therefore allows an interval of factors. If two of these intervals are disjoint,
/// no factor fits.
pub fn is_wrong_with_every_factor(expected: &[BoundedValue], actual: &[f64]) -> bool {
    /// The maximum deviation: all tolerances, and the rounding errors of this computation.
    const MAX_DEVIATION: f64 = 2.0 * FAIR_UNITS + 6.0 * FAIR_NORM_UNITS + 32.0;
    let Some(missing) = expected.len().checked_sub(actual.len()).filter(|_| expected.len() <= MAX_COEFFICIENTS) else {
        return false;
    };
    let size: f64 = expected.iter().map(|r| r.bound.max(r.value.abs())).sum();
    let room = MAX_DEVIATION * UNIT_ROUNDOFF * size;
    let rounding = 32.0 * UNIT_ROUNDOFF * actual.iter().map(|s| s.abs()).sum::<f64>();
    // Leading coefficients below the library's limit may be missing with any factor. If both polynomials lack them,
    // they may be larger by [`FAIR_LOSS_FACTOR`].
    let logged_room = rounding + missing as f64 * FAIR_LOSS_FACTOR * MIN_LEADING_COEFFICIENT;
    if !(room.is_finite() && logged_room.is_finite()) {
        return false;
    }
    let (mut min_factor, mut max_factor) = (0.0_f64, f64::INFINITY);
    for t in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let right = expected.iter().fold(0.0, |sum, r| sum * t + r.value);
        let logged = actual.iter().fold(0.0, |sum, s| sum * t + s);
        let (right, logged) = if right < 0.0 { (-right, -logged) } else { (right, logged) };
        if right > 2.0 * room {
            min_factor = min_factor.max((logged - logged_room) / (right + room));
            max_factor = max_factor.min((logged + logged_room) / (right - room));
        }
    }
    // The rounding errors of the intervals' ends are much smaller than 1e-9.
    min_factor > max_factor + 1e-9 * max_factor.abs()
}

/// Compares like [`compare`], but only polynomials of equal length, and only with the best factor. Returns `None` if
/// the logged polynomial is not right with this factor, or if the expected one is round-off or not finite. Most
/// polynomials are complete and right.
fn match_if_right(expected: &[BoundedValue], actual: &[f64]) -> Option<Match> {
    if expected.len() != actual.len() || expected.len() > MAX_COEFFICIENTS {
        return None;
    }
    let norm = bound_sum(expected);
    // A single coefficient that is NaN or infinite makes the sums NaN or infinite.
    if !(norm > 0.0 && norm.is_finite() && sum_of_moduli(expected).is_finite()) || is_round_off(expected) {
        return None;
    }
    let scale = fit_factor(expected, actual, 0).filter(|scale| *scale > 0.0)?;
    let mut share = 0.0_f64;
    for (r, s) in expected.iter().zip(actual) {
        let tolerance = UNIT_ROUNDOFF * scale * allowed_units(r, norm);
        let residual = (s - scale * r.value).abs();
        if !(residual <= tolerance) {
            return None;
        }
        // The multiplication shows whether the share can be larger, and saves most divisions.
        if residual > (1.0 - 1e-12) * (share * tolerance) {
            share = share.max(residual / tolerance);
        }
    }
    Some(Match { scale: Some(scale), tolerance_share: share })
}

/// Compares like [`compare`], without its shortcuts.
fn compare_any_kind(expected: &[BoundedValue], actual: &[f64], hints: &[f64]) -> Result<Match, Mismatch> {
    let degree = expected.len().max(actual.len()).max(1) - 1;
    if actual.len() > MAX_COEFFICIENTS {
        return Err(Mismatch::TooLong);
    }
    let mut right: BoundedCoefficients = [BoundedValue::default(); MAX_COEFFICIENTS];
    let mut logged = [0.0; MAX_COEFFICIENTS];
    right[MAX_COEFFICIENTS - expected.len()..].copy_from_slice(expected);
    logged[MAX_COEFFICIENTS - actual.len()..].copy_from_slice(actual);
    let length = (degree + 1).min(MAX_COEFFICIENTS);
    let (right, logged) = (&right[MAX_COEFFICIENTS - length..], &logged[MAX_COEFFICIENTS - length..]);
    let missing = length.saturating_sub(actual.len());
    if !right.iter().all(|r| r.value.is_finite() && r.bound.is_finite()) {
        return check_non_finite_positions(|r| r.value.is_finite(), right, logged);
    }
    if bound_sum(right) == 0.0 && logged.iter().any(|s| *s != 0.0) {
        // Nothing moves, so every formula gives exactly zero.
        return judge_with_scale(right, logged, missing, 1.0)
            .map(|share| Match { scale: None, tolerance_share: share });
    }
    if is_round_off(right) {
        return check_non_finite_positions(|_| true, right, logged);
    }
    let matched = |scale: f64| {
        judge_with_scale(right, logged, missing, scale)
            .map(|share| Match { scale: Some(scale), tolerance_share: share })
    };
    let hinted = || {
        let mut matches = hints.iter().map(|&hint| judge_with_scale(right, logged, missing, hint));
        matches.find_map(Result::ok).map(|share| Match { scale: None, tolerance_share: share })
    };
    let Some(fitted) = fit_factor(right, logged, missing) else {
        // No logged coefficient exceeds round-off, so none shows the factor, and 1 is used.
        return judge_with_scale(right, logged, missing, 1.0)
            .map(|share| Match { scale: None, tolerance_share: share });
    };
    let first = matched(fitted);
    if first.is_ok() {
        return first;
    }
    // The logged coefficients may show the factor only inaccurately.
    if let Some(found) = hinted() {
        return Ok(found);
    }
    // A wrong coefficient changes the fitted factor. The factor on which most coefficients agree shows which one is
    // wrong.
    let mut best = (count_wrong(right, logged, missing, fitted), first);
    for (r, s) in right.iter().zip(logged).skip(missing) {
        let scale = s / r.value;
        if scale > 0.0 && scale.is_finite() && is_significant(r) {
            let count = count_wrong(right, logged, missing, scale);
            if count < best.0 {
                best = (count, matched(scale));
            }
        }
    }
    // A factor on which at most one coefficient agrees proves nothing.
    if best.0 + 1 >= length && length > 1 { matched(1.0) } else { best.1 }
}

/// Compares a logged polynomial with the factor 1, and returns the mismatch, if there is one.
pub(super) fn compare_with_one(expected: &[BoundedValue], actual: &[f64]) -> Result<(), Mismatch> {
    let Some(missing) = expected.len().checked_sub(actual.len()) else { return Err(Mismatch::TooLong) };
    let mut logged = [0.0; MAX_COEFFICIENTS];
    logged[missing..expected.len()].copy_from_slice(actual);
    judge_with_scale(expected, &logged[..expected.len()], missing, 1.0).map(|_| ())
}

/// Checks that each logged coefficient is finite exactly if `should` returns true for the expected one. Otherwise
/// returns the first mismatch.
fn check_non_finite_positions(
    should: fn(&BoundedValue) -> bool,
    right: &[BoundedValue],
    logged: &[f64],
) -> Result<Match, Mismatch> {
    let wrong = right.iter().zip(logged).position(|(r, s)| should(r) != s.is_finite());
    let Some(k) = wrong else { return Ok(Match { scale: None, tolerance_share: 0.0 }) };
    let (expected, actual) = (right[k].value, logged[k]);
    Err(Mismatch::Coefficient { power: right.len() - 1 - k, expected, actual, tolerance: f64::NAN })
}

/// Returns whether a polynomial is zero on the whole step except for round-off.
pub fn is_round_off(expected: &[BoundedValue]) -> bool {
    sum_of_moduli(expected) <= FAIR_UNITS * UNIT_ROUNDOFF * bound_sum(expected) || !expected.iter().any(is_significant)
}

/// Returns the sum of all values' absolute values.
fn sum_of_moduli(expected: &[BoundedValue]) -> f64 {
    expected.iter().map(|r| r.value.abs()).sum()
}

/// Returns whether a coefficient is larger than round-off.
fn is_significant(r: &BoundedValue) -> bool {
    r.value.abs() > FAIR_UNITS * UNIT_ROUNDOFF * r.bound
}

/// Returns the factor that fits the logged coefficients best, each weighted by its precision. Returns `None` if all of
/// them are round-off. If the factor is not positive or not finite, the polynomial is wrong.
fn fit_factor(right: &[BoundedValue], logged: &[f64], missing: usize) -> Option<f64> {
    let norm = bound_sum(right);
    let (mut products, mut squares) = (0.0, 0.0);
    for (r, s) in right.iter().zip(logged).skip(missing) {
        if is_significant(r) {
            let weight = r.value / allowed_units(r, norm);
            products += weight * (s / r.value) * weight;
            squares += weight * weight;
        }
    }
    (squares > 0.0).then(|| products / squares)
}

/// Returns the allowed deviation of a coefficient, in units of the roundoff. The bound counts twice, because both sides
/// are rounded. A coefficient that is small compared with the others may have the rounding errors of all of them. Some
/// correct programs interpolate polynomials, and the resulting errors change no decision on [0, 1].
fn allowed_units(r: &BoundedValue, norm: f64) -> f64 {
    f64::max(2.0 * FAIR_UNITS * r.bound, FAIR_NORM_UNITS * norm)
}

/// Returns the used share of the tolerance or, as the error, the tolerance that is exceeded. If the factor is not
/// positive, the error is NaN.
fn check_coefficient(r: &BoundedValue, s: f64, norm: f64, is_missing: bool, scale: f64) -> Result<f64, f64> {
    if !(scale > 0.0) {
        return Err(f64::NAN);
    }
    let tolerance = UNIT_ROUNDOFF * scale * allowed_units(r, norm);
    let residual = (s - scale * r.value).abs();
    if residual <= tolerance {
        return Ok(if residual == 0.0 { 0.0 } else { residual / tolerance });
    }
    // The course's library drops small leading coefficients at any scale.
    if is_missing && residual < MIN_LEADING_COEFFICIENT + tolerance {
        return Ok(0.0);
    }
    Err(tolerance)
}

/// Returns the sum of all bounds.
fn bound_sum(right: &[BoundedValue]) -> f64 {
    right.iter().map(|c| c.bound).sum()
}

/// Returns the smallest and the largest factor with which a logged polynomial would be right, although it does not show
/// its own factor. All factors between them are large enough for its coefficients to be round-off, and small enough for
/// the course's library to drop the missing ones. Returns `None` if the polynomial shows its factor, is too long, or
/// has no such factor.
pub fn possible_factors(expected: &[BoundedValue], actual: &[f64]) -> Option<[f64; 2]> {
    let missing = expected.len().checked_sub(actual.len())?;
    let (dropped_coefficients, kept_coefficients) = expected.split_at(missing);
    if kept_coefficients.iter().any(is_significant) {
        return None;
    }
    let needed = kept_coefficients
        .iter()
        .zip(actual)
        .map(|(r, s)| if *s == 0.0 { 0.0 } else { s.abs() / (DOUBLE_TOLERANCE * r.bound) });
    let min_factor = needed.fold(0.0, |maximum: f64, factor| if factor <= maximum { maximum } else { factor });
    let limit = max_factor(dropped_coefficients);
    (min_factor.is_finite() && min_factor <= limit).then_some([min_factor, limit])
}

/// The tolerance of a coefficient that is much larger than all others, in units of its bound. Both sides are rounded,
/// so it is twice [`FAIR_UNITS`].
const DOUBLE_TOLERANCE: f64 = 2.0 * FAIR_UNITS * UNIT_ROUNDOFF;

/// Returns the largest factor with which the course's library drops all of `dropped`, or infinity if it drops them with
/// any factor.
fn max_factor(dropped: &[BoundedValue]) -> f64 {
    MIN_LEADING_COEFFICIENT
        / dropped.iter().fold(0.0_f64, |maximum, r| maximum.max(r.value.abs() - DOUBLE_TOLERANCE * r.bound))
}

/// Returns whether at least two coefficients of a right polynomial agree on its factor, so that no other polynomial has
/// to confirm it.
pub fn shows_factor(expected: &[BoundedValue], actual: &[f64]) -> bool {
    let missing = expected.len().saturating_sub(actual.len());
    expected[missing..].iter().filter(|r| is_significant(r)).count() > 1
}

/// Returns the smallest and the largest factor that a right polynomial claims, but does not show. Such a polynomial has
/// only one coefficient above round-off, and lacks others that the course's library would keep with the factor 1.
/// Returns `None` for all other polynomials.
pub fn claimed_factors(expected: &[BoundedValue], actual: &[f64], scale: f64) -> Option<[f64; 2]> {
    let missing = expected.len().checked_sub(actual.len())?;
    let (dropped, held) = expected.split_at(missing);
    if max_factor(dropped) >= 1.0 || shows_factor(expected, actual) {
        return None;
    }
    let significant = held.iter().find(|r| is_significant(r))?;
    let room = UNIT_ROUNDOFF * allowed_units(significant, bound_sum(expected)) / significant.value.abs();
    Some([scale * (1.0 - room), scale * (1.0 + room)])
}

/// Returns the smallest factor above 1 with which a polynomial would be right, if the expected polynomial is zero
/// except for round-off. Returns `None` if the polynomial needs no factor, or if the expected polynomial is larger than
/// round-off. The result is also `None` if the largest absolute coefficient or the sum of squares is 1. Some programs
/// scale their polynomials to this size.
pub fn round_off_factor(expected: &[BoundedValue], actual: &[f64]) -> Option<f64> {
    let norm = bound_sum(expected);
    if !(norm > 0.0 && norm.is_finite() && is_round_off(expected)) {
        return None;
    }
    // The divisor is the largest size that counts as round-off of the expected polynomial, plus the rounding errors of
    // both sides.
    let min_factor = actual.iter().map(|s| s.abs()).sum::<f64>() / (DOUBLE_TOLERANCE * norm);
    let largest = actual.iter().fold(0.0_f64, |maximum, s| maximum.max(s.abs()));
    let squares = actual.iter().map(|s| s * s).sum::<f64>();
    let is_one = |size: f64| (size - 1.0).abs() < 1e-9;
    (min_factor > 1.0 && !is_one(largest) && !is_one(squares)).then_some(min_factor)
}

/// Returns the number of coefficients that are wrong if the factor is `scale`.
fn count_wrong(right: &[BoundedValue], logged: &[f64], missing: usize, scale: f64) -> usize {
    let norm = bound_sum(right);
    let all = right.iter().zip(logged).enumerate();
    all.filter(|&(k, (r, &s))| check_coefficient(r, s, norm, k < missing, scale).is_err()).count()
}

/// Returns the largest used share of the tolerance if the factor is `scale`, or the first wrong coefficient.
fn judge_with_scale(right: &[BoundedValue], logged: &[f64], missing: usize, scale: f64) -> Result<f64, Mismatch> {
    let norm = bound_sum(right);
    let mut share = 0.0_f64;
    for (k, (r, &s)) in right.iter().zip(logged).enumerate() {
        match check_coefficient(r, s, norm, k < missing, scale) {
            Ok(used) => share = share.max(used),
            Err(tolerance) => {
                if let Some(share) = share_within_step(right, logged, missing, scale) {
                    return Ok(share);
                }
                let power = right.len() - 1 - k;
                return Err(Mismatch::Coefficient { power, expected: scale * r.value, actual: s, tolerance });
            }
        }
    }
    Ok(share)
}

/// Returns the largest used share of the tolerance of the polynomial's *values* within the step, if they are all right.
/// A program that interpolates from values within the step has large errors in the higher coefficients, where these
/// values cancel.
fn share_within_step(right: &[BoundedValue], logged: &[f64], missing: usize, scale: f64) -> Option<f64> {
    /// The number of equal intervals between sample times. A polynomial of degree five is hardly larger between them.
    const SAMPLE_INTERVALS: u8 = 16;
    let norm = bound_sum(right);
    if !(scale > 0.0) {
        return None;
    }
    let tolerance = UNIT_ROUNDOFF * scale * FAIR_UNITS * norm;
    let mut share = 0.0_f64;
    for time in 0..=SAMPLE_INTERVALS {
        let t = f64::from(time) / f64::from(SAMPLE_INTERVALS);
        let residual = right.iter().zip(logged).enumerate().fold(0.0, |sum, (k, (r, &s))| {
            let is_dropped = k < missing && check_coefficient(r, s, norm, true, scale).is_ok();
            sum * t + if is_dropped { 0.0 } else { s - scale * r.value }
        });
        if !(residual.abs() <= tolerance) {
            return None;
        }
        share = share.max(if residual == 0.0 { 0.0 } else { residual.abs() / tolerance });
    }
    Some(share)
}

#[cfg(test)]
mod tests;
