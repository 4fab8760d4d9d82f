//! Certified decisions: whether a detection hits within the step, regardless of the rounding of its polynomials.
//!
//! A detection hits if the first time `tau` of its polynomials is at most 1 (root-finder.md 16). It is enough that the
//! *closures* of their positive sets meet in `(0, 1]`; a common open interval is not necessary. Each coefficient is
//! known up to an error. [`decide`] finds whether the result is the same for all choices of coefficients, and proves
//! it. It does not depend on the result of the original's root finder (that is [`first_time`](super::first_time), and
//! [`certificate`](super::certificate) for skipping it).
//!
//! The mathematics is short. For `t >= 0` a polynomial grows with each of its coefficients. Among all choices, the one
//! with the greatest coefficients ("upper") is therefore positive wherever any choice is. The one with the least
//! coefficients ("lower") is positive only where all choices are. Hence `tau(upper) <= tau <= tau(lower)` for every
//! choice, and both ends are choices themselves:
//!
//! * **Yes** exactly if `tau(lower) <= 1`, with `[tau(upper), tau(lower)]` as enclosure of the time;
//! * **No** exactly if `tau(upper) > 1`;
//! * **Borderline** otherwise: some choices hit, others do not. (Also if a proof would take too long; see [`decide`].)
//!
//! It remains to decide two lists without errors. `range` rejects them by signs and by Bernstein coefficients, `pieces`
//! by subdivision with bounds on its own rounding (Higham, *Accuracy and Stability of Numerical Algorithms*, section
//! 3.3; Farouki, *The Bernstein polynomial basis: a centennial retrospective*, CAGD 29, 2012), and the rest is decided
//! by integer arithmetic (`exact`), which always has a result.
//!
//! The rules, and their differences from the original, are as follows. Zeros at which a polynomial only touches zero
//! from above do not interrupt its positive set (root-finder.md 15.4). Sets that have only one time in common meet
//! (17.11). A time of exactly 1 counts, but sets that end at exactly 0 do not count (16.2). An empty list, an empty
//! polynomial and a zero polynomial are nowhere positive (17.2). Coefficients are used unchanged, and small leading
//! ones are not dropped. If `c` is positive, `c t^m` is positive after 0, while the original treats it as nowhere
//! positive (17.1). Code that compares with the original must allow for both differences.
pub mod exact;
pub(crate) mod pieces;
pub(crate) mod range;
mod short_numbers;

#[cfg(test)]
mod tests;

use super::{
    bounded::{BoundedValue, UNIT_ROUNDOFF},
    polynomial::MAX_COEFFICIENTS,
};
use exact::{ExactAnswer, find_exact_first_time};
use pieces::{Answer, SearchOutcome};
use range::{IntervalEnd, Problem};
pub use short_numbers::are_short;

/// The maximum number of polynomials of one detection.
pub const MAX_POLYNOMIALS: usize = 4;

/// The largest reported margin, in units of [`UNIT_ROUNDOFF`]. With it, the decision is right for any relative error up
/// to about 1.
pub const MAX_MARGIN: f64 = 9_007_199_254_740_992.0;

/// The largest difference between the binary exponents of two coefficients for which [`decide`] uses integers if there
/// are errors. It is enough for the fifth powers of displacements of `1e-20` next to distances of 1. A larger number
/// makes hostile input slower.
const MAX_EXPONENT_SPREAD: u64 = 400;

/// Whether the detection hits within the step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HitCertainty {
    /// All choices of coefficients within their bounds give `tau <= 1`.
    Hits,
    /// All choices give `tau > 1`.
    Misses,
    /// Some choices hit and others do not, or nothing could be proved (see [`decide`]).
    Borderline,
}

crate::closed_set! {
    /// The level that has decided. The cheapest level is first.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
    pub enum Level {
        /// The signs of the coefficients, or the interval sum of their terms, decide (level 0).
        Range,
        /// The Bernstein coefficients of one polynomial on `[0, 1]` decide (level 1).
        Bernstein,
        /// The subdivision of `[0, 1]` decides (level 2).
        Subdivision,
        /// Integer arithmetic decides (level 3).
        Exact,
    }
}

/// A decision, with its enclosure, margin and level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CertifiedDecision {
    /// Whether the detection hits, or is too close to call.
    pub certainty: HitCertainty,
    /// An enclosure of `tau`, a fraction of the step in `[0, 1]`. For `Hits`, it is valid for every choice of
    /// coefficients. It is then about as wide as the effect of the coefficients' errors, or wider if the polynomials
    /// nearly touch earlier in the step. For `Borderline`, it holds for the smallest `tau` of any choice (if that is at
    /// most 1), or is `None` if a coefficient is not finite. The value is `None` for `Misses`.
    pub time: Option<[f64; 2]>,
    /// The decision is proved to be right if no coefficient is wrong by more than `margin * u` times its bound, where
    /// `u` is [`UNIT_ROUNDOFF`]. The margin is at least the given `units` and at most [`MAX_MARGIN`]; the true one may
    /// be larger. It is 0 for `Borderline`.
    pub margin: f64,
    /// The level that was needed.
    pub level: Level,
}

/// Decides whether all polynomials of a detection become positive within the step. The result states whether `tau <= 1`
/// for every choice of coefficients, for none, or for some (see the module's header). The choices deviate by at most
/// `units` times [`UNIT_ROUNDOFF`] times the coefficients' bounds.
///
/// Coefficients must be in the order highest power first, untrimmed. With `units` 0 (or bounds that are all 0) the
/// result is that of [`find_exact_first_time`] and never `Borderline`. A coefficient that is not finite always gives
/// `Borderline`.
///
/// With errors, only integers can decide a polynomial that is very close to the limit. If the sizes of its coefficients
/// spread over more than 400 powers of two, this might take a tenth of a second, so the result is `Borderline`.
///
/// # Panics
/// Panics if there are more than [`MAX_POLYNOMIALS`] polynomials, or one of them has more than [`MAX_COEFFICIENTS`]
/// coefficients.
pub fn decide(polynomials: &[&[BoundedValue]], units: f64) -> CertifiedDecision {
    let upper = Problem::new(polynomials, units, IntervalEnd::Upper);
    if !upper.is_finite() {
        return borderline_decision(None, Level::Range);
    }
    if let Some((level, slack)) = upper.find_exclusion() {
        return miss_decision(level, units + slack);
    }
    let lower = Problem::new(polynomials, units, IntervalEnd::Lower);
    if !lower.is_finite() {
        return borderline_decision(None, Level::Range);
    }
    if lower.starts_positive() {
        return hit_decision([0.0; 2], units + lower.hit_slack(0.0), Level::Range);
    }
    let outer = pieces::search(&upper);
    if outer.answer == Answer::Never {
        return miss_decision(Level::Subdivision, units + outer.slack);
    }
    if upper.has_equal_coefficients(&lower) {
        return decide_without_errors(&upper, &outer, units);
    }
    let (inner, from) = (pieces::search(&lower), outer.not_before);
    match (outer.answer, inner.answer) {
        (_, Answer::Reached(time)) => hit_decision([from, time], units + lower.hit_slack(time), Level::Subdivision),
        (Answer::Reached(first), Answer::Never) => borderline_decision(Some([from, first]), Level::Subdivision),
        (outer, _) if upper.exponent_spread().max(lower.exponent_spread()) > MAX_EXPONENT_SPREAD => {
            let to = if let Answer::Reached(first) = outer { first } else { 1.0 };
            borderline_decision(Some([from, to]), Level::Subdivision)
        }
        (outer, inner) => decide_by_integers(&upper, &lower, units, outer != Answer::Unknown, inner == Answer::Never),
    }
}

/// Returns the decision if all coefficients are exact.
fn decide_without_errors(problem: &Problem, search: &SearchOutcome, units: f64) -> CertifiedDecision {
    match search.answer {
        Answer::Reached(time) => {
            hit_decision([search.not_before, time], units + problem.hit_slack(time), Level::Subdivision)
        }
        Answer::Never => miss_decision(Level::Subdivision, units + search.slack),
        Answer::Unknown => match decide_exactly(problem) {
            ExactAnswer::First { time, .. } => hit_decision(time, units, Level::Exact),
            ExactAnswer::Never | ExactAnswer::NotFinite => miss_decision(Level::Exact, units),
        },
    }
}

/// Returns the decision by exact arithmetic. `upper_hits` and `lower_misses` are whether subdivision has proved that
/// the upper choice hits, and that the lower one misses.
fn decide_by_integers(
    upper: &Problem,
    lower: &Problem,
    units: f64,
    upper_hits: bool,
    lower_misses: bool,
) -> CertifiedDecision {
    let ExactAnswer::First { time: first, .. } = decide_exactly(upper) else {
        debug_assert!(!upper_hits, "the subdivision has proved a hit");
        return miss_decision(Level::Exact, units);
    };
    if !lower_misses && let ExactAnswer::First { time: [_, to], .. } = decide_exactly(lower) {
        return hit_decision([first[0], to], units, Level::Exact);
    }
    borderline_decision(Some(first), Level::Exact)
}

/// Returns the result of [`find_exact_first_time`] for a problem's coefficients.
fn decide_exactly(problem: &Problem) -> ExactAnswer {
    let lists = problem.coefficients_highest_first();
    let mut slices = [&[] as &[f64]; MAX_POLYNOMIALS];
    for (slice, (list, length)) in slices.iter_mut().zip(&lists) {
        *slice = &list[..*length];
    }
    find_exact_first_time(&slices[..problem.polynomials().len()])
}

fn hit_decision(time: [f64; 2], margin: f64, level: Level) -> CertifiedDecision {
    CertifiedDecision { certainty: HitCertainty::Hits, time: Some(time), margin: margin.min(MAX_MARGIN), level }
}

fn miss_decision(level: Level, margin: f64) -> CertifiedDecision {
    CertifiedDecision { certainty: HitCertainty::Misses, time: None, margin: margin.min(MAX_MARGIN), level }
}

fn borderline_decision(time: Option<[f64; 2]>, level: Level) -> CertifiedDecision {
    CertifiedDecision { certainty: HitCertainty::Borderline, time, margin: 0.0, level }
}
