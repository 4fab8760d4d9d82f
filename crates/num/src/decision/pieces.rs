//! Subdivision of `[0, 1]`: level 2 of [`super::decide`].
//!
//! Pieces are visited from left to right and halved by de Casteljau's algorithm. On a piece a polynomial lies between
//! its smallest and its largest Bernstein coefficient; each list has a bound on its rounding, which grows with every
//! halving. A piece is closed when one polynomial is negative throughout; a time at which all are positive ends the
//! search. Halving stops if the coefficients are not larger than their rounding; the piece then stays open. If one
//! polynomial is left and its coefficients change their sign once, it has exactly one zero in the piece, which
//! bisection by values brackets faster.
use super::{
    MAX_POLYNOMIALS, UNIT_ROUNDOFF,
    range::{BernsteinForm, Problem, slack},
};

/// The maximum number of halvings. A piece that is still undecided after them stays undecided.
const MAX_DEPTH: u32 = 150;

/// The width below which a piece stays open, as a share of the piece's end. The ends of wider pieces are exact.
const MIN_WIDTH: f64 = 1.0 / (1_u64 << 50) as f64;

/// The number of pieces after which all others stay open. Ordinary searches need a few hundred.
const MAX_PIECES: u32 = 5_000;

/// The multiple of its rounding below which a coefficient is noise, so that halving shows no more.
const NOISE_FACTOR: f64 = 2.0;

/// Whether a search has found a time at which all polynomials are positive.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Answer {
    /// All polynomials are positive at this time, so `tau` is at most this time.
    Reached(f64),
    /// A polynomial is negative at every time in `[0, 1]`.
    Never,
    /// No such time was found, but some pieces are still undecided.
    Unknown,
}

/// The answer of a search, with the values that prove it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SearchOutcome {
    /// Whether a time was found.
    pub(crate) answer: Answer,
    /// The time before which a polynomial is always negative.
    pub(crate) not_before: f64,
    /// For [`Answer::Never`], the answer is proved to be right if each coefficient is wrong by at most `slack` units of
    /// its bound.
    pub(crate) slack: f64,
}

/// Searches `[0, 1]` for the first time at which all polynomials are positive.
pub(crate) fn search(problem: &Problem) -> SearchOutcome {
    let mut walk = PieceWalk { problem, first_open: None, slack: f64::INFINITY, pieces: 0 };
    let mut controls = BernsteinForms::new();
    for (index, polynomial) in problem.polynomials().iter().enumerate() {
        controls.push(BernsteinForm { index, ..polynomial.compute_bernstein() });
    }
    let reached = walk.visit_piece(0.0, 1.0, &controls, 0);
    let answer = match (reached, walk.first_open) {
        (Some(time), _) => Answer::Reached(time),
        (None, None) => Answer::Never,
        (None, Some(_)) => Answer::Unknown,
    };
    SearchOutcome { answer, not_before: walk.first_open.or(reached).unwrap_or(1.0), slack: walk.slack }
}

/// The polynomials whose sign on a piece is unknown; all others are positive on it.
#[derive(Clone, Copy)]
struct BernsteinForms {
    list: [BernsteinForm; MAX_POLYNOMIALS],
    count: usize,
}

impl BernsteinForms {
    const fn new() -> Self {
        let empty = BernsteinForm { values: [0.0; super::MAX_COEFFICIENTS], length: 0, error: 0.0, index: 0 };
        Self { list: [empty; MAX_POLYNOMIALS], count: 0 }
    }

    fn push(&mut self, control: BernsteinForm) {
        self.list[self.count] = control;
        self.count += 1;
    }

    fn as_slice(&self) -> &[BernsteinForm] {
        &self.list[..self.count]
    }

    /// Returns whether all polynomials are positive at the left end.
    fn starts_positive(&self) -> bool {
        self.as_slice().iter().all(|control| control.values[0] > control.error)
    }

    /// Returns whether all polynomials are positive at the right end.
    fn ends_positive(&self) -> bool {
        self.as_slice().iter().all(|control| control.values[control.length - 1] > control.error)
    }
}

/// A running search through the pieces of `[0, 1]`.
struct PieceWalk<'a> {
    problem: &'a Problem,
    first_open: Option<f64>,
    slack: f64,
    pieces: u32,
}

impl PieceWalk<'_> {
    /// Visits the piece from `lo` to `hi`. Returns the first time at which all polynomials were found to be positive,
    /// if there is one.
    fn visit_piece(&mut self, lo: f64, hi: f64, controls: &BernsteinForms, depth: u32) -> Option<f64> {
        self.pieces += 1;
        let mut open = BernsteinForms::new();
        let mut improves = false;
        for control in controls.as_slice() {
            match Sign::from_control(control) {
                Sign::Negative(distance) => {
                    self.slack = self.slack.min(slack(distance, self.problem.polynomials()[control.index].bound));
                    return None;
                }
                Sign::Positive => {}
                Sign::Mixed => {
                    improves = true;
                    open.push(*control);
                }
                Sign::Noise => open.push(*control),
            }
        }
        // If no polynomial is open, all are positive on the whole piece.
        if open.starts_positive() {
            return Some(lo);
        }
        let is_last = depth == MAX_DEPTH || hi - lo < MIN_WIDTH * hi || self.pieces >= MAX_PIECES;
        if !improves || is_last {
            self.first_open.get_or_insert(lo);
            return open.ends_positive().then_some(hi);
        }
        if let [single] = open.as_slice()
            && rises_once(single)
        {
            return Some(self.bracket(single, lo, hi));
        }
        let middle = lo + (hi - lo) * 0.5;
        let (mut left, mut right) = (BernsteinForms::new(), BernsteinForms::new());
        for control in open.as_slice() {
            let (mut first, second) = split(control);
            if lo == 0.0 {
                // Near 0 small coefficients decide, which large ones have swamped, so they are converted again.
                let fresh = self.problem.polynomials()[control.index].compute_bernstein_until(middle);
                first = BernsteinForm { index: control.index, ..fresh };
            }
            left.push(first);
            right.push(second);
        }
        self.visit_piece(lo, middle, &left, depth + 1).or_else(|| self.visit_piece(middle, hi, &right, depth + 1))
    }

    /// Brackets the only zero of a polynomial that rises through it between two times, where all others are positive.
    /// Records the time before it as the start of an open piece, and returns the time after.
    fn bracket(&mut self, control: &BernsteinForm, mut lo: f64, mut hi: f64) -> f64 {
        let polynomial = &self.problem.polynomials()[control.index];
        loop {
            let middle = lo + (hi - lo) * 0.5;
            let (value, error) = polynomial.value_at(middle);
            // The midpoint of neighbors equals one of them, which also ends the loop.
            if value > error && middle < hi {
                hi = middle;
            } else if value < -error && middle > lo {
                lo = middle;
            } else {
                break;
            }
        }
        self.first_open.get_or_insert(lo);
        hi
    }
}

/// Returns whether the Bernstein coefficients are negative up to an index and positive after it, with at most one
/// coefficient between them, whose sign does not matter. The sign changes once, so the polynomial has one change as
/// well (Descartes' rule of signs).
fn rises_once(control: &BernsteinForm) -> bool {
    let values = &control.values[..control.length];
    let negative = values.iter().take_while(|&&value| value < -control.error).count();
    let positive = values.iter().rev().take_while(|&&value| value > control.error).count();
    negative > 0 && positive > 0 && negative + positive + 1 >= values.len()
}

/// The sign of a polynomial on a piece, if its Bernstein coefficients show it.
enum Sign {
    /// All coefficients are negative, and at least this far from zero.
    Negative(f64),
    /// All coefficients are positive.
    Positive,
    /// No coefficient is clearly larger than its rounding error.
    Noise,
    /// The signs are mixed, so halving helps.
    Mixed,
}

impl Sign {
    fn from_control(control: &BernsteinForm) -> Self {
        let values = &control.values[..control.length];
        let (mut minimum, mut maximum) = (f64::INFINITY, f64::NEG_INFINITY);
        for &value in values {
            minimum = minimum.min(value);
            maximum = maximum.max(value);
        }
        if maximum < -control.error {
            Self::Negative(-maximum - control.error)
        } else if minimum > control.error {
            Self::Positive
        } else if -minimum > NOISE_FACTOR * control.error || maximum > NOISE_FACTOR * control.error {
            Self::Mixed
        } else {
            Self::Noise
        }
    }
}

/// Returns the Bernstein coefficients of the two halves (de Casteljau). A sum is rounded; halving is exact except for
/// underflow, which the error already covers. All intermediate values are convex combinations of the first ones.
fn split(control: &BernsteinForm) -> (BernsteinForm, BernsteinForm) {
    let (mut left, mut right) = (*control, *control);
    let length = control.length;
    let size = control.values[..length].iter().fold(0.0_f64, |maximum, value| maximum.max(value.abs()));
    for step in 1..length {
        for i in 0..length - step {
            right.values[i] = (right.values[i] + right.values[i + 1]) * 0.5;
        }
        left.values[step] = right.values[0];
    }
    // One more than the number of steps covers the rounding of the bound itself.
    left.error += length as f64 * UNIT_ROUNDOFF * (size + control.error);
    right.error = left.error;
    (left, right)
}
