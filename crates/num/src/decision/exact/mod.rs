//! The exact decision: integers instead of rounding. L3 of [`super::decide`], and the reference that tests compare
//! with.
//!
//! Doubles are integers times powers of two, so each polynomial is one with integer coefficients times a positive
//! factor, which no sign depends on. The zeros of all of them are those of one square-free polynomial; they are
//! isolated between dyadic fractions (`isolate`), and signs at one time per gap say everything about the positive sets.
//!
//! Never rounds, except the enclosure of the time outwards at the end. Allocates, takes microseconds to a millisecond,
//! and more for coefficients whose exponents are far apart.
mod dyadic;
mod integer;
mod isolate;

use dyadic::Dyadic;
use integer::Integer;
use isolate::{Root, roots_within_step};

/// Whether and when `tau` is reached, for coefficients without errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ExactAnswer {
    /// `tau > 1`.
    Never,
    /// `tau <= 1`.
    First {
        /// Encloses `tau`, a fraction of the step in `[0, 1]`; both ends are equal when it is a double.
        time: [f64; 2],
        /// There is no time in `[0, 1]` at which all polynomials are positive: only the closures of their positive sets
        /// meet, for instance because one becomes positive just when another stops being so, or all become positive
        /// right after 1. The slightest change of a coefficient may undo this.
        touching: bool,
    },
    /// A coefficient is infinite or NaN; nothing is decided.
    NotFinite,
}

/// Decides whether `tau <= 1`, exactly: whether the closures of the sets where each polynomial is positive meet in
/// `(0, 1]`. Coefficients come highest power first, untrimmed and of any number.
///
/// * A zero at which a polynomial does not change its sign from above leaves no hole: `t^2 - t + 1/4` is positive
///   always.
/// * A set that ends at exactly 0 does not count, one that starts at exactly 1 does; `tau` is 0 if all are positive
///   right after 0.
/// * No polynomials, an empty one, or one that vanishes identically: [`ExactAnswer::Never`].
/// * `c t^m` keeps its sign; the original takes it as nowhere positive (root-finder.md 17.1).
#[must_use]
pub fn exact_first(polynomials: &[&[f64]]) -> ExactAnswer {
    if polynomials.iter().any(|list| list.iter().any(|value| !value.is_finite())) {
        return ExactAnswer::NotFinite;
    }
    let polynomials: Vec<Integer> = polynomials.iter().map(|list| Integer::from_doubles(list)).collect();
    if polynomials.is_empty() || polynomials.iter().any(Integer::never_positive_after_zero) {
        return ExactAnswer::Never;
    }
    // A polynomial that is positive throughout (0, infinity) does not matter.
    let polynomials: Vec<Integer> = polynomials.into_iter().filter(|one| !one.always_positive_after_zero()).collect();
    let zeros = polynomials.iter().fold(Integer::one(), |product, one| product.united(&one.square_free()));
    let mut roots = roots_within_step(&zeros);
    if zeros.sign_at(&Dyadic::one()) == 0 {
        roots.push(Root::point(Dyadic::one()));
    }
    first_time(&polynomials, &zeros, &mut roots)
}

/// Finds the first gap between the roots in which all are positive, or the first root with every polynomial positive on
/// at least one of its sides.
fn first_time(polynomials: &[Integer], zeros: &Integer, roots: &mut [Root]) -> ExactAnswer {
    let mut before = signs_at(polynomials, &first_sample(roots));
    if before.iter().all(|&positive| positive) {
        return ExactAnswer::First { time: [0.0; 2], touching: false };
    }
    let mut found: Option<usize> = None;
    let mut touching = true;
    for index in 0..roots.len() {
        let after = match sample_after(roots, index) {
            Some(time) => signs_at(polynomials, &time),
            None => polynomials.iter().map(Integer::positive_right_of_one).collect(),
        };
        let meet = before.iter().zip(&after).all(|(&left, &right)| left || right);
        if found.is_none() && meet {
            found = Some(index);
        }
        let within = !roots[index].is_one();
        if within && after.iter().all(|&positive| positive) {
            touching = false;
            break;
        }
        before = after;
    }
    found.map_or(ExactAnswer::Never, |index| ExactAnswer::First { time: roots[index].enclosure(zeros), touching })
}

/// Returns whether each is positive at a time.
fn signs_at(polynomials: &[Integer], time: &Dyadic) -> Vec<bool> {
    polynomials.iter().map(|polynomial| polynomial.sign_at(time) > 0).collect()
}

/// Returns a time between 0 and the first root; no polynomial is zero there.
fn first_sample(roots: &[Root]) -> Dyadic {
    match roots.first() {
        None => Dyadic::one(),
        Some(root) if root.is_point() => root.lo.between(&Dyadic::ZERO),
        Some(root) => root.lo.clone(),
    }
}

/// Returns a time between this root and the next, or 1; no polynomial is zero there. `None` after a root at 1.
fn sample_after(roots: &[Root], index: usize) -> Option<Dyadic> {
    let root = &roots[index];
    if root.is_one() {
        return None;
    }
    if !root.is_point() {
        return Some(root.hi.clone());
    }
    Some(match roots.get(index + 1) {
        None => root.hi.between(&Dyadic::one()),
        Some(next) if next.is_point() => root.hi.between(&next.lo),
        Some(next) => next.lo.clone(),
    })
}
