//! Whether explanations speak of the same mistake.
use super::about::{About, OfPolynomials};
use crate::student::{Row, find};
use fosssim_findings::explanation::{Detail, Explanation};

/// The explanation of the same steps by this known mistake instead.
pub(super) fn as_row(one: &Explanation, row: &Row, same_as: Vec<String>) -> Explanation {
    let of_row = |detail: &Detail| match detail {
        Detail::Term(_) => Detail::Term(row.id.into()),
        Detail::Look(_) => Detail::Look(row.area),
        other => other.clone(),
    };
    let details = one.details.iter().map(of_row).collect();
    Explanation { key: row.id.to_owned(), about: About::Mistake, details, same_as, ..one.clone() }
}

/// Whether these explanations of a trace name it, told or as not to be told apart; of what is not written yet, one
/// stage.
#[must_use]
pub fn is_named_in(mistake: &Explanation, explanations: &[Explanation]) -> bool {
    if mistake.is_unfinished() {
        let is_stage = |key: &String| mistake.same_as.contains(key);
        return explanations.iter().any(|one| is_stage(&one.key) || one.same_as.iter().any(is_stage));
    }
    if let (true, About::Polynomials { subjects, found }) = (mistake.is_unexplained(), &mistake.about) {
        let says_so = |one: &Explanation| match (found, &one.about) {
            (OfPolynomials::Guess(guess), About::Polynomials { found: OfPolynomials::Guess(theirs), .. }) => {
                guess == theirs
            }
            (found, _) => *found == OfPolynomials::Nothing,
        };
        let is_about = |one: &Explanation| one.subjects().iter().any(|subject| subjects.contains(subject));
        return explanations.iter().any(|one| is_about(one) && says_so(one));
    }
    let said = mistake.said();
    explanations.iter().any(|one| bears_out(one, &said, Some(mistake)))
}

/// Whether a trace's explanation speaks for what is said, as told by another one: it says the same, or something
/// that it can't tell apart, or its polynomials are those that it would make.
pub(super) fn bears_out(one: &Explanation, said: &str, told: Option<&Explanation>) -> bool {
    let is_same = one.said() == said || one.same_as.iter().any(|key| key == said);
    let is_in_other_words = || find(said).is_some_and(|row| is_in_other_words(one, row) && one.is_complete());
    is_same || is_in_other_words() || is_made_by(one, said, told)
}

/// Whether all its polynomials are those that this would make.
pub(super) fn is_made_by(one: &Explanation, said: &str, told: Option<&Explanation>) -> bool {
    let claims = one.claims_by_subject();
    let is_made = |own: &dyn Fn(&str, &str) -> bool| {
        !claims.is_empty() && claims.values().all(|of| of.iter().any(|(guess, claim)| own(guess, claim)))
    };
    match told.map(|told| &told.about) {
        None | Some(About::Mistake) => find(said).is_some() && is_made(&|guess, _| guess == said),
        Some(About::Polynomials { found: OfPolynomials::Guess(guess), .. }) if guess.is_general() => {
            let word = guess.word();
            is_made(&|own, _| own == word)
        }
        Some(About::Polynomials { found: OfPolynomials::Guess(_), .. }) => is_made(&|_, claim| claim == said),
        _ => false,
    }
}

/// Whether this, found in the polynomials of one kind alone, is this known mistake: `radii-squared-apart` of
/// particles and edges is `pe-radii-squared-apart`.
pub(super) fn is_in_other_words(one: &Explanation, row: &Row) -> bool {
    let is_called_so = row.id.split_once('-').is_some_and(|(_, own)| own == one.key);
    let About::Polynomials { subjects, .. } = &one.about else { return false };
    is_called_so && subjects.first().is_some_and(|first| Some(first.kind()) == row.kind_of_pair())
}

/// Whether it speaks for what is said with all that it is about.
pub(super) fn bears_out_wholly(one: &Explanation, said: &str, told: Option<&Explanation>) -> bool {
    is_made_by(one, said, told) || (one.is_settled() && bears_out(one, said, told))
}
