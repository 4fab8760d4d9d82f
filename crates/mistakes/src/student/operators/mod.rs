//! Mistakes made by rule: at each place of the program, everything that an operator does to what stands there.
//!
//! The catalogue and [`mutants`](super::mutants) hold mistakes that somebody has thought of. These are enumerated
//! instead (Offutt, "A practical system for mutation testing", 1994): indices exchanged or off by one, lists without
//! their first or last entry, values of before, conditions that always or never hold, blocks left early, numbers with
//! another sign or factor. They measure whether the scenes can tell a wrong program from a right one:
//! `scripts/mutation-matrix` counts the scenes that refuse each, and [`EQUIVALENT`] says of each that no scene can
//! refuse why not.
mod apply;
mod equivalent;
mod places;

pub use equivalent::{EQUIVALENT, equivalent};
pub use places::Place;

use std::fmt;

/// What is done to what stands at a place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// An index: the one of the partner stands there.
    Other,
    /// An index: the one behind the partner's.
    AfterOther,
    /// An index: the next one.
    Next,
    /// An index: the one before.
    Previous,
    /// An index: 0.
    First,
    /// A number or a vector: 0.
    Zero,
    /// A number or a vector with the other sign.
    Negated,
    /// Twice the number or the vector.
    Doubled,
    /// Half the number.
    Halved,
    /// A vector: its components change places.
    AxesExchanged,
    /// A condition: it holds.
    Always,
    /// A condition: it does not hold.
    Never,
    /// A list: its first entry is skipped.
    WithoutFirst,
    /// A list: its last entry is skipped.
    WithoutLast,
    /// A list: the loop is left after the first entry.
    FirstOnly,
    /// A list: every entry overwrites the one before.
    LastOnly,
    /// A list: it is gone through backwards.
    Reversed,
    /// A list: it is gone through twice.
    Repeated,
    /// A list: it is not gone through.
    Empty,
    /// A count: one more.
    OneMore,
    /// A count: one less.
    OneLess,
    /// A value: another one that the program has at hand, as a rule of before.
    Stale,
    /// A block: it is left at once.
    Skipped,
    /// A block: it is left where the number that it computes first is zero.
    AtZero,
    /// A block: it is left where that number is not zero.
    NotAfterZero,
}

/// One change of one place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mutation {
    /// Where.
    pub place: Place,
    /// What.
    pub operator: Operator,
}

impl fmt::Display for Mutation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}: {:?}", self.place, self.operator)
    }
}

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
