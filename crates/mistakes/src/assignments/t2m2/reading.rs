//! Ways to write a polynomial down, by name.
use super::{
    Subject,
    extras::extras,
    formulas::{Formula, Letter, readings},
};
use fosssim_model::sim::PairKind;

/// One way to write a polynomial down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reading {
    /// The polynomial.
    pub subject: Subject,
    /// Which of its ways: 0 is the assignment's.
    pub number: usize,
}

impl Reading {
    /// The formula, if there is such a way.
    pub(crate) fn formula(self) -> Option<&'static Formula> {
        readings(self.subject).get(self.number)
    }

    /// The letter that a message calls so: one of the formula's own, or one that does not belong there and may stand
    /// there.
    #[must_use]
    pub fn letter(self, name: &str) -> Option<&'static Letter> {
        let own = self.formula()?.letters.iter();
        own.chain(extras(self.subject)).find(|letter| letter.name == name)
    }
}

/// The name, as the tables have it, of a letter of any formula.
#[must_use]
pub fn letter_name(name: &str) -> Option<&'static str> {
    PairKind::ALL.into_iter().flat_map(Subject::of).find_map(|&subject| {
        let readings = 0..readings(subject).len();
        readings.into_iter().find_map(|number| Reading { subject, number }.letter(name)).map(|letter| letter.name)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A name stands for one letter, so that a message about it says what is meant.
    #[test]
    fn every_letter_is_found_by_its_name() {
        for subject in PairKind::ALL.into_iter().flat_map(Subject::of).copied() {
            for (number, formula) in readings(subject).iter().enumerate() {
                for letter in formula.letters {
                    let found = Reading { subject, number }.letter(letter.name).expect("a letter of the formula");
                    assert_eq!((found.name, found.meaning), (letter.name, letter.meaning), "{subject:?} {number}");
                }
            }
            let names: Vec<&str> = extras(subject).iter().map(|letter| letter.name).collect();
            assert!(names.iter().all(|name| names.iter().filter(|other| other == &name).count() == 1), "{names:?}");
        }
    }
}
