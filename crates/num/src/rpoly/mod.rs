//! Finds all zeros of one real polynomial by the Jenkins-Traub algorithm, bit for bit like the original.
//!
//! Jenkins and Traub, *A three-stage algorithm for real polynomials using quadratic iteration*, SIAM J. Numer. Anal. 7,
//! 1970; Jenkins, *Algorithm 493: Zeros of a real polynomial*, ACM TOMS 1, 1975; in the variant of root-finder.md part
//! I. The stages have the names of the papers, one file each. Nothing is stored between calls, nothing allocates, and
//! no operation is reordered: unusual formulas are the original's.
//!
//! The degree of the current polynomial is a compile-time parameter `N` of the inner functions. Their loops are
//! therefore unrolled and their index checks removed, which changes no operation.

mod bound;
mod constants;
mod fixed_shift;
mod linear_iteration;
mod no_shift;
mod quadratic;
mod quadratic_iteration;
mod scalars;
mod scaling;

use constants::{ROTATION_COSINE, ROTATION_SINE, START_X, START_Y};

/// The highest degree that [`zeros`] accepts. The simulator itself needs only five.
pub const MAX_DEGREE: usize = 6;

/// The number of shifts after which the search stops.
const MAX_SHIFTS: usize = 20;

/// The coefficients of a polynomial or of a quotient, highest power first. Those beyond the degree are unused.
type Coefficients = [f64; MAX_DEGREE + 1];

/// A zero, as its real and its imaginary part.
type Zero = (f64, f64);

/// The error that the search would never end. Either a coefficient is not finite (root-finder.md 9.4), or the Newton
/// iteration of the bound cycles among subnormal numbers (9.5). The original hangs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the root search does not terminate")]
pub struct DoesNotTerminate;

/// The zeros of a polynomial **in the order in which they were found**, not sorted.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Zeros {
    is_rejected: bool,
    length: usize,
    steps: u32,
    list: [Zero; MAX_DEGREE],
}

impl Zeros {
    const REJECTED: Self = Self { is_rejected: true, length: 0, steps: 0, list: [(0.0, 0.0); MAX_DEGREE] };

    /// Returns the count that the original returns. This is the degree, or less if the search stopped early. For a
    /// rejected polynomial (a leading zero, or `c z^m`; root-finder.md 2 and 3) it is `-1`.
    pub fn count(&self) -> i32 {
        #[expect(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "at most six")]
        if self.is_rejected { -1 } else { self.length as i32 }
    }

    /// Returns the zeros as pairs (real part, imaginary part). The list is empty if the polynomial was rejected.
    #[inline]
    pub fn as_slice(&self) -> &[(f64, f64)] {
        &self.list[..self.length]
    }

    /// Returns the total number of steps of all stages: usually a few dozen, thousands if a polynomial is mostly
    /// round-off or subnormal. Only the duration of the search depends on it.
    pub fn steps(&self) -> u32 {
        self.steps
    }

    #[inline]
    fn add_zero(&mut self, zero: Zero) {
        self.list[self.length] = zero;
        self.length += 1;
    }
}

/// The result of a search stage, with the remaining polynomial: its first `n + 1 - found` coefficients.
enum SearchResult {
    One { zero: f64, quotient: Coefficients },
    Two { zeros: [Zero; 2], quotient: Coefficients },
}

/// Returns all zeros of the polynomial with the given coefficients, highest power first (root-finder.md 3).
///
/// The result depends only on the coefficients. A leading zero and `c z^m` are rejected. If all twenty shifts fail, the
/// zeros found before are returned. Degrees 1 and 2 use closed forms and accept coefficients that are not finite; the
/// zeros are then the infinities and NaN of the formulas.
///
/// # Errors
/// Fails with [`DoesNotTerminate`] if the original hangs with this input.
///
/// # Panics
/// Panics if there are fewer than 2 or more than [`MAX_DEGREE`]` + 1` coefficients.
#[inline]
pub fn zeros(coefficients: &[f64]) -> Result<Zeros, DoesNotTerminate> {
    assert!((2..=MAX_DEGREE + 1).contains(&coefficients.len()), "degrees 1 to 6 are supported");
    let mut zeros = Zeros::default();
    let mut degree = coefficients.len() - 1;
    if coefficients[0] == 0.0 {
        return Ok(Zeros::REJECTED);
    }
    while coefficients[degree] == 0.0 {
        zeros.add_zero((0.0, 0.0));
        degree -= 1;
    }
    match degree {
        // Zeros at the origin that were just found are discarded.
        0 => return Ok(Zeros::REJECTED),
        1 | 2 => solve_closed_form(&mut zeros, &coefficients[..=degree]),
        _ => {
            let mut polynomial = Coefficients::default();
            polynomial[..=degree].copy_from_slice(&coefficients[..=degree]);
            search(&mut zeros, polynomial, degree)?;
        }
    }
    Ok(zeros)
}

/// Adds the zeros of a line or a parabola, which are the last ones.
#[inline]
fn solve_closed_form(zeros: &mut Zeros, coefficients: &[f64]) {
    match *coefficients {
        [slope, value] => zeros.add_zero((-value / slope, 0.0)),
        [a, b, c] => quadratic::zeros(a, b, c).into_iter().for_each(|zero| zeros.add_zero(zero)),
        _ => {}
    }
}

/// Finds one or two zeros at a time and deflates, until a closed form is left or all shifts fail.
fn search(zeros: &mut Zeros, mut polynomial: Coefficients, mut degree: usize) -> Result<(), DoesNotTerminate> {
    // The search for the next zero continues with this direction.
    let mut direction = (START_X, START_Y);
    loop {
        let found = match degree {
            3 => find::<3>(&mut polynomial, &mut direction, &mut zeros.steps)?,
            4 => find::<4>(&mut polynomial, &mut direction, &mut zeros.steps)?,
            5 => find::<5>(&mut polynomial, &mut direction, &mut zeros.steps)?,
            6 => find::<6>(&mut polynomial, &mut direction, &mut zeros.steps)?,
            _ => {
                solve_closed_form(zeros, &polynomial[..=degree]);
                return Ok(());
            }
        };
        match found {
            None => return Ok(()),
            Some(SearchResult::One { zero, quotient }) => {
                zeros.add_zero((zero, 0.0));
                polynomial = quotient;
                degree -= 1;
            }
            Some(SearchResult::Two { zeros: pair, quotient }) => {
                pair.into_iter().for_each(|zero| zeros.add_zero(zero));
                polynomial = quotient;
                degree -= 2;
            }
        }
    }
}

/// Finds one or two zeros by scaling, bound, no-shift stage, then up to twenty shifts (root-finder.md 3, steps 5 and
/// 6). Returns `None` if all shifts fail.
#[inline(never)]
fn find<const N: usize>(
    polynomial: &mut Coefficients,
    direction: &mut (f64, f64),
    steps: &mut u32,
) -> Result<Option<SearchResult>, DoesNotTerminate> {
    scaling::scale::<N>(polynomial);
    let bound = bound::lower_bound::<N>(polynomial, steps)?;
    let start = no_shift::run::<N>(polynomial);
    for shift in 1..=MAX_SHIFTS {
        let (x, y) = *direction;
        *direction = (ROTATION_COSINE * x - ROTATION_SINE * y, ROTATION_SINE * x + ROTATION_COSINE * y);
        let real_part = bound * direction.0;
        // The published algorithm has the square of the bound here; the original has the bound.
        let found = fixed_shift::run::<N>(polynomial, start, -2.0 * real_part, bound, MAX_SHIFTS * shift, steps);
        if found.is_some() {
            return Ok(found);
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests;
