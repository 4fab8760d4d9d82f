//! Proofs that no root search is needed: certainly no impact within the step.
//!
//! A detection asks whether [`first_time`](super::first_time::first_time) is at most 1. Nearly always it is not, and a
//! few multiplications show it. Because a search may be skipped only if its answer is known, the question is not where
//! the polynomials *are* positive but where the original's root finder *finds* them so: it samples each gap between the
//! zeros once, and rounding may decide a sample.
//!
//! One condition suffices: the answer exceeds 1 if the computed positive set of *one* polynomial has no interval with
//! `hi > 0` and `lo <= 1`, and if no search hangs. Combining several polynomials would decide next to nothing more in
//! scenes.
//!
//! Proofs and measurements:
//!
//! * **Constants, `c z^m`, lines: exact.** The root finder's own few operations, or a bound on their rounding.
//! * **Parabolas: proved.** The closed form's zeros are those of a polynomial whose coefficients differ by a few units
//!   in the last place of the largest, far less than the margin; the samples' values exceed their rounding because
//!   the zeros are near (see `closed_form`).
//! * **Degree three and above: measured.** Its search is iterative, and what deflation does to zeros is not bounded
//!   here. The polynomial is negative with margin; no zeros coincide or nearly so, which makes all zeros
//!   well-conditioned and keeps samples off double zeros (without this, grids of integers have shown a disagreement in
//!   some hundred thousand); the zeros are not far away. `crates/lab/src/bin/audit` compares
//!   certificate and search, for lists and for each polynomial alone; no disagreement is left.
//! * **Termination: measured** for degree three and above, within the range of coefficients that is admitted.

mod bernstein;
mod closed_form;
pub mod lanes;
mod separated;

use super::{
    polynomial::Polynomial,
    tolerances::{SEARCH_LARGEST_COEFFICIENT, SEARCH_SMALLEST_COEFFICIENT},
};

crate::closed_set! {
    /// Which level of the certificate has decided, cheapest first.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Level {
        /// A polynomial that is nowhere positive by itself: empty, a constant, or `c z^m`.
        Vanishing,
        /// A line that is not positive within the step.
        Line,
        /// A parabola that is not positive within the step.
        Parabola,
        /// A polynomial of degree three or more whose Bernstein coefficients are all negative.
        Bernstein,
    }
}

/// Returns whether [`first_time`](super::first_time::first_time) of these polynomials is certainly greater than 1 (or
/// infinite), with a margin that covers the root finder's own errors, and certainly ends. `false` means "not known".
///
/// Coefficients that are not finite give `false` unless a polynomial of degree at most two decides and every other
/// that holds one is of degree at most two, where the search returns normally.
#[inline]
#[must_use]
pub fn excludes_unit_interval(polynomials: &[Polynomial]) -> bool {
    exclusion(polynomials).is_some()
}

/// Excludes as [`excludes_unit_interval`] does, with the level that has decided.
#[inline]
#[must_use]
pub fn exclusion(polynomials: &[Polynomial]) -> Option<Level> {
    exclusion_of(polynomials.iter().map(Polynomial::coefficients))
}

/// Excludes an impact as [`exclusion`] does, by lists of coefficients without small leading ones.
#[inline]
pub fn exclusion_of<'a>(lists: impl Iterator<Item = &'a [f64]> + Clone) -> Option<Level> {
    let mut best = None;
    let mut searches = false;
    for coefficients in lists.clone() {
        if coefficients.len() > 3 {
            searches = true;
        } else if best.is_none() {
            best = closed_form::never_positive(coefficients);
        }
    }
    if searches { with_search(lists, best) } else { best }
}

/// Returns the levels for lists with a polynomial that needs a search; `known` is the result of the others.
fn with_search<'a>(lists: impl Iterator<Item = &'a [f64]> + Clone, known: Option<Level>) -> Option<Level> {
    let mut searched = lists.filter(|list| list.len() > 3);
    if !searched.clone().all(search_ends) {
        return None;
    }
    if known.is_some() {
        return known;
    }
    searched.any(|list| nowhere_positive(list) || bernstein::never_positive(list)).then_some(Level::Bernstein)
}

/// Returns whether the root finder rejects the polynomial and its only sample, at 0, is not positive: a leading zero
/// (in the non-dropping build), or `c z^m`.
#[inline]
fn nowhere_positive(coefficients: &[f64]) -> bool {
    coefficients[coefficients.len() - 1] <= 0.0
        && (coefficients[0] == 0.0 || coefficients[1..].iter().all(|&coefficient| coefficient == 0.0))
}

/// Returns whether all coefficients are finite and, unless zero, of a size with which the search is known to end.
#[inline]
fn search_ends(coefficients: &[f64]) -> bool {
    coefficients.iter().all(|coefficient| {
        let modulus = coefficient.abs();
        modulus == 0.0 || (SEARCH_SMALLEST_COEFFICIENT..=SEARCH_LARGEST_COEFFICIENT).contains(&modulus)
    })
}

#[cfg(test)]
mod tests;
