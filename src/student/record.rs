//! What a program writes of a state and its log: the contents of one record, not yet as bytes (trace-format.md).
use std::borrow::Cow;

use super::{
    catalogue::{Mistake, Student},
    world::{Contact, State, StepLog},
};
use crate::scene::Collision;

/// The numbers of one record, with this student's mistakes of logging. A block is `None` where scenes of this
/// collision type have none.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Positions.
    pub x: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// The impulse list.
    pub impulses: Option<Vec<Contact>>,
    /// The polynomial list, highest power first as a rule.
    pub polynomials: Option<Vec<Vec<f64>>>,
}

impl Record {
    /// The record that this student writes in a scene of this collision type.
    #[must_use]
    pub fn new(student: Student, collision: &Collision, state: &State, log: &StepLog) -> Self {
        let has_polynomials = matches!(collision, Collision::ContinuousTime { .. } | Collision::Hybrid { .. });
        let has_impulses = has_polynomials || matches!(collision, Collision::Simple { .. });
        Self {
            x: numbers(student, &state.x),
            v: numbers(student, &state.v),
            impulses: has_impulses.then(|| impulses(student, &log.impulses)),
            polynomials: has_polynomials.then(|| {
                (0..log.polynomials.len()).map(|index| polynomial_as_logged(student, log, index).into_owned()).collect()
            }),
        }
    }
}

fn numbers(student: Student, values: &[f64]) -> Vec<f64> {
    if student.makes(Mistake::LogSinglePrecision) {
        #[expect(clippy::cast_possible_truncation, reason = "this is the mistake: a float in the trace")]
        let single = |value: &f64| f64::from(*value as f32);
        values.iter().map(single).collect()
    } else {
        values.to_vec()
    }
}

fn impulses(student: Student, impulses: &[Contact]) -> Vec<Contact> {
    let mut listed: Vec<Contact> = match student.mistake() {
        Some(Mistake::LogNoImpulses) => Vec::new(),
        Some(Mistake::LogDuplicateImpulses) => impulses.iter().flat_map(|impulse| [*impulse, *impulse]).collect(),
        Some(Mistake::LogImpulsesReversed) => impulses.iter().rev().copied().collect(),
        _ => impulses.to_vec(),
    };
    if student.makes(Mistake::LogNanContacts) {
        listed.iter_mut().for_each(|impulse| impulse.n.fill(f64::NAN));
    }
    listed
}

/// The coefficients of the record's polynomial `index`, as this program logs them.
///
/// # Panics
/// When the log has no such polynomial.
#[must_use]
pub fn polynomial_as_logged(student: Student, log: &StepLog, index: usize) -> Cow<'_, [f64]> {
    let partner = index ^ 1;
    let swapped = student.makes(Mistake::LogSwapped) && partner < log.polynomials.len();
    let coefficients = log.polynomials[if swapped { partner } else { index }].coefficients();
    let change: fn(&mut Vec<f64>) = match student.mistake() {
        Some(Mistake::LogLowestFirst) => |list| list.reverse(),
        Some(Mistake::LogNegated) => |list| list.iter_mut().for_each(|coefficient| *coefficient = -*coefficient),
        Some(Mistake::LogNan) => |list| list.fill(f64::NAN),
        Some(Mistake::LogTiny) => |list| list.fill(1e-11),
        Some(Mistake::LogZeros) => |list| list.fill(0.0),
        Some(Mistake::LogPadded) => |list| list.insert(0, 0.0),
        Some(Mistake::LogTrailingZero) => |list| list.push(0.0),
        Some(Mistake::LogRounded) => |list| {
            list.iter_mut()
                .for_each(|coefficient| *coefficient = format!("{coefficient:.5e}").parse().unwrap_or(*coefficient));
        },
        _ => return Cow::Borrowed(coefficients),
    };
    let mut list = coefficients.to_vec();
    change(&mut list);
    Cow::Owned(list)
}
