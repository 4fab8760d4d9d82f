//! Isolates the real zeros of a square-free polynomial within the step.
//!
//! Descartes' rule of signs in the variable `1/(1+t)` counts the zeros in `(0, 1)` up to an even number, and is exact
//! for none and one. Intervals are halved until the count is exact (Collins and Akritas, 1976); this ends because the
//! zeros are simple.
use super::{dyadic::DyadicNumber, integer::IntegerPolynomial};
use num_bigint::{BigInt, Sign};

/// The number of halvings of an isolating interval after which its enclosure is narrower than a double can express.
const NARROW_BITS: u64 = 60;

/// A zero between two times at which the polynomial is not zero, or exactly at a time, if both are equal.
#[derive(Debug, Clone)]
pub(super) struct Root {
    /// A time before the zero, or the zero itself.
    pub(super) lo: DyadicNumber,
    /// A time after the zero, or the zero itself.
    pub(super) hi: DyadicNumber,
}

impl Root {
    /// Returns a zero that is known exactly.
    pub(super) fn from_point(time: DyadicNumber) -> Self {
        Self { lo: time.clone(), hi: time }
    }

    /// Returns whether the zero is known exactly.
    pub(super) fn is_point(&self) -> bool {
        self.lo == self.hi
    }

    /// Returns whether the zero is exactly 1.
    pub(super) fn is_one(&self) -> bool {
        self.is_point() && self.hi.is_one()
    }

    /// Returns two doubles around the zero: equal if the zero is exact, otherwise a few units of `2^-60` of the step
    /// apart, or neighbors.
    pub(super) fn enclosure(&self, polynomial: &IntegerPolynomial) -> [f64; 2] {
        let mut root = self.clone();
        let before = polynomial.sign_at(&root.lo);
        for _ in 0..NARROW_BITS {
            if root.is_point() {
                break;
            }
            root.halve(polynomial, before);
        }
        [root.lo.enclosure()[0], root.hi.enclosure()[1]]
    }

    /// Halves the interval; `before` is the sign between its start and the zero.
    fn halve(&mut self, polynomial: &IntegerPolynomial, before: i8) {
        let middle = self.lo.midpoint(&self.hi);
        let sign = polynomial.sign_at(&middle);
        if sign == 0 {
            *self = Self::from_point(middle);
        } else if sign == before {
            self.lo = middle;
        } else {
            self.hi = middle;
        }
    }
}

/// Returns the zeros in the open interval `(0, 1)` of a square-free polynomial that is not zero, ascending and
/// separated. Intervals may share an end, but no end of an interval is a zero.
pub(super) fn roots_within_step(polynomial: &IntegerPolynomial) -> Vec<Root> {
    let mut roots = Vec::new();
    // Intervals to check, the leftmost last: the polynomial stretched so that the interval becomes (0, 1), and the
    // interval as numerator and exponent.
    let mut pending = vec![PendingPart::Interval(polynomial.clone(), BigInt::ZERO, 0)];
    while let Some(next) = pending.pop() {
        let (stretched, start, exponent) = match next {
            PendingPart::Interval(stretched, start, exponent) => (stretched, start, exponent),
            PendingPart::Point(time) => {
                roots.push(Root::from_point(time));
                continue;
            }
        };
        match count_variations(&stretched) {
            0 => {}
            1 => roots.push(isolate_root(polynomial, start, exponent)),
            _ => {
                let left = stretched.halve_argument();
                let right = left.shift_by_one();
                let middle: BigInt = (&start << 1) + 1;
                let zero_between = right.coefficients().first().is_some_and(|value| value.sign() == Sign::NoSign);
                pending.push(PendingPart::Interval(right, middle.clone(), exponent + 1));
                if zero_between {
                    pending.push(PendingPart::Point(DyadicNumber { numerator: middle, exponent: exponent + 1 }));
                }
                pending.push(PendingPart::Interval(left, start << 1, exponent + 1));
            }
        }
    }
    roots
}

/// A part of the step that is not decided yet.
enum PendingPart {
    /// An interval from `start / 2^exponent` with the length `1 / 2^exponent`.
    Interval(IntegerPolynomial, BigInt, u64),
    /// An exact zero.
    Point(DyadicNumber),
}

/// Returns the number of sign changes among the coefficients of `(1+t)^n P(1/(1+t))`.
fn count_variations(polynomial: &IntegerPolynomial) -> usize {
    let reversed = IntegerPolynomial::new(polynomial.coefficients().iter().rev().cloned().collect()).shift_by_one();
    let signs = reversed.coefficients().iter().map(BigInt::sign).filter(|&sign| sign != Sign::NoSign);
    signs.clone().zip(signs.skip(1)).filter(|(one, next)| one != next).count()
}

/// Returns the only zero in an open interval. If an end of the interval is a zero as well, the interval is narrowed.
fn isolate_root(polynomial: &IntegerPolynomial, start: BigInt, exponent: u64) -> Root {
    let end: BigInt = &start + 1;
    let (lo, hi) = (DyadicNumber { numerator: start, exponent }, DyadicNumber { numerator: end, exponent });
    let before = polynomial.sign_after(&lo);
    let mut root = Root { lo, hi };
    while !root.is_point() && (polynomial.sign_at(&root.lo) == 0 || polynomial.sign_at(&root.hi) == 0) {
        root.halve(polynomial, before);
    }
    root
}
