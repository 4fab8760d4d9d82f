//! A particle and a half-plane with point P and normal Q (collisions.md 2): the particle overlaps the boundary, and
//! approaches it.
use fosssim_model::sim::PointMotion;
use fosssim_num::vector::{Vec2, unit};

use super::{
    VECTOR_AREAS,
    arithmetic::{self, FusedDouble},
    basis,
    wide_numbers::WideNumber,
};
use crate::{Area, Mistake, author::Student};

/// The areas whose variants are made in the polynomials.
const FORMULA_AREAS: &[Area] = &[Area::ParticleHalfPlane, Area::Handover, Area::ContactVector];

/// Returns the overlap (quadratic) and approach (linear), right except for round-off.
pub fn polynomials(student: Student, one: &PointMotion, radius: f64, point: Vec2, normal: Vec2) -> Vec<Vec<f64>> {
    let variant = student.mistake_in(FORMULA_AREAS);
    match variant {
        Some(Mistake::ExtendedPrecision) => {
            return arithmetic::particle_half_plane::<WideNumber>(one, radius, point, normal);
        }
        Some(Mistake::FusedArithmetic) => {
            return arithmetic::particle_half_plane::<FusedDouble>(one, radius, point, normal);
        }
        Some(Mistake::InterpolatedAll) => return basis::particle_half_plane(one, radius, point, normal),
        _ => {}
    }
    let q = if variant == Some(Mistake::HalfPlaneUnitNormal) { unit(normal) } else { normal };
    let (s, w) = (one.shift.dot(&q), (point - one.start).dot(&q));
    let overlap = match variant {
        Some(Mistake::WideArithmetic) => {
            arithmetic::particle_half_plane::<WideNumber>(one, radius, point, normal).swap_remove(0)
        }
        Some(Mistake::RearrangedHalfPlane) => rearranged_overlap(radius, s, w, q),
        _ => vec![-s * s, 2.0 * w * s, -w * w + radius * radius * q.dot(&q)],
    };
    vec![overlap, vec![-s * s, w * s]]
}

/// Returns the quadratic as a difference of squares.
fn rearranged_overlap(radius: f64, s: f64, w: f64, q: Vec2) -> Vec<f64> {
    let length = q.dot(&q).sqrt();
    let reach = radius * length;
    vec![-(s * s), s * w + w * s, (reach - w) * (reach + w)]
}

/// Returns the vector from the center to the boundary at time `t`.
pub fn contact_vector(student: Student, one: &PointMotion, point: Vec2, normal: Vec2, t: f64) -> Vec2 {
    let offset = point - one.start - t * one.shift;
    let square = normal.dot(&normal);
    match student.mistake_in(VECTOR_AREAS) {
        Some(Mistake::HalfPlaneContactUndivided) => offset.dot(&normal) * normal,
        Some(Mistake::HalfPlaneContactDividedByLength) => offset.dot(&normal) / square.sqrt() * normal,
        Some(Mistake::HalfPlaneContactIsNormal) => normal,
        Some(Mistake::HalfPlaneContactReversed) => -(offset.dot(&normal) / square * normal),
        Some(Mistake::HalfPlaneContactAdded) => (point - one.position_at(-t)).dot(&normal) / square * normal,
        Some(Mistake::HalfPlaneContactAtStart) => (point - one.start).dot(&normal) / square * normal,
        Some(Mistake::HalfPlaneContactAtEnd) => (point - one.position_at(1.0)).dot(&normal) / square * normal,
        Some(Mistake::HalfPlaneContactToPoint) => offset,
        Some(Mistake::HalfPlaneUnitNormal | Mistake::ContactOtherFormula) => {
            let u = unit(normal);
            (point - one.position_at(t)).dot(&u) * u
        }
        Some(Mistake::ExtendedPrecision) => arithmetic::vector_to_half_plane::<WideNumber>(one, point, normal, t),
        Some(Mistake::FusedArithmetic) => arithmetic::vector_to_half_plane::<FusedDouble>(one, point, normal, t),
        _ => offset.dot(&normal) / square * normal,
    }
}
