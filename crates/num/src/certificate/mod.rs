//! Proofs that no root search is needed, because there is provably no impact within the step.
//!
//! A detection asks whether [`first_time`](super::first_time::first_time) is at most 1. Usually it is not, and a few
//! multiplications prove that. A search may be skipped only if its result is known, so the positive sets *as found* by
//! the original's root finder matter, not the actual ones. The root finder samples each gap between the zeros once, and
//! rounding may decide a sample.
//!
//! One condition is enough. The result exceeds 1 if the computed positive set of *one* polynomial has no interval with
//! `hi > 0` and `lo <= 1`, and if no search hangs. Combining several polynomials would hardly decide more calls in
//! scenes.
//!
//! Proofs and measurements:
//!
//! * **Constants, `c z^m`, lines: exact.** The root finder's own few operations, or a bound on their rounding.
//! * **Parabolas: proved.** The closed form's zeros are those of a polynomial whose coefficients differ by a few
//!   units in the last place of the largest. This is far less than the margin. The samples' values exceed their
//!   rounding errors because the zeros are near (see `closed_form`).
//! * **Degree three and above: measured.** The search is iterative, and the effect of deflation on zeros is not
//!   bounded here. The polynomial must be negative with a margin, and its zeros must not be far away. No zeros may
//!   coincide, even nearly. This makes all zeros well-conditioned and keeps samples off double zeros. Without this
//!   condition, grids of integers have shown one disagreement in several hundred thousand. `crates/lab/src/bin/audit`
//!   compares certificate and search, for lists and for each polynomial alone. There is no disagreement.
//! * **Termination: measured** for degree three and above, within the range of coefficients that is admitted.

mod bernstein;
mod closed_form;
pub mod lanes;
mod separated_zeros;

use super::{
    polynomial::Polynomial,
    tolerances::{SEARCH_MAX_COEFFICIENT, SEARCH_MIN_COEFFICIENT},
};

crate::closed_set! {
    /// The level of the certificate that has decided. The cheapest level is first.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Level {
        /// A polynomial that is nowhere positive by its form: empty, a constant, or `c z^m`.
        Vanishing,
        /// A line that is not positive within the step.
        Line,
        /// A parabola that is not positive within the step.
        Parabola,
        /// A polynomial of degree three or more whose Bernstein coefficients are all negative.
        Bernstein,
    }
}

/// Returns whether [`first_time`](super::first_time::first_time) of these polynomials is provably greater than 1 or
/// infinite, and its search provably ends. A margin covers the root finder's own errors. `false` means "unknown".
///
/// Coefficients that are not finite usually give `false`. The exception is that a polynomial of degree at most two
/// decides, and every polynomial with such coefficients has degree at most two. The search returns normally for these
/// degrees.
#[inline]
pub fn excludes_unit_interval(polynomials: &[Polynomial]) -> bool {
    find_exclusion(polynomials).is_some()
}

/// Returns the level that proves the result of [`excludes_unit_interval`], or `None` if nothing is proved.
#[inline]
pub fn find_exclusion(polynomials: &[Polynomial]) -> Option<Level> {
    find_list_exclusion(polynomials.iter().map(Polynomial::coefficients))
}

/// Returns the result of [`find_exclusion`] for the coefficients of polynomials. Small leading coefficients must have
/// been removed.
#[inline]
pub fn find_list_exclusion<'a>(lists: impl Iterator<Item = &'a [f64]> + Clone) -> Option<Level> {
    let mut best = None;
    let mut searches = false;
    for coefficients in lists.clone() {
        if coefficients.len() > 3 {
            searches = true;
        } else if best.is_none() {
            best = closed_form::find_exclusion(coefficients);
        }
    }
    if searches { confirm_exclusion(lists, best) } else { best }
}

/// Returns the result of [`find_list_exclusion`] if at least one of the lists needs a search. `best` is the level that
/// the other lists prove.
fn confirm_exclusion<'a>(lists: impl Iterator<Item = &'a [f64]> + Clone, best: Option<Level>) -> Option<Level> {
    let mut searched = lists.filter(|list| list.len() > 3);
    if !searched.clone().all(search_terminates) {
        return None;
    }
    if best.is_some() {
        return best;
    }
    searched
        .any(|list| is_rejected_and_not_positive(list) || bernstein::is_never_positive(list))
        .then_some(Level::Bernstein)
}

/// Returns whether the root finder rejects the polynomial (a leading zero, which the non-dropping build of
/// root-finder.md 15.1 keeps, or `c z^m`) and its only sample, at 0, is not positive.
#[inline]
fn is_rejected_and_not_positive(coefficients: &[f64]) -> bool {
    coefficients[coefficients.len() - 1] <= 0.0
        && (coefficients[0] == 0.0 || coefficients[1..].iter().all(|&coefficient| coefficient == 0.0))
}

/// Returns whether all coefficients are finite and, unless zero, have a size for which the search is known to end.
#[inline]
fn search_terminates(coefficients: &[f64]) -> bool {
    coefficients.iter().all(|coefficient| {
        let modulus = coefficient.abs();
        modulus == 0.0 || (SEARCH_MIN_COEFFICIENT..=SEARCH_MAX_COEFFICIENT).contains(&modulus)
    })
}

#[cfg(test)]
mod tests;
