//! Studies one detection call: its polynomials, their zeros, the times at which each polynomial or all of them are
//! positive, and the result.
//!
//! The study judges nothing. Its numbers are identical to the reference's, because it uses the same formulas, root
//! finder and sets of times (collisions.md 2, root-finder.md 15 and 16). It adds the mathematically right approach
//! polynomial of a particle and an edge (numerics.md 1), and whether round-off may change the reference's decision.
use crate::{
    fair::{certain_decision, compare::compare, formulas},
    finding::Role,
};
use fosssim_model::sim::{Decision, ImpactTime, PairMotion, PointMotion};
use fosssim_num::{
    bounded::{BoundedValue, BoundedVector},
    first_time::{first_time, positive_set},
    interval::{Interval, Intervals},
    polynomial::{MAX_COEFFICIENTS, Polynomial},
    rpoly,
    tolerances::MIN_IMAGINARY_PART,
};

fosssim_model::drops_leading!();

/// One polynomial of a detection call, and its positive intervals.
#[derive(Debug, Clone, PartialEq)]
pub struct StudiedPolynomial {
    /// The meaning of a positive value of the polynomial.
    pub role: Role,
    /// The polynomial's coefficients, highest power first, with nothing dropped.
    pub untrimmed: Polynomial,
    /// The polynomial as logged and searched, without small leading coefficients.
    pub logged: Polynomial,
    /// The zeros in the order of the reference's root finder, as real and imaginary part.
    pub zeros: Vec<(f64, f64)>,
    /// The intervals in which the polynomial is positive, over all times. They are sorted and disjoint.
    pub positive_intervals: Vec<Interval>,
}

impl StudiedPolynomial {
    fn search(role: Role, untrimmed: Polynomial) -> Result<Self, EndlessSearch> {
        let endless = |_| EndlessSearch { role, coefficients: untrimmed };
        let logged = Polynomial::trimmed(untrimmed.coefficients());
        let zeros = match logged.coefficients() {
            [] | [_] => Vec::new(),
            coefficients => rpoly::zeros(coefficients).map_err(endless)?.as_slice().to_vec(),
        };
        let positive = positive_set(logged.coefficients()).map_err(endless)?.as_slice().to_vec();
        Ok(Self { role, untrimmed, logged, zeros, positive_intervals: positive })
    }

    /// Returns the zeros that count as real, ascending.
    pub fn real_zeros(&self) -> Vec<f64> {
        let real = self.zeros.iter().filter(|(_, imaginary)| imaginary.abs() < MIN_IMAGINARY_PART);
        let mut zeros: Vec<f64> = real.map(|&(real, _)| real).collect();
        zeros.sort_by(f64::total_cmp);
        zeros
    }
}

/// The error if the zeros of a polynomial cannot be found. The search would never end, because a coefficient is not
/// finite or is extremely small. The original hangs on such polynomials.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the root search of the {role} polynomial does not end")]
pub struct EndlessSearch {
    /// The role of the polynomial.
    pub role: Role,
    /// The polynomial's coefficients, with nothing dropped.
    pub coefficients: Polynomial,
}

/// The decision that follows from a list of polynomials.
#[derive(Debug, Clone, PartialEq)]
pub struct PairDecision {
    /// The intervals in which all polynomials are positive, over all times. They are sorted and disjoint, and an
    /// interval may be a single time.
    pub positive_intervals: Vec<Interval>,
    /// The decision whether the pair collides.
    pub decision: Decision,
}

impl PairDecision {
    fn for_motion(motion: &PairMotion, curves: &[&StudiedPolynomial]) -> Result<Self, EndlessSearch> {
        let polynomials: Vec<Polynomial> = curves.iter().map(|curve| curve.logged).collect();
        // Each search was made separately before, and has ended.
        let time = first_time(&polynomials).unwrap_or(f64::INFINITY);
        let normal = if time <= 1.0 { motion.normal(time) } else { None };
        let decision = match normal {
            Some(normal) => Decision::Hit { time, normal },
            None => Decision::Miss { time: ImpactTime::Found(time) },
        };
        let mut both = Intervals::<MAX_SETS>::EMPTY;
        both.push(Interval::ALL_TIMES);
        for curve in curves {
            let mut set = Intervals::<MAX_SETS>::EMPTY;
            curve.positive_intervals.iter().for_each(|&interval| set.push(interval));
            both = both.intersection(&set);
        }
        let positive = if curves.is_empty() { Vec::new() } else { both.as_slice().to_vec() };
        Ok(Self { positive_intervals: positive, decision })
    }
}

/// The capacity for the common intervals of four polynomials.
const MAX_SETS: usize = 32;

/// The mathematically right approach polynomial of a particle and an edge, and the decision that follows from it.
#[derive(Debug, Clone, PartialEq)]
pub struct RightApproach {
    /// The polynomial, which differs from the course's only in the coefficient of t^3.
    pub curve: StudiedPolynomial,
    /// The decision that follows from this polynomial and the other three.
    pub answer: PairDecision,
}

/// A detection call in detail.
#[derive(Debug, Clone, PartialEq)]
pub struct Study {
    /// The pair and its motion.
    pub motion: PairMotion,
    /// The pair's polynomials in the order of the trace.
    pub curves: Vec<StudiedPolynomial>,
    /// The reference's decision.
    pub answer: PairDecision,
    /// Whether the pair provably collides, or provably does not, in every correct program. `None` means that
    /// round-off may change the decision.
    pub certain_decision: Option<bool>,
    /// The right approach polynomial, if it differs from the course's.
    pub right_approach: Option<RightApproach>,
}

impl Study {
    /// Returns the study of a pair with the given motion.
    ///
    /// # Errors
    /// Fails with [`EndlessSearch`] if the original hangs.
    pub fn for_motion(motion: &PairMotion) -> Result<Self, EndlessSearch> {
        let kind = motion.kind();
        let polynomials = motion.polynomials();
        let curves: Vec<StudiedPolynomial> = polynomials
            .iter()
            .enumerate()
            .map(|(number, &untrimmed)| StudiedPolynomial::search(Role::from_number(kind, number), untrimmed))
            .collect::<Result<_, _>>()?;
        let answer = PairDecision::for_motion(motion, &curves.iter().collect::<Vec<_>>())?;
        let bounded = formulas::BoundedPairMotion::from(motion);
        let expected = bounded.polynomials();
        let right_approach = match right_approach(&polynomials, &expected) {
            None => None,
            Some(right) => {
                let curve = StudiedPolynomial::search(Role::Approach, right)?;
                let others = curves.iter().take(3).chain([&curve]).collect::<Vec<_>>();
                let answer = PairDecision::for_motion(motion, &others)?;
                Some(RightApproach { curve, answer })
            }
        };
        let certain = certain_decision(&bounded, &expected);
        Ok(Self { motion: *motion, curves, answer, certain_decision: certain, right_approach })
    }

    /// Returns whether a logged polynomial is right by the fair rules: equal except for a positive factor, round-off,
    /// and small leading coefficients.
    pub fn is_right(&self, number: usize, logged: &[f64]) -> bool {
        let expected = formulas::BoundedPairMotion::from(&self.motion).polynomials();
        let own = (number < self.curves.len()).then(|| expected.polynomial(number));
        own.into_iter().chain(expected.other_form(number)).any(|right| compare(right, logged, &[1.0]).is_ok())
    }
}

/// Returns the course's approach polynomial with the right t^3 coefficient, if the two differ.
fn right_approach(polynomials: &[Polynomial], expected: &formulas::ExpectedPolynomials) -> Option<Polynomial> {
    let (course, right) = (expected.polynomial(3), expected.other_form(3)?);
    // The index of the t^3 coefficient of a quintic.
    let cubic = MAX_COEFFICIENTS - 4;
    if course[cubic].value == right[cubic].value {
        return None;
    }
    let mut coefficients = [0.0; MAX_COEFFICIENTS];
    coefficients.copy_from_slice(polynomials[3].coefficients());
    coefficients[cubic] = right[cubic].value;
    Some(Polynomial::untrimmed(&coefficients))
}

/// The motion with bounds. The displacement keeps its value, with the bound of a difference of positions whose end
/// position may deviate by a rounding error.
impl From<PointMotion> for formulas::BoundedPointMotion {
    fn from(point: PointMotion) -> Self {
        let start = BoundedVector::from_exact(point.start);
        let mut shift = BoundedVector::from_rounded(point.start + point.shift) - start;
        (shift.x.value, shift.y.value) = (point.shift.x, point.shift.y);
        Self { start, shift }
    }
}

/// The motion with bounds. End positions may deviate by a rounding error.
impl From<&PairMotion> for formulas::BoundedPairMotion {
    fn from(motion: &PairMotion) -> Self {
        let way = formulas::BoundedPointMotion::from;
        let sum = |radii: [f64; 2]| BoundedValue::from_exact(radii[0]) + BoundedValue::from_exact(radii[1]);
        match *motion {
            PairMotion::Particles { centers, radii } => Self::Particles(centers.map(way), sum(radii)),
            PairMotion::Edge { center, ends, radii } => Self::Edge([center, ends[0], ends[1]].map(way), sum(radii)),
            PairMotion::HalfPlane { center, radius, point, normal } => {
                Self::HalfPlane(way(center), BoundedValue::from_exact(radius), point, normal)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_num::vector::Vec2;

    fn point(x: f64, y: f64, dx: f64, dy: f64) -> PointMotion {
        PointMotion { start: Vec2::new(x, y), shift: Vec2::new(dx, dy) }
    }

    /// Returns the assignment's first worked example.
    fn first_example() -> PairMotion {
        PairMotion::Edge {
            center: point(3.0, 1.0, 4.0, 1.0),
            ends: [point(5.0, 9.0, 2.0, 6.0), point(5.0, 3.0, 5.0, 8.0)],
            radii: [1.0, 1.0],
        }
    }

    #[test]
    fn the_assignments_examples() {
        let study = Study::for_motion(&first_example()).unwrap();
        assert_eq!(study.curves[0].logged.coefficients(), [-361.0, -304.0, -468.0, -288.0, 0.0]);
        assert!(!study.answer.decision.collides());
        let second = PairMotion::Edge {
            center: point(1.0, 4.0, 1.0, 4.0),
            ends: [point(2.0, 1.0, 3.0, 5.0), point(6.0, 2.0, 3.0, 7.0)],
            radii: [1.0, 2.0],
        };
        let study = Study::for_motion(&second).unwrap();
        assert_eq!(study.curves[0].logged.coefficients(), [-16.0, 0.0, -68.0, 36.0, -16.0]);
        assert_eq!(study.curves[0].positive_intervals, []);
        assert_eq!((study.answer.decision.collides(), study.certain_decision), (false, Some(false)));
    }

    /// The intermediate sets lead to the same time as the reference's own search.
    #[test]
    fn the_common_set_begins_at_the_time_of_impact() {
        let motion = PairMotion::Edge {
            center: point(0.0, 1.0, 0.25, -2.0),
            ends: [point(-1.0, 0.0, 0.0, 0.5), point(1.0, 0.0, 0.5, 0.125)],
            radii: [0.125, 0.125],
        };
        let study = Study::for_motion(&motion).unwrap();
        let Decision::Hit { time, normal } = study.answer.decision else { panic!("{:?}", study.answer) };
        assert_eq!(study.answer.positive_intervals[0].lo, time);
        assert_eq!(motion.normal(time), Some(normal));
        assert_eq!(study.certain_decision, Some(true));
        // The edge turns: the right polynomial differs, only in t^3, and the contact is the same.
        let right = study.right_approach.unwrap();
        let (course, right_one) = (study.curves[3].untrimmed, right.curve.untrimmed);
        let differing: Vec<usize> =
            (0..6).filter(|&k| course.coefficients()[k] != right_one.coefficients()[k]).collect();
        assert_eq!(differing, [2]);
        assert_eq!(right.answer.decision.time(), time);
    }

    #[test]
    fn an_edge_that_only_translates_has_no_other_approach() {
        let motion = PairMotion::Edge {
            center: point(0.0, 1.0, 0.0, -0.5),
            ends: [point(-1.0, 0.0, 0.0, 0.5), point(1.0, 0.0, 0.0, 0.5)],
            radii: [0.125, 0.125],
        };
        assert_eq!(Study::for_motion(&motion).unwrap().right_approach, None);
    }

    #[test]
    fn touching_at_the_end_of_the_step_hangs_on_round_off_unless_the_numbers_are_short() {
        let particles = |gap: f64, radius: f64| PairMotion::Particles {
            centers: [point(0.0, 0.0, 0.0, 0.0), point(gap, 0.0, 2.0 * radius - gap, 0.0)],
            radii: [radius; 2],
        };
        assert_eq!(Study::for_motion(&particles(0.7, 0.1)).unwrap().certain_decision, None);
        assert_eq!(Study::for_motion(&particles(0.75, 0.125)).unwrap().certain_decision, Some(true));
    }

    #[test]
    fn numbers_that_overflow_have_no_answer() {
        let PairMotion::Edge { center, ends, radii } = first_example() else { unreachable!() };
        let huge = PointMotion { start: Vec2::new(1e200, 0.0), ..center };
        let refused = Study::for_motion(&PairMotion::Edge { center: huge, ends, radii }).unwrap_err();
        assert_eq!(refused.role, Role::Overlap);
        assert_eq!(refused.to_string(), "the root search of the overlap polynomial does not end");
    }
}
