//! Correct programs that divide polynomials by a positive number, for simpler numbers.
//!
//! If a polynomial is zero except for round-off, the division gives it coefficients of ordinary size.
use fosssim_model::sim::PairMotion;
use fosssim_num::vector::Vec2;

use crate::{Area, Mistake, author::Student};

/// The areas of the assignment whose mistakes this module simulates.
const MODULE_AREAS: &[Area] = &[Area::Handover];

/// Divides the polynomials as this student's program does. Most programs leave them unchanged.
pub fn normalize(student: Student, motion: &PairMotion, lists: &mut [Vec<f64>]) {
    let size: fn(&PairMotion, &[f64]) -> f64 = match student.mistake_in(MODULE_AREAS) {
        Some(Mistake::NormalizedLargest) => |_, list| list.iter().fold(0.0, |maximum, c| maximum.max(c.abs())),
        Some(Mistake::NormalizedNorm) => |_, list| list.iter().map(|c| c * c).sum::<f64>().sqrt(),
        Some(Mistake::NormalizedPerPair) => |motion, _| length_for_pair(motion),
        _ => return,
    };
    for list in lists {
        let size = size(motion, list);
        if size > 0.0 {
            list.iter_mut().for_each(|coefficient| *coefficient /= size);
        }
    }
}

/// Returns the squared length by which a pair's polynomials are divided. It is that of the edge at the start, or that
/// of the relative displacement. For a half-plane, the displacement is replaced by its dot product with the normal.
fn length_for_pair(motion: &PairMotion) -> f64 {
    let square = |v: Vec2| v.dot(&v);
    match motion {
        PairMotion::Particles { centers: [one, two], .. } => square(two.shift - one.shift),
        PairMotion::Edge { ends: [first, second], .. } => square(second.start - first.start),
        PairMotion::HalfPlane { center, normal, .. } => {
            let speed = center.shift.dot(normal);
            speed * speed
        }
    }
}
