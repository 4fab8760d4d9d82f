//! Decides whether explanations are about the same mistake.
use super::{
    Guess, ListGuess,
    fault::StageFault,
    student_code::may_contain,
    topic::{ExplanationTopic, PolynomialEvidence},
};
use fosssim_findings::explanation::{Detail, Explanation};
use fosssim_model::sim::PairKind;
use fosssim_student::{CATALOG, Row, all_rows, assignments::t2m2::Subject, find};
use std::collections::{BTreeMap, BTreeSet};

/// Returns an explanation of the same steps as `one` by the known mistake of `row`.
pub(super) fn explain_by_row(one: &Explanation, row: &Row, same_as: Vec<String>) -> Explanation {
    let adapt = |detail: &Detail| match detail {
        Detail::Term(_) => Detail::Term(row.id.into()),
        Detail::SearchArea(_) => Detail::SearchArea(row.area),
        other => other.clone(),
    };
    let details = one.details.iter().map(adapt).collect();
    Explanation { key: row.id.to_owned(), topic: ExplanationTopic::Mistake, details, same_as, ..one.clone() }
}

/// Returns an explanation for each kind of pair whose coefficients are all zero, if `one` is about such coefficients.
pub(super) fn explain_zero_coefficients(one: &Explanation) -> Vec<Explanation> {
    let is_zero = matches!(
        &one.topic,
        ExplanationTopic::Polynomials { found: PolynomialEvidence::Guess(Guess::List(ListGuess::AllZero)), .. }
    );
    let subjects = one.subjects();
    // The course supplies the approach polynomial of particles and edges.
    let is_supplied = |subject: &&Subject| **subject != Subject::EdgeApproach;
    let is_all = |kind: &PairKind| {
        Subject::all_of_kind(*kind).iter().filter(is_supplied).all(|subject| subjects.contains(subject))
    };
    let kinds = PairKind::ALL.into_iter().filter(|kind| is_zero && is_all(kind));
    let row = |kind: PairKind| {
        let is_zero_row = |row: &&Row| row.pair_kind() == Some(kind) && row.id.ends_with("-zero");
        CATALOG.iter().find(is_zero_row)
    };
    let to_explanation = |row: &Row| Explanation {
        details: vec![Detail::Term(row.id.into()), Detail::SearchArea(row.area)],
        example: None,
        ..explain_by_row(one, row, Vec::new())
    };
    kinds.filter_map(row).map(to_explanation).collect()
}

/// Returns whether a trace's explanations name a mistake, either as reported or as indistinguishable. For unwritten
/// work, one stage is enough.
pub fn is_named_in(mistake: &Explanation, explanations: &[Explanation]) -> bool {
    if mistake.is_unfinished() {
        let is_stage = |key: &String| mistake.same_as.contains(key);
        return explanations.iter().any(|explanation| {
            let zeros = explain_zero_coefficients(explanation);
            std::iter::once(explanation).chain(&zeros).any(|one| is_stage(&one.key))
                || explanation.same_as.iter().any(is_stage)
        });
    }
    if let (true, ExplanationTopic::Polynomials { subjects, found }) = (mistake.is_unexplained(), &mistake.topic) {
        let says_so = |explanation: &Explanation| match (found, &explanation.topic) {
            (
                PolynomialEvidence::Guess(guess),
                ExplanationTopic::Polynomials { found: PolynomialEvidence::Guess(theirs), .. },
            ) => guess == theirs,
            (found, _) => *found == PolynomialEvidence::Nothing,
        };
        let is_about =
            |explanation: &Explanation| explanation.subjects().iter().any(|subject| subjects.contains(subject));
        return explanations.iter().any(|explanation| is_about(explanation) && says_so(explanation));
    }
    let statement = mistake.statement();
    let is_likewise = |explanation: &Explanation| match (&mistake.topic, &explanation.topic) {
        (ExplanationTopic::Stage(StageFault::Change(all)), ExplanationTopic::Stage(StageFault::Change(own))) => {
            all.includes(own)
        }
        // Other traces contradict a known mistake if they share only the fault of its code.
        (ExplanationTopic::Stage(fault @ StageFault::Change(_)), ExplanationTopic::Mistake) => {
            find(&explanation.key).is_some_and(|row| may_contain(fault, row))
        }
        _ => alternative_statements(explanation).contains_key(&statement),
    };
    explanations.iter().any(is_likewise)
}

/// Returns the statements ([`Explanation::statement`]) that explain as much as this explanation of a trace. These are
/// its own, those that it cannot distinguish, and all that would give the same polynomials. Each has a flag, which is
/// true if it explains everything that this explanation is about.
pub(super) fn alternative_statements(one: &Explanation) -> BTreeMap<String, bool> {
    let is_known = |key: &&String| find(key).is_some();
    let mut all: BTreeMap<String, bool> = BTreeMap::from([(one.statement(), one.is_exhaustive())]);
    all.extend(one.same_as.iter().filter(is_known).map(|key| (key.clone(), one.is_exhaustive())));
    if one.is_complete() {
        all.extend(all_rows().filter(|row| has_same_meaning(one, row)).map(|row| (row.id.to_owned(), true)));
    }
    // A statement may explain one of several polynomials. It explains all of them only if it is a known mistake, or a
    // guess that does not depend on the polynomial.
    let statements_by_subject = one.claims_by_subject().into_values().map(|claims| {
        let statements = claims.into_iter().map(|(guess, claim)| {
            let concerns_all = find(guess).is_some() || claim.ends_with('/');
            if concerns_all { guess } else { claim }
        });
        statements.map(str::to_owned).collect::<BTreeSet<String>>()
    });
    let statements_by_subject = statements_by_subject.reduce(|one, other| one.intersection(&other).cloned().collect());
    all.extend(statements_by_subject.into_iter().flatten().map(|statement| (statement, true)));
    all
}

/// Returns whether a guess about a single kind of polynomial means the same as a known mistake with a longer key. For
/// example, the guess `radii-squared-apart` about particles and edges means `pe-radii-squared-apart`.
pub(super) fn has_same_meaning(one: &Explanation, row: &Row) -> bool {
    let is_called_so = row.id.split_once('-').is_some_and(|(_, own)| own == one.key);
    let ExplanationTopic::Polynomials { subjects, .. } = &one.topic else { return false };
    is_called_so && subjects.first().is_some_and(|first| Some(first.kind()) == row.pair_kind())
}
