//! Mistakes made by rule: at each place of the program, everything that an operator does to what stands there.
//!
//! The catalogue and [`mutants`](crate::mutants) hold mistakes that somebody has thought of. These are enumerated
//! instead (Offutt, "A practical system for mutation testing", 1994): indices exchanged or off by one, lists without
//! their first or last entry, values of before, conditions that always or never hold, blocks left early, numbers with
//! another sign or factor. They measure whether the scenes can tell a wrong program from a right one:
//! `scripts/sight-matrix` counts the scenes that refuse each, and [`EQUIVALENT`] says of each that no scene can
//! refuse why not.
mod equivalent;
mod places;

pub use equivalent::{EQUIVALENT, equivalent};

use fosssim_oracle::student::hooks::{Mutation, Operator, Place};

/// All changes of all places.
#[must_use]
pub fn mutations() -> Vec<Mutation> {
    let of = |(place, operators): (Place, &'static [Operator])| {
        operators.iter().map(move |&operator| Mutation { place, operator })
    };
    places::places().into_iter().flat_map(of).collect()
}

#[cfg(test)]
mod tests;
