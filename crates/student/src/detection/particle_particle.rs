//! Two particles (collisions.md 2): they overlap, and they approach each other.
use fosssim_model::sim::PointMotion;
use fosssim_num::vector::Vec2;

use super::{
    VECTOR_AREAS,
    arithmetic::{self, FusedDouble},
    basis,
    wide_numbers::WideNumber,
};
use crate::{Area, Mistake, author::Student};

/// The areas whose variants are made in the polynomials.
const FORMULA_AREAS: &[Area] = &[Area::ParticleParticle, Area::Handover, Area::ContactVector];

/// Returns the overlap (quadratic) and approach (linear), right except for round-off.
pub fn polynomials(student: Student, centers: &[PointMotion; 2], radii: [f64; 2]) -> Vec<Vec<f64>> {
    let variant = student.mistake_in(FORMULA_AREAS);
    match variant {
        Some(Mistake::ExtendedPrecision) => return arithmetic::particle_particle::<WideNumber>(centers, radii),
        Some(Mistake::FusedArithmetic) => return arithmetic::particle_particle::<FusedDouble>(centers, radii),
        Some(Mistake::InterpolatedAll) => return basis::particle_particle(centers, radii),
        _ => {}
    }
    let [one, two] = centers;
    let x = two.start - one.start;
    let d = two.shift - one.shift;
    let e = match variant {
        Some(Mistake::RearrangedParticleParticle) => -d,
        _ => one.shift - two.shift,
    };
    let reach = radii[0] + radii[1];
    let overlap = match variant {
        Some(Mistake::WideArithmetic) => arithmetic::particle_particle::<WideNumber>(centers, radii).swap_remove(0),
        Some(Mistake::RearrangedParticleParticle) => rearranged_overlap(centers, reach),
        _ => vec![-d.dot(&d), -2.0 * x.dot(&d), reach * reach - x.dot(&x)],
    };
    vec![overlap, vec![-e.dot(&e), e.dot(&x)]]
}

/// Returns the quadratic, with each dot product expanded into coordinates and added up in another order.
fn rearranged_overlap([one, two]: &[PointMotion; 2], reach: f64) -> Vec<f64> {
    let (x1, x2, d1, d2) = (one.start, two.start, one.shift, two.shift);
    let (dx, dy) = (d2.x - d1.x, d2.y - d1.y);
    let (px, py) = (x1.x - x2.x, x1.y - x2.y);
    vec![-(dy * dy + dx * dx), 2.0 * px * dx + 2.0 * py * dy, (reach * reach - px * px) - py * py]
}

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
