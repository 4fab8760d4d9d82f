//! A particle and a half-plane with point P and normal Q (collisions.md 2): it overlaps the boundary, and approaches.
use fosssim_num::vector::{Vec2, unit};

use super::{
    MovingBody, VECTORS,
    arithmetic::{self, FusedDouble},
    basis,
    wide::WideNumber,
};
use crate::{Area, Mistake, author::Student};

/// The parts of the assignment whose mistakes are made in the polynomials.
const FORMULAS: &[Area] = &[Area::ParticleHalfPlane, Area::Handover, Area::ContactVector];

/// Returns the overlap (quadratic) and approach (linear).
pub fn polynomials(student: Student, one: &MovingBody, point: Vec2, normal: Vec2) -> Vec<Vec<f64>> {
    let mistake = student.mistake_in(FORMULAS);
    let q = if mistake == Some(Mistake::HalfPlaneUnitNormal) { unit(normal) } else { normal };
    let s = match mistake {
        Some(Mistake::HalfPlaneEndForDisplacement) => one.end().dot(&q),
        _ => one.displacement.dot(&q),
    };
    let w = match mistake {
        Some(Mistake::HalfPlaneEmpty) => return Vec::new(),
        Some(Mistake::HalfPlaneZero) => return vec![vec![0.0; 3], vec![0.0; 2]],
        Some(Mistake::ExtendedPrecision) => return arithmetic::particle_half_plane::<WideNumber>(one, point, normal),
        Some(Mistake::FusedArithmetic) => return arithmetic::particle_half_plane::<FusedDouble>(one, point, normal),
        Some(Mistake::InterpolatedAll) => return basis::particle_half_plane(one, point, normal),
        Some(Mistake::HalfPlaneNoPoint) => (-one.start).dot(&q),
        Some(Mistake::HalfPlaneEndPosition) => (point - one.end()).dot(&q),
        Some(Mistake::HalfPlaneReversedOffset) => (one.start - point).dot(&q),
        _ => (point - one.start).dot(&q),
    };
    let overlap = match mistake {
        Some(Mistake::WideArithmetic) => {
            arithmetic::particle_half_plane::<WideNumber>(one, point, normal).swap_remove(0)
        }
        Some(Mistake::RearrangedHalfPlane) => rearranged_overlap(one, s, w, q),
        Some(Mistake::HalfPlaneOverlapSigned) => vec![-s, one.radius * q.dot(&q).sqrt() + w],
        _ => overlap(student, one.radius, s, w, q),
    };
    vec![overlap, approach(student, s, w)]
}

fn overlap(student: Student, radius: f64, s: f64, w: f64, q: Vec2) -> Vec<f64> {
    let mistake = student.mistake_in(FORMULAS);
    let square = match mistake {
        Some(Mistake::HalfPlaneRadiusNotSquared) => radius,
        Some(Mistake::HalfPlaneNoRadius) => 0.0,
        Some(Mistake::HalfPlaneDiameter) => 4.0 * (radius * radius),
        _ => radius * radius,
    };
    let reach = match mistake {
        Some(Mistake::HalfPlaneNoNormalSquare) => square,
        Some(Mistake::HalfPlaneNormalLength) => square * q.dot(&q).sqrt(),
        _ => square * q.dot(&q),
    };
    let t2 = match mistake {
        Some(Mistake::HalfPlaneQuadraticSign) => s * s,
        Some(Mistake::HalfPlaneNoQuadratic) => 0.0,
        _ => -s * s,
    };
    let t1 = match mistake {
        Some(Mistake::HalfPlaneNoTwo) => w * s,
        Some(Mistake::HalfPlaneLinearSign) => -2.0 * w * s,
        _ => 2.0 * w * s,
    };
    let t0 = match mistake {
        Some(Mistake::HalfPlaneConstantSign) => w * w + reach,
        Some(Mistake::HalfPlaneOffsetNotSquared) => -w + reach,
        _ => -w * w + reach,
    };
    if mistake == Some(Mistake::HalfPlaneOverlapNegated) {
        return vec![-t2, -t1, -t0];
    }
    vec![t2, t1, t0]
}

/// Returns the quadratic as a difference of squares.
fn rearranged_overlap(one: &MovingBody, s: f64, w: f64, q: Vec2) -> Vec<f64> {
    let length = q.dot(&q).sqrt();
    let reach = one.radius * length;
    vec![-(s * s), s * w + w * s, (reach - w) * (reach + w)]
}

fn approach(student: Student, s: f64, w: f64) -> Vec<f64> {
    match student.mistake_in(FORMULAS) {
        Some(Mistake::HalfPlaneApproachNoSpeed) => vec![-s, w],
        Some(Mistake::HalfPlaneApproachNegated) => vec![s * s, -w * s],
        Some(Mistake::HalfPlaneApproachSlopeSign) => vec![s * s, w * s],
        Some(Mistake::HalfPlaneApproachSlopeTwice) => vec![-2.0 * s * s, w * s],
        Some(Mistake::HalfPlaneApproachAtStart) => vec![w * s],
        Some(Mistake::HalfPlaneApproachConstantNoSpeed) => vec![-s * s, w],
        Some(Mistake::HalfPlaneApproachSpeedOnly) => vec![s],
        Some(Mistake::HalfPlaneApproachClosingOnly) => vec![-s],
        Some(Mistake::HalfPlaneNoApproach) => vec![1.0],
        _ => vec![-s * s, w * s],
    }
}

/// Returns the vector from the center to the boundary at time `t`.
pub fn contact_vector(student: Student, one: &MovingBody, point: Vec2, normal: Vec2, t: f64) -> Vec2 {
    let offset = point - one.start - t * one.displacement;
    let square = normal.dot(&normal);
    match student.mistake_in(VECTORS) {
        Some(Mistake::HalfPlaneContactUndivided) => offset.dot(&normal) * normal,
        Some(Mistake::HalfPlaneContactDividedByLength) => offset.dot(&normal) / square.sqrt() * normal,
        Some(Mistake::HalfPlaneContactIsNormal) => normal,
        Some(Mistake::HalfPlaneContactReversed) => -(offset.dot(&normal) / square * normal),
        Some(Mistake::HalfPlaneContactAtStart) => (point - one.start).dot(&normal) / square * normal,
        Some(Mistake::HalfPlaneContactAtEnd) => (point - one.end()).dot(&normal) / square * normal,
        Some(Mistake::HalfPlaneContactToPoint) => offset,
        Some(Mistake::HalfPlaneUnitNormal | Mistake::ContactOtherFormula) => {
            let u = unit(normal);
            (point - one.at(t)).dot(&u) * u
        }
        Some(Mistake::ExtendedPrecision) => arithmetic::to_half_plane::<WideNumber>(one, point, normal, t),
        Some(Mistake::FusedArithmetic) => arithmetic::to_half_plane::<FusedDouble>(one, point, normal, t),
        _ => offset.dot(&normal) / square * normal,
    }
}
