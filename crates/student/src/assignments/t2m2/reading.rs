//! Finds the letters of a polynomial's readings by name.
use super::{
    extra_letters::extra_letters,
    formulas::{Letter, readings},
};
use fosssim_findings::explanation::Reading;

/// Returns the letter with this name in messages. It is one of the formula's own letters, or one of the extra letters
/// that students may use there. Returns `None` if no letter has the name.
pub fn letter(reading: Reading, name: &str) -> Option<&'static Letter> {
    let own = readings(reading.subject).get(reading.number)?.letters.iter();
    own.chain(extra_letters(reading.subject)).find(|letter| letter.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fosssim_findings::explanation::Subject;
    use fosssim_model::sim::PairKind;

    /// Tests that each name belongs to one letter, so that messages are unambiguous.
    #[test]
    fn every_letter_is_found_by_its_name() {
        for subject in PairKind::ALL.into_iter().flat_map(Subject::all_of_kind).copied() {
            for (number, formula) in readings(subject).iter().enumerate() {
                for letter in formula.letters {
                    let found =
                        super::letter(Reading { subject, number }, letter.name).expect("a letter of the formula");
                    assert_eq!((found.name, found.meaning), (letter.name, letter.meaning), "{subject:?} {number}");
                }
            }
            let names: Vec<&str> = extra_letters(subject).iter().map(|letter| letter.name).collect();
            assert!(names.iter().all(|name| names.iter().filter(|other| other == &name).count() == 1), "{names:?}");
        }
    }
}
