//! The polynomials of a record, as logged by a program.
use super::{Area, Mistake, author::Student, world::StepLog};
use std::borrow::Cow;

/// The areas of the assignment whose mistakes this module simulates.
const MODULE_AREAS: &[Area] = &[Area::Trace];

/// Returns the coefficients of the record's polynomial `index`, as logged by this program.
pub fn logged_polynomial<'a>(student: Student, log: &'a StepLog, index: usize) -> Cow<'a, [f64]> {
    let partner = index ^ 1;
    let Some(mistake) = student.mistake_in(MODULE_AREAS) else { return log.polynomials[index].coefficients().into() };
    let swapped = student.makes(Mistake::LogSwapped) && partner < log.polynomials.len();
    let mut list = log.polynomials[if swapped { partner } else { index }].coefficients().to_vec();
    match mistake {
        Mistake::LogLowestFirst => list.reverse(),
        Mistake::LogNegated => list.iter_mut().for_each(|coefficient| *coefficient = -*coefficient),
        Mistake::LogNan => list.fill(f64::NAN),
        Mistake::LogTiny => list.fill(1e-11),
        Mistake::LogPadded => list.insert(0, 0.0),
        Mistake::LogTrailingZero => list.push(0.0),
        Mistake::LogRounded => {
            list.iter_mut()
                .for_each(|coefficient| *coefficient = format!("{coefficient:.5e}").parse().unwrap_or(*coefficient));
        }
        _ => {}
    }
    Cow::Owned(list)
}
