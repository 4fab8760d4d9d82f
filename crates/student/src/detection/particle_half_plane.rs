//! A particle and a half-plane with point P and normal Q (collisions.md 2): the particle overlaps the boundary, and
//! approaches it.
use fosssim_model::sim::PointMotion;
use fosssim_num::vector::{Vec2, unit};

use super::{
    VECTOR_AREAS,
    arithmetic::{self, FusedDouble},
    wide_numbers::WideNumber,
};
use crate::{Mistake, author::Student};

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
