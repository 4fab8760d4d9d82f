//! A particle and an edge (collisions.md 2): the particle overlaps the infinite line, is between the endpoints, and
//! approaches.
use fosssim_model::sim::PointMotion;
use fosssim_num::vector::{Vec2, length};

use super::{
    VECTOR_AREAS,
    arithmetic::{self, FusedDouble},
    wide_numbers::WideNumber,
};
use crate::{Mistake, author::Student};

/// Returns the parameter of the closest point on the infinite line at time `t`: 0 at the first endpoint, 1 at the
/// second.
pub fn alpha([one, two, three]: &[PointMotion; 3], t: f64) -> f64 {
    let to_particle = one.start + t * one.shift - two.start - t * two.shift;
    let edge = three.start + t * three.shift - two.start - t * two.shift;
    to_particle.dot(&edge) / edge.dot(&edge)
}

/// Returns the vector from the particle to the closest point of the line at time `t`.
pub fn contact_vector(student: Student, bodies: &[PointMotion; 3], t: f64) -> Vec2 {
    let mistake = student.mistake_in(VECTOR_AREAS);
    let hold_at_end = |body: PointMotion| PointMotion { start: body.position_at(1.0), shift: Vec2::zeros() };
    let [mut one, mut two, mut three] = *bodies;
    match mistake {
        Some(Mistake::ParticleEdgeContactParticleAtEnd) => one = hold_at_end(one),
        Some(Mistake::ParticleEdgeContactEdgeAtEnd) => (two, three) = (hold_at_end(two), hold_at_end(three)),
        _ => {}
    }
    let bodies = &[one, two, three];
    let t = match mistake {
        Some(Mistake::ParticleEdgeContactAtStart) => 0.0,
        Some(Mistake::ParticleEdgeContactAtEnd) => 1.0,
        _ => t,
    };
    let edge = three.start + t * three.shift - two.start - t * two.shift;
    let alpha = match mistake {
        Some(Mistake::ParticleEdgeContactAlphaAtStart) => alpha(bodies, 0.0),
        Some(Mistake::ParticleEdgeContactAlphaAtEnd) => alpha(bodies, 1.0),
        Some(Mistake::ParticleEdgeContactAlphaMiddle) => 0.5,
        Some(Mistake::ParticleEdgeContactAlphaOverLength) => alpha(bodies, t) * length(edge),
        Some(Mistake::ParticleEdgeContactFromOtherEnd) => 1.0 - alpha(bodies, t),
        Some(Mistake::ParticleEdgeContactNearestEnd) => f64::from(u8::from(alpha(bodies, t) > 0.5)),
        Some(Mistake::ParticleEdgeContactClamped) => alpha(bodies, t).clamp(0.0, 1.0),
        Some(Mistake::ParticleEdgeContactFirstEnd) => 0.0,
        Some(Mistake::ParticleEdgeContactSecondEnd) => 1.0,
        _ => alpha(bodies, t),
    };
    match mistake {
        Some(Mistake::ParticleEdgeContactReversed) => -(two.position_at(t) + alpha * edge - one.start - t * one.shift),
        Some(Mistake::ParticleEdgeContactParticleStill) => two.position_at(t) + alpha * edge - one.start,
        Some(Mistake::ParticleEdgeContactParticleAdded) => two.position_at(t) + alpha * edge - one.position_at(-t),
        Some(Mistake::ParticleEdgeContactAlphaTimesEnd) => {
            two.position_at(t) + alpha * three.position_at(t) - one.position_at(t)
        }
        Some(Mistake::ParticleEdgeContactEdgeStill) => {
            two.start + alpha * (three.start - two.start) - one.start - t * one.shift
        }
        Some(Mistake::ExtendedPrecision) => arithmetic::vector_to_edge::<WideNumber>(bodies, t),
        Some(Mistake::FusedArithmetic) => arithmetic::vector_to_edge::<FusedDouble>(bodies, t),
        Some(Mistake::ContactOtherFormula) => {
            let edge_normal = Vec2::new(-edge.y, edge.x);
            (two.position_at(t) - one.position_at(t)).dot(&edge_normal) / edge.dot(&edge) * edge_normal
        }
        _ => two.position_at(t) + alpha * edge - one.start - t * one.shift,
    }
}
