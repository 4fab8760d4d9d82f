//! The polynomials of correct programs, which compute them like the reference or in another way (collisions.md 2).
use fosssim_model::sim::{PairMotion, PointMotion, formulas};
use fosssim_num::vector::{Vec2, unit};

use super::{
    arithmetic::{self, FusedDouble},
    basis, factorized,
    wide_numbers::WideNumber,
};
use crate::{Mistake, author::Student};

/// Returns the polynomials that must be positive together, highest power first. They are right except for round-off.
pub fn polynomials(student: Student, motion: &PairMotion) -> Vec<Vec<f64>> {
    let mut lists = reference_polynomials(motion);
    if let (true, PairMotion::Edge { center, ends, radii }) = (student.has_right_approach(), motion) {
        lists[3][2] = right_cubic([center, &ends[0], &ends[1]], *radii);
    }
    for variant in student.mistakes() {
        match (variant, motion) {
            (Mistake::ExtendedPrecision, _) => lists = arithmetic::polynomials::<WideNumber>(motion),
            (Mistake::FusedArithmetic, _) => lists = arithmetic::polynomials::<FusedDouble>(motion),
            (Mistake::WideArithmetic, _) => lists[0] = arithmetic::polynomials::<WideNumber>(motion).swap_remove(0),
            // The approach of a particle and an edge is still the supplied one.
            (Mistake::InterpolatedAll, _) => {
                lists.iter_mut().zip(basis::polynomials(motion)).for_each(|(list, own)| *list = own);
            }
            (Mistake::InterpolatedQuartic, PairMotion::Edge { .. }) => {
                lists[0] = basis::polynomials(motion).swap_remove(0)
            }
            (Mistake::RearrangedParticleParticle, PairMotion::Particles { centers, radii }) => {
                lists[0] = rearranged_quadratic(centers, radii[0] + radii[1]);
            }
            (Mistake::RearrangedHalfPlane, PairMotion::HalfPlane { center, radius, point, normal }) => {
                lists[0] = difference_of_squares(center, *radius, *point, *normal);
            }
            (Mistake::HalfPlaneUnitNormal, &PairMotion::HalfPlane { center, radius, point, normal }) => {
                let normal = unit(normal);
                lists = reference_polynomials(&PairMotion::HalfPlane { center, radius, point, normal });
            }
            (variant, &PairMotion::Edge { center, ends: [first, second], radii }) => {
                let (bodies, reach) = (&[center, first, second], radii[0] + radii[1]);
                if variant == Mistake::RearrangedParticleEdge {
                    lists[0] = rearranged_quartic(bodies, reach * reach);
                }
                if matches!(variant, Mistake::FactorizedQuartic | Mistake::FactorizedAll) {
                    lists[0] = factorized::quartic(bodies, reach * reach);
                }
                if matches!(variant, Mistake::QuinticRight | Mistake::FactorizedAll) {
                    lists[3] = factorized::quintic(bodies);
                }
                if variant == Mistake::FactorizedAll {
                    lists[2] = factorized::alpha_below_one(bodies);
                }
            }
            _ => {}
        }
    }
    lists
}

fn reference_polynomials(motion: &PairMotion) -> Vec<Vec<f64>> {
    motion.polynomials().iter().map(|list| list.coefficients().to_vec()).collect()
}

/// Returns the cubic coefficient of the particle-edge approach without the slip in the course's formula.
fn right_cubic([one, two, three]: [&PointMotion; 3], radii: [f64; 2]) -> f64 {
    let [x2, d2, x3, d3] = [two.start, two.shift, three.start, three.shift].map(Into::into);
    let edge = formulas::EdgeMotions::new(x2, d2, x3, d3);
    formulas::particle_edge_and_right_cubic(one.start.into(), one.shift.into(), &edge, radii[0] + radii[1]).1
}

/// Returns the overlap of two particles, with each dot product expanded into coordinates and added up in another order.
fn rearranged_quadratic([one, two]: &[PointMotion; 2], reach: f64) -> Vec<f64> {
    let (x1, x2, d1, d2) = (one.start, two.start, one.shift, two.shift);
    let (dx, dy) = (d2.x - d1.x, d2.y - d1.y);
    let (px, py) = (x1.x - x2.x, x1.y - x2.y);
    vec![-(dy * dy + dx * dx), 2.0 * px * dx + 2.0 * py * dy, (reach * reach - px * px) - py * py]
}

/// Returns the overlap of a particle and a half-plane as a difference of squares.
fn difference_of_squares(one: &PointMotion, radius: f64, point: Vec2, normal: Vec2) -> Vec<f64> {
    let (s, w) = (one.shift.dot(&normal), (point - one.start).dot(&normal));
    let reach = radius * normal.dot(&normal).sqrt();
    vec![-(s * s), s * w + w * s, (reach - w) * (reach + w)]
}

/// Returns the overlap of a particle and an edge, with its sums associated differently. The letters are those of the
/// assignment's derivation.
fn rearranged_quartic([one, two, three]: &[PointMotion; 3], s: f64) -> Vec<f64> {
    let (x12, x32, d12, d32) =
        (one.start - two.start, three.start - two.start, one.shift - two.shift, three.shift - two.shift);
    let (a, b, c) = (x12.dot(&x32), x12.dot(&d32) + d12.dot(&x32), d12.dot(&d32));
    let (d, e, f) = (x12.dot(&x12), d12.dot(&x12), d12.dot(&d12));
    let (g, h, i) = (x32.dot(&x32), d32.dot(&x32), d32.dot(&d32));
    vec![
        c * c - i * f,
        2.0 * (b * c - (e * i + h * f)),
        (s - d) * i + (2.0 * (a * c) + b * b) - (g * f + 4.0 * (h * e)),
        2.0 * ((a * b - e * g) + (s - d) * h),
        (s - d) * g + a * a,
    ]
}

#[cfg(test)]
mod tests {
    use super::{super::contact_vector, *};

    fn body(start: [f64; 2], shift: [f64; 2]) -> PointMotion {
        PointMotion { start: start.into(), shift: shift.into() }
    }

    /// Returns a particle and an edge that turns and stretches. The coordinates are integers, so that every order of
    /// evaluation is exact.
    fn turning() -> PairMotion {
        let ends = [body([0.0, 1.0], [2.0, 4.0]), body([6.0, 3.0], [-1.0, 2.0])];
        PairMotion::Edge { center: body([2.0, 5.0], [3.0, -7.0]), ends, radii: [1.0, 2.0] }
    }

    fn lists(mistake: Option<Mistake>) -> Vec<Vec<f64>> {
        polynomials(Student::new(mistake), &turning())
    }

    #[test]
    fn the_quartic_is_positive_where_the_particle_overlaps_the_line() {
        let quartic = &lists(None)[0];
        for t in [0.0, 0.25, 0.5, 1.0, 2.0] {
            let value = quartic.iter().fold(0.0, |value, coefficient| value * t + coefficient);
            let n = contact_vector(Student::default(), &turning(), t);
            assert_eq!(value > 0.0, n.dot(&n) < 9.0, "t = {t}: {value} and {n:?}");
        }
    }

    #[test]
    fn every_correct_variant_has_the_same_quartic_where_nothing_is_rounded() {
        let correct = &lists(None)[0];
        for variant in [
            Mistake::RearrangedParticleEdge,
            Mistake::FactorizedQuartic,
            Mistake::FactorizedAll,
            Mistake::WideArithmetic,
            Mistake::ExtendedPrecision,
            Mistake::FusedArithmetic,
        ] {
            assert_eq!(&lists(Some(variant))[0], correct, "{variant:?}");
        }
        let interpolated = &lists(Some(Mistake::InterpolatedQuartic))[0];
        assert!(interpolated.iter().zip(correct).all(|(ours, right)| (ours - right).abs() < 1e-9));
    }

    #[test]
    fn other_arithmetic_has_the_same_four_polynomials_where_nothing_is_rounded() {
        let correct = lists(None);
        for variant in [Mistake::ExtendedPrecision, Mistake::FusedArithmetic] {
            assert_eq!(lists(Some(variant)), correct, "{variant:?}");
        }
        let interpolated = lists(Some(Mistake::InterpolatedAll));
        let close = |(ours, right): (&f64, &f64)| (ours - right).abs() < 1e-9;
        assert!(interpolated.iter().flatten().zip(correct.iter().flatten()).all(close), "{interpolated:?}");
    }

    #[test]
    fn the_supplied_quintic_is_wrong_in_its_cubic_coefficient_only() {
        let supplied = &lists(None)[3];
        let right = &lists(Some(Mistake::QuinticRight))[3];
        let differing: Vec<usize> = (0..6).filter(|&index| supplied[index] != right[index]).collect();
        assert_eq!(differing, [2], "{supplied:?} and {right:?}");
        assert_eq!(&lists(Some(Mistake::QuinticRightRearranged))[3], right);
    }
}
