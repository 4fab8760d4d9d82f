//! Two particles (collisions.md 2): they overlap, and they approach each other.
use fosssim_model::sim::PointMotion;
use fosssim_num::vector::Vec2;

use super::{
    VECTOR_AREAS,
    arithmetic::{self, FusedDouble},
    wide_numbers::WideNumber,
};
use crate::{Mistake, author::Student};

/// Returns the vector from the first center to the second at time `t`.
pub fn contact_vector(student: Student, centers: &[PointMotion; 2], t: f64) -> Vec2 {
    let [one, two] = centers;
    match student.mistake_in(VECTOR_AREAS) {
        Some(Mistake::ParticleParticleContactAtStart) => two.start - one.start,
        Some(Mistake::ParticleParticleContactAtEnd) => two.position_at(1.0) - one.position_at(1.0),
        Some(Mistake::ParticleParticleContactReversed) => one.position_at(t) - two.position_at(t),
        Some(Mistake::ParticleParticleContactFirstStill) => two.position_at(t) - one.start,
        Some(Mistake::ParticleParticleContactSecondStill) => two.start - one.position_at(t),
        Some(Mistake::ParticleParticleContactFirstAdded) => two.position_at(t) - one.position_at(-t),
        Some(Mistake::ParticleParticleContactDisplacementsSwapped) => {
            (two.start + t * one.shift) - (one.start + t * two.shift)
        }
        Some(Mistake::ParticleParticleContactFirstAtEnd) => two.position_at(t) - one.position_at(1.0),
        Some(Mistake::ParticleParticleContactSecondAtEnd) => two.position_at(1.0) - one.position_at(t),
        Some(Mistake::ExtendedPrecision) => arithmetic::vector_between_particles::<WideNumber>(centers, t),
        Some(Mistake::FusedArithmetic) => arithmetic::vector_between_particles::<FusedDouble>(centers, t),
        Some(Mistake::ContactOtherFormula) => (two.start - one.start) + t * (two.shift - one.shift),
        _ => two.position_at(t) - one.position_at(t),
    }
}
