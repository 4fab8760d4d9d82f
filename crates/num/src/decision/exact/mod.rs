//! The exact decision, with integers instead of rounding. It is level 3 of [`super::decide`], and the tests' reference.
//!
//! Doubles are integers times powers of two, so each polynomial is a positive factor times one with integer
//! coefficients, and signs do not depend on the factor. The zeros of all of them are those of one square-free
//! polynomial. They are isolated between dyadic fractions (`isolate`), and the signs at one time per gap determine the
//! positive sets.
//!
//! The decision never rounds, except the enclosure of the time outward at the end. It allocates, and takes microseconds
//! to a millisecond, or more for coefficients whose exponents are far apart.
mod dyadic;
mod integer;
mod isolate;

use dyadic::DyadicNumber;
use integer::IntegerPolynomial;
use isolate::{Root, roots_within_step};

/// The answer to whether and when all polynomials become positive (at the time `tau`), for coefficients without errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ExactAnswer {
    /// The time `tau` is greater than 1.
    Never,
    /// The time `tau` is at most 1.
    First {
        /// An enclosure of `tau`, a fraction of the step in `[0, 1]`. Both ends are equal if `tau` is a double.
        time: [f64; 2],
        /// Whether only the closures of the positive sets meet, and there is no time in `[0, 1]` at which all
        /// polynomials are positive. For example, one becomes positive exactly when another stops, or all become
        /// positive right after 1. A tiny change of a coefficient may change this.
        touching: bool,
    },
    /// A coefficient is infinite or NaN, so nothing is decided.
    NotFinite,
}

/// Decides whether `tau <= 1`, exactly: whether the closures of the sets where each polynomial is positive meet in `(0,
/// 1]`. Coefficients must be in the order highest power first, untrimmed, of any number.
///
/// * A zero at which a positive polynomial does not change its sign does not interrupt the set: `t² - t + 1/4` is
///   always positive.
/// * A set that ends at exactly 0 does not count; a set that starts at exactly 1 does. `tau` is 0 if all are positive
///   right after 0.
/// * Without polynomials, or with one that is empty or zero, the answer is [`ExactAnswer::Never`].
/// * `c t^m` keeps its sign; the original treats it as nowhere positive (root-finder.md 17.1).
pub fn find_exact_first_time(polynomials: &[&[f64]]) -> ExactAnswer {
    if polynomials.iter().any(|list| list.iter().any(|value| !value.is_finite())) {
        return ExactAnswer::NotFinite;
    }
    let polynomials: Vec<IntegerPolynomial> =
        polynomials.iter().map(|list| IntegerPolynomial::from_doubles(list)).collect();
    if polynomials.is_empty() || polynomials.iter().any(IntegerPolynomial::is_never_positive_after_zero) {
        return ExactAnswer::Never;
    }
    // A polynomial that is positive on the whole interval (0, infinity) does not matter.
    let polynomials: Vec<IntegerPolynomial> =
        polynomials.into_iter().filter(|polynomial| !polynomial.is_always_positive_after_zero()).collect();
    let zeros = polynomials
        .iter()
        .fold(IntegerPolynomial::one(), |product, polynomial| product.unite(&polynomial.square_free_part()));
    let mut roots = roots_within_step(&zeros);
    if zeros.sign_at(&DyadicNumber::one()) == 0 {
        roots.push(Root::from_point(DyadicNumber::one()));
    }
    first_time(&polynomials, &zeros, &mut roots)
}

/// Finds the first gap between the roots in which all are positive, or the first root with every polynomial positive on
/// at least one of its sides.
fn first_time(polynomials: &[IntegerPolynomial], zeros: &IntegerPolynomial, roots: &mut [Root]) -> ExactAnswer {
    let mut before = are_positive_at(polynomials, &first_sample_time(roots));
    if before.iter().all(|&positive| positive) {
        return ExactAnswer::First { time: [0.0; 2], touching: false };
    }
    let mut found: Option<usize> = None;
    let mut touching = true;
    for index in 0..roots.len() {
        let after = match sample_time_after(roots, index) {
            Some(time) => are_positive_at(polynomials, &time),
            None => polynomials.iter().map(IntegerPolynomial::is_positive_right_of_one).collect(),
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

/// Returns whether each polynomial is positive at a time.
fn are_positive_at(polynomials: &[IntegerPolynomial], time: &DyadicNumber) -> Vec<bool> {
    polynomials.iter().map(|polynomial| polynomial.sign_at(time) > 0).collect()
}

/// Returns a time between 0 and the first root, at which no polynomial is zero.
fn first_sample_time(roots: &[Root]) -> DyadicNumber {
    match roots.first() {
        None => DyadicNumber::one(),
        Some(root) if root.is_point() => root.lo.midpoint(&DyadicNumber::ZERO),
        Some(root) => root.lo.clone(),
    }
}

/// Returns a time between root `index` and the next, or 1, at which no polynomial is zero, or `None` after a root at 1.
fn sample_time_after(roots: &[Root], index: usize) -> Option<DyadicNumber> {
    let root = &roots[index];
    if root.is_one() {
        return None;
    }
    if !root.is_point() {
        return Some(root.hi.clone());
    }
    Some(match roots.get(index + 1) {
        None => root.hi.midpoint(&DyadicNumber::one()),
        Some(next) if next.is_point() => root.hi.midpoint(&next.lo),
        Some(next) => next.lo.clone(),
    })
}
