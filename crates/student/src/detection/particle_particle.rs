//! Two particles (collisions.md 2): they overlap, and they approach each other.
use fosssim_num::vector::Vec2;

use super::{
    MovingBody, VECTORS,
    arithmetic::{self, FusedDouble},
    basis,
    wide::WideNumber,
};
use crate::{Area, Mistake, author::Student};

/// The parts of the assignment whose mistakes are made in the polynomials.
const FORMULAS: &[Area] = &[Area::ParticleParticle, Area::Handover, Area::ContactVector];

/// Returns the overlap (quadratic) and approach (linear).
pub fn polynomials(student: Student, one: &MovingBody, two: &MovingBody) -> Vec<Vec<f64>> {
    let mistake = student.mistake_in(FORMULAS);
    match mistake {
        Some(Mistake::ParticleParticleEmpty) => return Vec::new(),
        Some(Mistake::ParticleParticleZero) => return vec![vec![0.0; 3], vec![0.0; 2]],
        Some(Mistake::ExtendedPrecision) => return arithmetic::particle_particle::<WideNumber>(one, two),
        Some(Mistake::FusedArithmetic) => return arithmetic::particle_particle::<FusedDouble>(one, two),
        Some(Mistake::InterpolatedAll) => return basis::particle_particle(one, two),
        _ => {}
    }
    let x = match mistake {
        Some(Mistake::ParticleParticleEndPositions) => two.end() - one.end(),
        _ => two.start - one.start,
    };
    let d = match mistake {
        Some(Mistake::ParticleParticleFirstStill) => two.displacement,
        Some(Mistake::ParticleParticleSecondStill) => -one.displacement,
        Some(Mistake::ParticleParticleEndForDisplacement) => two.end() - one.end(),
        Some(Mistake::ParticleParticleDisplacementsSwapped) => one.displacement - two.displacement,
        _ => two.displacement - one.displacement,
    };
    let e = match mistake {
        Some(
            Mistake::RearrangedParticleParticle
            | Mistake::ParticleParticleSecondStill
            | Mistake::ParticleParticleDisplacementsSwapped,
        ) => -d,
        _ => one.displacement - two.displacement,
    };
    let overlap = match mistake {
        Some(Mistake::WideArithmetic) => arithmetic::particle_particle::<WideNumber>(one, two).swap_remove(0),
        Some(Mistake::RearrangedParticleParticle) => rearranged_overlap(one, two),
        _ => overlap(student, x, d, one.radius, two.radius),
    };
    vec![overlap, approach(student, x, d, e)]
}

fn overlap(student: Student, x: Vec2, d: Vec2, r1: f64, r2: f64) -> Vec<f64> {
    let mistake = student.mistake_in(FORMULAS);
    let reach = match mistake {
        Some(Mistake::ParticleParticleFirstRadiusTwice) => r1 + r1,
        Some(Mistake::ParticleParticleSecondRadiusTwice) => r2 + r2,
        Some(Mistake::ParticleParticleDiameters) => 2.0 * (r1 + r2),
        Some(Mistake::ParticleParticleOneRadius) => r1,
        Some(Mistake::ParticleParticleNoFirstRadius) => r2,
        _ => r1 + r2,
    };
    let square = match mistake {
        Some(Mistake::ParticleParticleRadiiSquaredApart) => r1 * r1 + r2 * r2,
        Some(Mistake::ParticleParticleRadiusNotSquared) => reach,
        _ => reach * reach,
    };
    let distance = match mistake {
        Some(Mistake::ParticleParticleDistanceNotSquared) => x.dot(&x).sqrt(),
        _ => x.dot(&x),
    };
    let t2 = match mistake {
        Some(Mistake::ParticleParticleQuadraticSign) => d.dot(&d),
        Some(Mistake::ParticleParticleXOnly) => -d.x * d.x,
        Some(Mistake::ParticleParticleNoQuadratic) => 0.0,
        _ => -d.dot(&d),
    };
    let t1 = match mistake {
        Some(Mistake::ParticleParticleNoTwo) => -x.dot(&d),
        Some(Mistake::ParticleParticleLinearSign) => 2.0 * x.dot(&d),
        Some(Mistake::ParticleParticleXOnly) => -2.0 * (x.x * d.x),
        _ => -2.0 * x.dot(&d),
    };
    let t0 = match mistake {
        Some(Mistake::ParticleParticleConstantSign) => distance - square,
        Some(Mistake::ParticleParticleTinyError) => (square - distance) * (1.0 + 1e-9),
        _ => square - distance,
    };
    if mistake == Some(Mistake::ParticleParticleOverlapNegated) {
        return vec![-t2, -t1, -t0];
    }
    vec![t2, t1, t0]
}

/// Returns the quadratic, each dot product multiplied out into coordinates and added up in another order.
fn rearranged_overlap(one: &MovingBody, two: &MovingBody) -> Vec<f64> {
    let (x1, x2, d1, d2) = (one.start, two.start, one.displacement, two.displacement);
    let (dx, dy) = (d2.x - d1.x, d2.y - d1.y);
    let reach = one.radius + two.radius;
    let (px, py) = (x1.x - x2.x, x1.y - x2.y);
    vec![-(dy * dy + dx * dx), 2.0 * px * dx + 2.0 * py * dy, (reach * reach - px * px) - py * py]
}

fn approach(student: Student, x: Vec2, d: Vec2, e: Vec2) -> Vec<f64> {
    match student.mistake_in(FORMULAS) {
        Some(Mistake::ParticleParticleSeparating) => vec![-d.dot(&d), d.dot(&x)],
        Some(Mistake::ParticleParticleApproachNegated) => vec![e.dot(&e), -e.dot(&x)],
        Some(Mistake::ParticleParticleApproachSlopeSign) => vec![e.dot(&e), e.dot(&x)],
        Some(Mistake::ParticleParticleApproachSlopeTwice) => vec![-2.0 * e.dot(&e), e.dot(&x)],
        Some(Mistake::ParticleParticleApproachAtStart) => vec![e.dot(&x)],
        Some(Mistake::ParticleParticleNoApproach) => vec![1.0],
        _ => vec![-e.dot(&e), e.dot(&x)],
    }
}

/// Returns the vector from the first center to the second at time `t`.
pub fn contact_vector(student: Student, one: &MovingBody, two: &MovingBody, t: f64) -> Vec2 {
    match student.mistake_in(VECTORS) {
        Some(Mistake::ParticleParticleContactAtStart) => two.start - one.start,
        Some(Mistake::ParticleParticleContactAtEnd) => two.end() - one.end(),
        Some(Mistake::ParticleParticleContactReversed) => one.at(t) - two.at(t),
        Some(Mistake::ParticleParticleContactFirstStill) => two.at(t) - one.start,
        Some(Mistake::ParticleParticleContactSecondStill) => two.start - one.at(t),
        Some(Mistake::ParticleParticleContactFirstAtEnd) => two.at(t) - one.end(),
        Some(Mistake::ParticleParticleContactSecondAtEnd) => two.end() - one.at(t),
        Some(Mistake::ExtendedPrecision) => arithmetic::vector_between_particles::<WideNumber>(one, two, t),
        Some(Mistake::FusedArithmetic) => arithmetic::vector_between_particles::<FusedDouble>(one, two, t),
        Some(Mistake::ContactOtherFormula) => (two.start - one.start) + t * (two.displacement - one.displacement),
        _ => two.at(t) - one.at(t),
    }
}
