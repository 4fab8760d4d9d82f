//! A particle and an edge (collisions.md 2): the particle overlaps the infinite line, is between the endpoints, and
//! approaches.
use fosssim_model::sim::PointMotion;
use fosssim_num::vector::{Vec2, length};

use super::{
    VECTOR_AREAS,
    arithmetic::{self, FusedDouble},
    basis, factorized, quintic,
    wide_numbers::WideNumber,
};
use crate::{Area, Mistake, author::Student};

/// The areas whose variants are made in the polynomials.
const FORMULA_AREAS: &[Area] = &[Area::ParticleEdge, Area::Handover, Area::ContactVector];

/// Returns the overlap (quartic), alpha > 0 (quadratic), alpha < 1 (quadratic) and approach (quintic), right except for
/// round-off.
pub fn polynomials(student: Student, bodies: &[PointMotion; 3], radii: [f64; 2]) -> Vec<Vec<f64>> {
    let variant = student.mistake_in(FORMULA_AREAS);
    let reach = radii[0] + radii[1];
    let square = reach * reach;
    match variant {
        Some(Mistake::ExtendedPrecision) => return arithmetic::particle_edge::<WideNumber>(bodies, radii),
        Some(Mistake::FusedArithmetic) => return arithmetic::particle_edge::<FusedDouble>(bodies, radii),
        Some(Mistake::InterpolatedAll) => {
            let mut lists = basis::particle_edge(bodies, square).to_vec();
            lists.push(quintic::approach(student, bodies));
            return lists;
        }
        _ => {}
    }
    let dots = dot_products(bodies);
    let overlap = match variant {
        Some(Mistake::WideArithmetic) => arithmetic::particle_edge::<WideNumber>(bodies, radii).swap_remove(0),
        Some(Mistake::FactorizedQuartic | Mistake::FactorizedAll) => factorized::quartic(bodies, square),
        Some(Mistake::InterpolatedQuartic) => basis::overlap_from_values(bodies, square),
        Some(Mistake::RearrangedParticleEdge) => rearranged_quartic(dots, square),
        _ => quartic(dots, square),
    };
    let [a, b, c, _, _, _, g, h, i] = dots;
    let alpha_below_one = match variant {
        Some(Mistake::FactorizedAll) => vec![i - c, 2.0 * h - b, g - a],
        _ => alpha_below_one(bodies),
    };
    vec![overlap, vec![c, b, a], alpha_below_one, quintic::approach(student, bodies)]
}

/// The dot products of the quartic, of a particle (1) and an edge (2, 3): the letters `a` to `i` of the derivation.
type DotProducts = [f64; 9];

fn dot_products([one, two, three]: &[PointMotion; 3]) -> DotProducts {
    let (x12, x32, x21) = (one.start - two.start, three.start - two.start, two.start - one.start);
    let d12 = one.shift - two.shift;
    let d32 = three.shift - two.shift;
    let d21 = two.shift - one.shift;
    let (a, b, c) = (x12.dot(&x32), x12.dot(&d32) + d12.dot(&x32), d12.dot(&d32));
    let (d, e, f) = (x21.dot(&x21), d21.dot(&x21), d21.dot(&d21));
    let (g, h, i) = (x32.dot(&x32), d32.dot(&x32), d32.dot(&d32));
    [a, b, c, d, e, f, g, h, i]
}

/// Returns the overlap with the line: `(r1 + re)^2 |x32|^2 - |x21|^2 |x32|^2 + (x12.x32)^2` along the motion.
fn quartic([a, b, c, d, e, f, g, h, i]: DotProducts, s: f64) -> Vec<f64> {
    vec![
        c * c - f * i,
        2.0 * b * c - 2.0 * e * i - 2.0 * f * h,
        2.0 * c * a + b * b - d * i - f * g - 4.0 * e * h + s * i,
        2.0 * a * b - 2.0 * d * h - 2.0 * e * g + 2.0 * s * h,
        a * a - d * g + s * g,
    ]
}

/// Returns the quartic, with its sums associated differently.
fn rearranged_quartic([a, b, c, d, e, f, g, h, i]: DotProducts, s: f64) -> Vec<f64> {
    vec![
        c * c - i * f,
        2.0 * (b * c - (e * i + h * f)),
        (s - d) * i + (2.0 * (a * c) + b * b) - (g * f + 4.0 * (h * e)),
        2.0 * ((a * b - e * g) + (s - d) * h),
        (s - d) * g + a * a,
    ]
}

fn alpha_below_one([one, two, three]: &[PointMotion; 3]) -> Vec<f64> {
    let (x13, x23) = (one.start - three.start, two.start - three.start);
    let d13 = one.shift - three.shift;
    let d23 = two.shift - three.shift;
    vec![d13.dot(&d23), d13.dot(&x23) + x13.dot(&d23), x13.dot(&x23)]
}

/// Returns the parameter of the closest point on the infinite line at time `t`: 0 at the first endpoint, 1 at the
/// second.
pub fn alpha([one, two, three]: &[PointMotion; 3], t: f64) -> f64 {
    let to_particle = one.start + t * one.shift - two.start - t * two.shift;
    let along = three.start + t * three.shift - two.start - t * two.shift;
    to_particle.dot(&along) / along.dot(&along)
}

/// Returns the vector from the particle to the closest point of the line at time `t`.
pub fn contact_vector(student: Student, bodies: &[PointMotion; 3], t: f64) -> Vec2 {
    let mistake = student.mistake_in(VECTOR_AREAS);
    let held = |body: PointMotion| PointMotion { start: body.position_at(1.0), shift: Vec2::zeros() };
    let [mut one, mut two, mut three] = *bodies;
    match mistake {
        Some(Mistake::ParticleEdgeContactParticleAtEnd) => one = held(one),
        Some(Mistake::ParticleEdgeContactEdgeAtEnd) => (two, three) = (held(two), held(three)),
        _ => {}
    }
    let bodies = &[one, two, three];
    let t = match mistake {
        Some(Mistake::ParticleEdgeContactAtStart) => 0.0,
        Some(Mistake::ParticleEdgeContactAtEnd) => 1.0,
        _ => t,
    };
    let along = three.start + t * three.shift - two.start - t * two.shift;
    let alpha = match mistake {
        Some(Mistake::ParticleEdgeContactAlphaAtStart) => alpha(bodies, 0.0),
        Some(Mistake::ParticleEdgeContactAlphaAtEnd) => alpha(bodies, 1.0),
        Some(Mistake::ParticleEdgeContactAlphaMiddle) => 0.5,
        Some(Mistake::ParticleEdgeContactAlphaOverLength) => alpha(bodies, t) * length(along),
        Some(Mistake::ParticleEdgeContactFromOtherEnd) => 1.0 - alpha(bodies, t),
        Some(Mistake::ParticleEdgeContactNearestEnd) => f64::from(u8::from(alpha(bodies, t) > 0.5)),
        Some(Mistake::ParticleEdgeContactClamped) => alpha(bodies, t).clamp(0.0, 1.0),
        Some(Mistake::ParticleEdgeContactFirstEnd) => 0.0,
        Some(Mistake::ParticleEdgeContactSecondEnd) => 1.0,
        _ => alpha(bodies, t),
    };
    match mistake {
        Some(Mistake::ParticleEdgeContactReversed) => -(two.position_at(t) + alpha * along - one.start - t * one.shift),
        Some(Mistake::ParticleEdgeContactParticleStill) => two.position_at(t) + alpha * along - one.start,
        Some(Mistake::ParticleEdgeContactParticleAdded) => two.position_at(t) + alpha * along - one.position_at(-t),
        Some(Mistake::ParticleEdgeContactAlphaTimesEnd) => {
            two.position_at(t) + alpha * three.position_at(t) - one.position_at(t)
        }
        Some(Mistake::ParticleEdgeContactEdgeStill) => {
            two.start + alpha * (three.start - two.start) - one.start - t * one.shift
        }
        Some(Mistake::ExtendedPrecision) => arithmetic::vector_to_edge::<WideNumber>(bodies, t),
        Some(Mistake::FusedArithmetic) => arithmetic::vector_to_edge::<FusedDouble>(bodies, t),
        Some(Mistake::ContactOtherFormula) => {
            let across = Vec2::new(-along.y, along.x);
            (two.position_at(t) - one.position_at(t)).dot(&across) / along.dot(&along) * across
        }
        _ => two.position_at(t) + alpha * along - one.start - t * one.shift,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(start: [f64; 2], shift: [f64; 2]) -> PointMotion {
        PointMotion { start: start.into(), shift: shift.into() }
    }

    /// Returns a turning and stretching edge with integer coordinates, so that every order of evaluation is exact.
    fn turning() -> [PointMotion; 3] {
        [body([2.0, 5.0], [3.0, -7.0]), body([0.0, 1.0], [2.0, 4.0]), body([6.0, 3.0], [-1.0, 2.0])]
    }

    fn lists(mistake: Option<Mistake>) -> Vec<Vec<f64>> {
        polynomials(Student::new(mistake), &turning(), [1.0, 2.0])
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
