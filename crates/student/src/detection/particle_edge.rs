//! A particle and an edge (collisions.md 2): it overlaps the infinite line, between the endpoints, and approaches.
use fosssim_num::vector::Vec2;

use super::{
    VECTORS,
    arithmetic::{self, FusedDouble},
    basis, factorized, quintic,
    wide::WideNumber,
};
use crate::{
    Area, Mistake,
    author::Student,
    encounter::{MovingBody, alpha},
};

/// The parts of the assignment whose mistakes are made in the polynomials.
const FORMULAS: &[Area] = &[Area::ParticleEdge, Area::Handover, Area::ContactVector];

/// Returns the overlap (quartic), alpha > 0 (quadratic), alpha < 1 (quadratic), approach (quintic).
pub fn polynomials(student: Student, bodies: &[MovingBody; 3], edge_radius: f64) -> Vec<Vec<f64>> {
    let mistake = student.mistake_in(FORMULAS);
    match mistake {
        Some(Mistake::ParticleEdgeEmpty) => return Vec::new(),
        Some(Mistake::ParticleEdgeZero) => {
            return vec![vec![0.0; 5], vec![0.0; 3], vec![0.0; 3], quintic::approach(student, bodies)];
        }
        Some(Mistake::ExtendedPrecision) => return arithmetic::particle_edge::<WideNumber>(bodies, edge_radius),
        Some(Mistake::FusedArithmetic) => return arithmetic::particle_edge::<FusedDouble>(bodies, edge_radius),
        Some(Mistake::InterpolatedAll) => {
            let reach = bodies[0].radius + edge_radius;
            let mut lists = basis::particle_edge(bodies, reach * reach).to_vec();
            lists.push(quintic::approach(student, bodies));
            return lists;
        }
        _ => {}
    }
    let bodies = &seen(student, bodies);
    let square = reach_squared(student, bodies[0].radius, edge_radius);
    let dots = dot_products(bodies);
    let overlap = match mistake {
        Some(Mistake::WideArithmetic) => arithmetic::particle_edge::<WideNumber>(bodies, edge_radius).swap_remove(0),
        Some(Mistake::FactorizedQuartic | Mistake::FactorizedAll) => factorized::quartic(bodies, square),
        Some(Mistake::InterpolatedQuartic) => basis::overlap_from_values(bodies, square),
        Some(Mistake::RearrangedParticleEdge) => rearrange(dots, square),
        _ => quartic(student, dots, square),
    };
    vec![
        overlap,
        alpha_above_zero(student, bodies, dots),
        alpha_below_one(student, bodies, dots),
        quintic::approach(student, bodies),
    ]
}

/// Returns the moving points as this student puts them into the formulas.
fn seen(student: Student, bodies: &[MovingBody; 3]) -> [MovingBody; 3] {
    let [mut one, mut two, mut three] = *bodies;
    match student.mistake_in(FORMULAS) {
        Some(Mistake::ParticleEdgeStill) => {
            two.displacement = Vec2::zeros();
            three.displacement = Vec2::zeros();
        }
        Some(Mistake::ParticleEdgeParticleStill) => one.displacement = Vec2::zeros(),
        Some(Mistake::ParticleEdgeFirstEndStill) => two.displacement = Vec2::zeros(),
        Some(Mistake::ParticleEdgeSecondEndStill) => three.displacement = Vec2::zeros(),
        Some(Mistake::ParticleEdgeOneDisplacement) => three.displacement = two.displacement,
        Some(Mistake::ParticleEdgeOtherDisplacement) => two.displacement = three.displacement,
        Some(Mistake::ParticleEdgeEndForDisplacement) => {
            return bodies.map(|body| MovingBody { displacement: body.end(), ..body });
        }
        Some(Mistake::ParticleEdgeDisplacementsSwapped) => {
            std::mem::swap(&mut two.displacement, &mut three.displacement);
        }
        Some(Mistake::ParticleEdgeEndPositions) => {
            return bodies.map(|body| MovingBody { start: body.end(), ..body });
        }
        Some(Mistake::ParticleEdgeEndpointsSwapped) => std::mem::swap(&mut two, &mut three),
        _ => {}
    }
    [one, two, three]
}

fn reach_squared(student: Student, particle: f64, edge: f64) -> f64 {
    let reach = particle + edge;
    match student.mistake_in(FORMULAS) {
        Some(Mistake::ParticleEdgeRadiiSquaredApart) => particle * particle + edge * edge,
        Some(Mistake::ParticleEdgeRadiusNotSquared) => reach,
        Some(Mistake::ParticleEdgeParticleRadiusTwice) => 4.0 * (particle * particle),
        Some(Mistake::ParticleEdgeEdgeRadiusTwice) => 4.0 * (edge * edge),
        Some(Mistake::ParticleEdgeDiameters) => 4.0 * (reach * reach),
        Some(Mistake::ParticleEdgeNoEdgeRadius) => particle * particle,
        Some(Mistake::ParticleEdgeNoParticleRadius) => edge * edge,
        _ => reach * reach,
    }
}

/// The dot products of the quartic, of a particle (1) and an edge (2, 3): the letters `a` to `i` of the derivation.
type DotProducts = [f64; 9];

fn dot_products([one, two, three]: &[MovingBody; 3]) -> DotProducts {
    let (x12, x32, x21) = (one.start - two.start, three.start - two.start, two.start - one.start);
    let d12 = one.displacement - two.displacement;
    let d32 = three.displacement - two.displacement;
    let d21 = two.displacement - one.displacement;
    let (a, b, c) = (x12.dot(&x32), x12.dot(&d32) + d12.dot(&x32), d12.dot(&d32));
    let (d, e, f) = (x21.dot(&x21), d21.dot(&x21), d21.dot(&d21));
    let (g, h, i) = (x32.dot(&x32), d32.dot(&x32), d32.dot(&d32));
    [a, b, c, d, e, f, g, h, i]
}

/// Returns the overlap with the line: `(r1 + re)^2 |x32|^2 - |x21|^2 |x32|^2 + (x12.x32)^2` along the motion.
fn quartic(student: Student, [a, b, c, d, e, f, g, h, i]: DotProducts, s: f64) -> Vec<f64> {
    let mistake = student.mistake_in(FORMULAS);
    let t4 = match mistake {
        Some(Mistake::ParticleEdgeQuarticNoFi) => c * c,
        Some(Mistake::ParticleEdgeQuarticPlusFi) => c * c + f * i,
        _ => c * c - f * i,
    };
    let t3 = match mistake {
        Some(Mistake::ParticleEdgeNoCubic) => 0.0,
        Some(Mistake::ParticleEdgeCubicOneBc) => b * c - 2.0 * e * i - 2.0 * f * h,
        Some(Mistake::ParticleEdgeCubicOneEi) => 2.0 * b * c - e * i - 2.0 * f * h,
        Some(Mistake::ParticleEdgeCubicNoFh) => 2.0 * b * c - 2.0 * e * i,
        Some(Mistake::ParticleEdgeCubicParentheses) => 2.0 * b * c - 2.0 * e * i + 2.0 * f * h,
        _ => 2.0 * b * c - 2.0 * e * i - 2.0 * f * h,
    };
    let t2 = match mistake {
        Some(Mistake::ParticleEdgeSquareNoEh) => 2.0 * c * a + b * b - d * i - f * g + s * i,
        Some(Mistake::ParticleEdgeSquareTwoEh) => 2.0 * c * a + b * b - d * i - f * g - 2.0 * e * h + s * i,
        Some(Mistake::ParticleEdgeSquareNoBb) => 2.0 * c * a - d * i - f * g - 4.0 * e * h + s * i,
        Some(Mistake::ParticleEdgeSquareOneCa) => c * a + b * b - d * i - f * g - 4.0 * e * h + s * i,
        Some(Mistake::ParticleEdgeSquareNoDi) => 2.0 * c * a + b * b - f * g - 4.0 * e * h + s * i,
        Some(Mistake::ParticleEdgeSquarePlusFg) => 2.0 * c * a + b * b - d * i + f * g - 4.0 * e * h + s * i,
        Some(Mistake::ParticleEdgeSquareRadiusTwice) => 2.0 * c * a + b * b - d * i - f * g - 4.0 * e * h + 2.0 * s * i,
        Some(Mistake::ParticleEdgeRadiusUnscaled) => 2.0 * c * a + b * b - d * i - f * g - 4.0 * e * h,
        _ => 2.0 * c * a + b * b - d * i - f * g - 4.0 * e * h + s * i,
    };
    let t1 = match mistake {
        Some(Mistake::ParticleEdgeLinearOneAb) => a * b - 2.0 * d * h - 2.0 * e * g + 2.0 * s * h,
        Some(Mistake::ParticleEdgeLinearNoDh) => 2.0 * a * b - 2.0 * e * g + 2.0 * s * h,
        Some(Mistake::ParticleEdgeLinearNoEg) => 2.0 * a * b - 2.0 * d * h + 2.0 * s * h,
        Some(Mistake::ParticleEdgeLinearOneSh) => 2.0 * a * b - 2.0 * d * h - 2.0 * e * g + s * h,
        Some(Mistake::ParticleEdgeLinearMinusSh) => 2.0 * a * b - 2.0 * d * h - 2.0 * e * g - 2.0 * s * h,
        Some(Mistake::ParticleEdgeRadiusUnscaled) => 2.0 * a * b - 2.0 * d * h - 2.0 * e * g,
        _ => 2.0 * a * b - 2.0 * d * h - 2.0 * e * g + 2.0 * s * h,
    };
    let t0 = match mistake {
        Some(Mistake::ParticleEdgeConstantNoDg) => a * a + s * g,
        Some(Mistake::ParticleEdgeConstantMinusAa) => -a * a - d * g + s * g,
        Some(Mistake::ParticleEdgeRadiusUnscaled) => a * a - d * g + s,
        _ => a * a - d * g + s * g,
    };
    match mistake {
        Some(Mistake::ParticleEdgeThreeTerms) => vec![t2, t1, t0],
        Some(Mistake::ParticleEdgeQuarticNegated) => vec![-t4, -t3, -t2, -t1, -t0],
        _ => vec![t4, t3, t2, t1, t0],
    }
}

/// Returns the quartic with other parentheses.
fn rearrange([a, b, c, d, e, f, g, h, i]: DotProducts, s: f64) -> Vec<f64> {
    vec![
        c * c - i * f,
        2.0 * (b * c - (e * i + h * f)),
        (s - d) * i + (2.0 * (a * c) + b * b) - (g * f + 4.0 * (h * e)),
        2.0 * ((a * b - e * g) + (s - d) * h),
        (s - d) * g + a * a,
    ]
}

fn alpha_above_zero(student: Student, bodies: &[MovingBody; 3], dots: DotProducts) -> Vec<f64> {
    let [a, b, c, ..] = dots;
    match student.mistake_in(FORMULAS) {
        Some(Mistake::AlphaLowSlopeSign) => vec![c, -b, a],
        Some(Mistake::AlphaLowNegated) => vec![-c, -b, -a],
        Some(Mistake::AlphaLowNoQuadratic) => vec![b, a],
        Some(Mistake::AlphaLowHalfSlope) => {
            let [one, two, three] = bodies;
            vec![c, (one.displacement - two.displacement).dot(&(three.start - two.start)), a]
        }
        Some(Mistake::AlphaLowIsHigh) => alpha_below_one(student, bodies, dots),
        Some(Mistake::AlphaLowAtStart) => vec![a],
        Some(Mistake::AlphaLowMissing) => vec![1.0],
        _ => vec![c, b, a],
    }
}

fn alpha_below_one(student: Student, bodies: &[MovingBody; 3], dots: DotProducts) -> Vec<f64> {
    let [a, b, c, _, _, _, g, h, i] = dots;
    let [one, two, three] = bodies;
    let (x13, x23) = (one.start - three.start, two.start - three.start);
    let d13 = one.displacement - three.displacement;
    let d23 = two.displacement - three.displacement;
    match student.mistake_in(FORMULAS) {
        Some(Mistake::AlphaHighIsLow) => vec![c, b, a],
        Some(Mistake::AlphaHighUnscaled) => vec![-c, -b, 1.0 - a],
        Some(Mistake::AlphaHighNegated) => vec![-d13.dot(&d23), -(d13.dot(&x23) + x13.dot(&d23)), -x13.dot(&x23)],
        Some(Mistake::AlphaHighSlopeSign) => vec![d13.dot(&d23), -(d13.dot(&x23) + x13.dot(&d23)), x13.dot(&x23)],
        Some(Mistake::AlphaHighNoQuadratic) => vec![d13.dot(&x23) + x13.dot(&d23), x13.dot(&x23)],
        Some(Mistake::AlphaHighHalfSlope) => vec![d13.dot(&d23), x13.dot(&d23), x13.dot(&x23)],
        Some(Mistake::AlphaHighAtStart) => vec![x13.dot(&x23)],
        Some(Mistake::AlphaHighMissing) => vec![1.0],
        Some(Mistake::FactorizedAll) => vec![i - c, 2.0 * h - b, g - a],
        _ => vec![d13.dot(&d23), d13.dot(&x23) + x13.dot(&d23), x13.dot(&x23)],
    }
}

/// Returns the vector from the particle to the closest point of the line at time `t`.
pub fn contact_vector(student: Student, bodies: &[MovingBody; 3], t: f64) -> Vec2 {
    let mistake = student.mistake_in(VECTORS);
    let held = |body: MovingBody| MovingBody { start: body.end(), displacement: Vec2::zeros(), ..body };
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
    let along = three.start + t * three.displacement - two.start - t * two.displacement;
    let alpha = match mistake {
        Some(Mistake::ParticleEdgeContactAlphaAtStart) => alpha(bodies, 0.0),
        Some(Mistake::ParticleEdgeContactAlphaAtEnd) => alpha(bodies, 1.0),
        Some(Mistake::ParticleEdgeContactAlphaMiddle) => 0.5,
        Some(Mistake::ParticleEdgeContactFromOtherEnd) => 1.0 - alpha(bodies, t),
        Some(Mistake::ParticleEdgeContactNearestEnd) => f64::from(u8::from(alpha(bodies, t) > 0.5)),
        Some(Mistake::ParticleEdgeContactClamped) => alpha(bodies, t).clamp(0.0, 1.0),
        Some(Mistake::ParticleEdgeContactFirstEnd) => 0.0,
        Some(Mistake::ParticleEdgeContactSecondEnd) => 1.0,
        _ => alpha(bodies, t),
    };
    match mistake {
        Some(Mistake::ParticleEdgeContactReversed) => -(two.at(t) + alpha * along - one.start - t * one.displacement),
        Some(Mistake::ParticleEdgeContactParticleStill) => two.at(t) + alpha * along - one.start,
        Some(Mistake::ParticleEdgeContactEdgeStill) => {
            two.start + alpha * (three.start - two.start) - one.start - t * one.displacement
        }
        Some(Mistake::ExtendedPrecision) => arithmetic::vector_to_edge::<WideNumber>(bodies, t),
        Some(Mistake::FusedArithmetic) => arithmetic::vector_to_edge::<FusedDouble>(bodies, t),
        Some(Mistake::ContactOtherFormula) => {
            let across = Vec2::new(-along.y, along.x);
            (two.at(t) - one.at(t)).dot(&across) / along.dot(&along) * across
        }
        _ => two.at(t) + alpha * along - one.start - t * one.displacement,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(start: [f64; 2], displacement: [f64; 2], radius: f64) -> MovingBody {
        MovingBody { start: start.into(), displacement: displacement.into(), radius }
    }

    /// Returns integers, so that every order of evaluation is exact: an edge that turns and stretches.
    fn turning() -> [MovingBody; 3] {
        [body([2.0, 5.0], [3.0, -7.0], 1.0), body([0.0, 1.0], [2.0, 4.0], 2.0), body([6.0, 3.0], [-1.0, 2.0], 2.0)]
    }

    fn lists(mistake: Option<Mistake>) -> Vec<Vec<f64>> {
        polynomials(Student::new(mistake), &turning(), 2.0)
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
