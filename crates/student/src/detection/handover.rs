//! The last step before coefficients are passed to the root finder.
use fosssim_num::polynomial::Polynomial;

use crate::{Area, Mistake, author::Student, objects::Object, rounding::round_to_f32};

/// The areas of the assignment whose mistakes this module simulates.
const MODULE_AREAS: &[Area] = &[Area::Handover];

/// Returns the polynomials of one pair as the root finder receives them. Small leading coefficients are removed, and
/// this student's mistake may change the lists.
pub fn pass_on(student: Student, object: Object, mut lists: Vec<Vec<f64>>) -> Vec<Polynomial> {
    // An empty detection passes on no polynomials, even if the student made other mistakes.
    if lists.is_empty() {
        return Vec::new();
    }
    if let Some(factor) = rescaling_factor(student, object) {
        lists.iter_mut().flatten().for_each(|coefficient| *coefficient *= factor);
    }
    let edge = matches!(object, Object::Edge(_));
    match student.mistake_in(MODULE_AREAS) {
        Some(Mistake::HandoverLowestFirst) => lists.iter_mut().for_each(|list| list.reverse()),
        Some(Mistake::HandoverNegated) => lists.iter_mut().flatten().for_each(|coefficient| *coefficient *= -1.0),
        Some(Mistake::HandoverSwapped) => lists.swap(0, 1),
        Some(Mistake::HandoverSinglePrecision) => {
            lists.iter_mut().flatten().for_each(|coefficient| *coefficient = round_to_f32(*coefficient));
        }
        Some(Mistake::HandoverPositionOnly) => lists.truncate(if edge { 3 } else { 1 }),
        Some(Mistake::HandoverApproachOnly) => lists = lists.split_off(lists.len() - 1),
        Some(Mistake::HandoverAlphaSwapped) if edge => lists.swap(1, 2),
        Some(Mistake::HandoverMonic) => lists.iter_mut().for_each(|list| divide_by_leading(list)),
        _ => {}
    }
    lists.iter().map(|list| Polynomial::trimmed(list)).collect()
}

/// Returns the positive factor by which a correct variant multiplies its polynomials, or `None` if it does not rescale
/// them.
fn rescaling_factor(student: Student, object: Object) -> Option<f64> {
    let factor = match (student.mistake_in(MODULE_AREAS)?, object) {
        (Mistake::ScaleTwo, _) | (Mistake::ScaleParticleParticleTwo, Object::Particle(_)) => 2.0,
        (Mistake::ScaleHalf, _) => 0.5,
        (Mistake::ScaleThree, _)
        | (Mistake::ScaleParticleEdgeThree, Object::Edge(_))
        | (Mistake::ScaleHalfPlaneThree, Object::HalfPlane(_)) => 3.0,
        (Mistake::ScaleThousand, _) => 1000.0,
        (Mistake::ScaleMillionth, _) => 1e-6,
        _ => return None,
    };
    Some(factor)
}

/// Divides by the leading coefficient with its sign, which reverses the inequality if it is negative.
fn divide_by_leading(list: &mut [f64]) {
    let leading = list[0];
    if leading != 0.0 {
        list.iter_mut().for_each(|coefficient| *coefficient /= leading);
    }
}
