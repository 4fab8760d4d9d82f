//! Polynomials of degree three to five: when the root finder finds them nowhere positive in `[0, 1]` or in a part of it.
//!
//! On an interval a polynomial lies between the least and the greatest of its Bernstein coefficients (for instance
//! Farouki, *The Bernstein polynomial basis: a centennial retrospective*, CAGD 29, 2012). All of them negative with
//! margin, and the zeros near (a bound after Fujiwara, 1916), has been enough for the root finder; see the header of
//! [`super`] for what is only measured.
use super::super::{
    interval::Interval,
    polynomial::Polynomial,
    tolerances::{BERNSTEIN_MARGIN, BERNSTEIN_NEAR},
};

/// How often a window is halved, at most.
const MAX_HALVINGS: u32 = 3;

/// The highest degree of a detection polynomial.
const MAX_DEGREE: usize = 5;

/// The Bernstein coefficients of a polynomial on some interval; those beyond the degree are unused.
type Control = [f64; MAX_DEGREE + 1];

/// Whether a polynomial of degree three to five is certainly not positive in `[0, 1]`.
#[inline]
pub(super) fn never_positive(coefficients: &[f64]) -> bool {
    // The value at 0 is the cheapest test; it fails for most that are positive somewhere.
    coefficients[coefficients.len() - 1] < 0.0 && Bounded::new(coefficients).is_some_and(|bounded| bounded.negative())
}

/// Whether at each time of the window one of the polynomials of degree three and more is certainly not positive.
pub(super) fn negative_in_window(polynomials: &[Polynomial], window: Interval) -> bool {
    let mut candidates = [None; 4];
    let mut count = 0;
    for list in polynomials.iter().map(Polynomial::coefficients).filter(|list| list.len() > 3) {
        if let Some(bounded) = Bounded::new(list)
            && let Some(place) = candidates.get_mut(count)
        {
            *place = Some(bounded.restricted(window));
            count += 1;
        }
    }
    covered(candidates, MAX_HALVINGS)
}

/// Whether the candidates cover their interval: one is negative on all of it, or they cover both halves.
fn covered(mut candidates: [Option<Bounded>; 4], halvings: u32) -> bool {
    if candidates.iter().flatten().any(Bounded::negative) {
        return true;
    }
    if halvings == 0 {
        return false;
    }
    // At either end one has to be negative; otherwise no halving can help.
    let hopeful = |end: fn(&Bounded) -> bool| candidates.iter().flatten().any(end);
    if !hopeful(|bounded| bounded.control[0] < bounded.below) || !hopeful(Bounded::last_is_negative) {
        return false;
    }
    let mut right = [None; 4];
    for (left, right) in candidates.iter_mut().zip(&mut right) {
        if let Some(bounded) = left {
            *right = Some(bounded.split(0.5));
        }
    }
    covered(candidates, halvings - 1) && covered(right, halvings - 1)
}

/// A polynomial with zeros near, in Bernstein form, and the value that it must stay below.
#[derive(Clone, Copy)]
struct Bounded {
    degree: usize,
    control: Control,
    below: f64,
}

impl Bounded {
    /// The Bernstein form on `[0, 1]`; `None` when the zeros may be far away or a coefficient is not a number.
    #[inline]
    fn new(coefficients: &[f64]) -> Option<Self> {
        match *coefficients {
            [a, b, c, d] => Self::with_reciprocals(&[d, c, b, a], &[1.0, 1.0 / 3.0, 1.0 / 3.0, 1.0]),
            [a, b, c, d, e] => Self::with_reciprocals(&[e, d, c, b, a], &[1.0, 0.25, 1.0 / 6.0, 0.25, 1.0]),
            [a, b, c, d, e, f] => Self::with_reciprocals(&[f, e, d, c, b, a], &[1.0, 0.2, 0.1, 0.1, 0.2, 1.0]),
            _ => None,
        }
    }

    /// From coefficients, lowest power first, and the reciprocals of the binomial coefficients.
    #[inline(always)]
    fn with_reciprocals<const LENGTH: usize>(ascending: &[f64; LENGTH], reciprocals: &[f64; LENGTH]) -> Option<Self> {
        let mut near = ascending[LENGTH - 1].abs();
        let mut size = near;
        let mut zeros_are_near = true;
        for coefficient in ascending[..LENGTH - 1].iter().rev() {
            near *= BERNSTEIN_NEAR;
            let modulus = coefficient.abs();
            size += modulus;
            zeros_are_near &= modulus <= near;
        }
        if !zeros_are_near {
            return None;
        }
        let mut control = Control::default();
        for i in 0..LENGTH {
            control[i] = ascending[i] * reciprocals[i];
        }
        // Pascal's triangle: entry k becomes the sum of (k over i) times entry i.
        for row in 1..LENGTH {
            for i in (row..LENGTH).rev() {
                control[i] += control[i - 1];
            }
        }
        Some(Self { degree: LENGTH - 1, control, below: -BERNSTEIN_MARGIN * size })
    }

    /// Whether all Bernstein coefficients are negative, with margin.
    #[inline]
    fn negative(&self) -> bool {
        self.control[..=self.degree].iter().all(|&value| value < self.below)
    }

    #[inline]
    fn last_is_negative(&self) -> bool {
        self.control[self.degree] < self.below
    }

    /// De Casteljau's algorithm: keeps the part before `t` (a fraction of the interval) and returns the other.
    #[inline]
    fn split(&mut self, t: f64) -> Self {
        let degree = self.degree;
        let mut right = self.control;
        // Row by row the first entry is the left part's next coefficient; the last one stays in place, as the right
        // part's.
        for (row, left) in self.control.iter_mut().enumerate().take(degree + 1) {
            *left = right[0];
            for i in 0..degree - row {
                right[i] += (right[i + 1] - right[i]) * t;
            }
        }
        Self { control: right, ..*self }
    }

    /// The same polynomial on a part of `[0, 1]`.
    #[inline]
    fn restricted(mut self, window: Interval) -> Self {
        if window.hi < 1.0 {
            self.split(window.hi);
        }
        // The left end as a fraction of what is left; a rounding error here is covered by the margin.
        if window.lo > 0.0 { self.split(window.lo / window.hi) } else { self }
    }
}
