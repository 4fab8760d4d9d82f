//! Correct programs that divide polynomials by something positive, to get handy numbers.
//!
//! If a polynomial is zero except for round-off, the division makes it numbers of ordinary size.
use fosssim_num::vector::Vec2;

use crate::encounter::Encounter;
use crate::{Area, Mistake, author::Student};

/// The parts of the assignment whose mistakes are made here.
const HERE: &[Area] = &[Area::Handover];

/// Divides as this student does, if at all.
pub fn normalize(student: Student, encounter: &Encounter, lists: &mut [Vec<f64>]) {
    let size: fn(&Encounter, &[f64]) -> f64 = match student.mistake_in(HERE) {
        Some(Mistake::NormalizedLargest) => |_, list| list.iter().fold(0.0, |most, c| most.max(c.abs())),
        Some(Mistake::NormalizedNorm) => |_, list| list.iter().map(|c| c * c).sum::<f64>().sqrt(),
        Some(Mistake::NormalizedPerPair) => |encounter, _| length_for_pair(encounter),
        _ => return,
    };
    for list in lists {
        let size = size(encounter, list);
        if size > 0.0 {
            list.iter_mut().for_each(|coefficient| *coefficient /= size);
        }
    }
}

/// Returns a number that makes quotients of one pair's formulas handy: the square of the relative motion, along the
/// normal if there is one; for edges the square of the length.
fn length_for_pair(encounter: &Encounter) -> f64 {
    let square = |v: Vec2| v.dot(&v);
    match encounter {
        Encounter::Particles(one, two) => square(two.displacement - one.displacement),
        Encounter::Edge([_, two, three], _) => square(three.start - two.start),
        Encounter::HalfPlane(one, _, normal) => {
            let speed = one.displacement.dot(normal);
            speed * speed
        }
    }
}
