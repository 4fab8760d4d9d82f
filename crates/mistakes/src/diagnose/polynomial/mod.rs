//! Finds the mistake that makes detection polynomials wrong.
//!
//! Each sample consists of the inputs of a detection, and the logged polynomials. A guess is rated by the number of
//! samples that it reproduces to round-off, including right ones. The simplest guesses are about the whole list of
//! coefficients (`structure`), which may be reversed, negated, cut or exchanged. Other guesses are about the inputs,
//! such as end positions or radii squared separately, and about misunderstandings with their own formula. Further ones
//! are about one letter of a formula (`slips`) and about any other radius (`radius`). The most intricate guesses are
//! about the terms of single coefficients (`terms`). They are found by sparse least squares over the products of dot
//! products, with weights that are multiples of 1/4. Correct polynomials are those of collisions.md 2, each up to a
//! positive factor. The quintic may be the supplied one or the mathematically right one.
//!
//! The module reads no trace, judges nothing and never uses decisions or responses.
mod compare;
mod dictionary;
mod example;
mod radius;
mod slips;
mod structure;
mod study;
mod terms;
#[cfg(test)]
mod tests;

pub use super::sampling::Sample;

use super::{
    Detail, Explanation, PolynomialDetail, Weight,
    guess::{CoefficientGuess, Guess, QuantityGuess, hash_key},
    sampling::{ROUND_OFF, polynomial_matches},
    topic::{ExplanationTopic, PolynomialEvidence},
};
use fosssim_model::sim::PairKind;
use fosssim_student::assignments::t2m2::{NAMED_EDITS, NamedEdit, Subject};
use fosssim_student::{Area, CATALOG, Row, RowKind, Student, body_polynomials};
use std::collections::BTreeMap;
use study::{Candidate, PolynomialSample, PolynomialStudy};

/// The maximum number of guesses about a polynomial that are kept in addition to the reported one.
const MAX_CLAIMS: usize = 128;

/// The maximum number of other keys that an explanation reports.
const MAX_OTHER_KEYS: usize = 5;

/// The maximum error of a polynomial that is right except for round-off, relative to the size of its terms.
const NEARLY_RIGHT_ERROR: f64 = 1e-10;

/// The maximum difference in cost ([`Candidate::cost`]) between the best guess and a guess that is reported together
/// with it.
const MAX_COST_DIFFERENCE: f64 = 1.6;

/// Returns explanations of the wrong polynomials of the samples, or none if all are right. A mistake that several
/// polynomials share is reported once, and first. Explanations that do not reproduce all samples come last.
/// [`Explanation::samples`] and [`Explanation::reproduced`] count polynomials. A polynomial without an explanation gets
/// one with the key `unexplained`, which reproduces nothing.
///
/// A few hundred samples of each kind, from different steps and pairs and including right ones, are enough. Samples
/// whose formulas overflow are left out. The samples of one kind should include all of its polynomials.
pub fn explain_polynomials(samples: &[Sample]) -> Vec<Explanation> {
    let subjects = PairKind::ALL.into_iter().flat_map(Subject::all_of_kind).copied();
    let mut open: Vec<WrongPolynomial> = subjects
        .filter_map(|subject| PolynomialStudy::new(subject, samples))
        .map(|study| WrongPolynomial { candidates: collect_candidates(&study), study })
        .collect();
    let mut explanations: Vec<Explanation> = open.iter().filter_map(explain_nearly_right).collect();
    open.retain(|suspect| explain_nearly_right(suspect).is_none());
    while let Some(key) = find_best_shared_key(&open) {
        let (covered, rest): (Vec<WrongPolynomial>, Vec<WrongPolynomial>) = open
            .into_iter()
            .partition(|suspect| suspect.complete_guesses().any(|candidate| candidate.guess.key() == key));
        explanations.push(explain_shared(&covered, &key));
        open = rest;
    }
    let (unknown, open): (Vec<WrongPolynomial>, Vec<WrongPolynomial>) =
        open.into_iter().partition(|suspect| suspect.candidates.is_empty());
    explanations.extend(open.iter().map(WrongPolynomial::explain));
    explanations.extend(summarize_unexplained(&unknown));
    explanations.extend(explain_missing(samples));
    explanations.sort_by_key(|explanation| explanation.reproduced < explanation.samples);
    explanations
}

/// Returns the explanation that polynomials are missing, if no detection of a kind of pair logs all of them.
fn explain_missing(samples: &[Sample]) -> Option<Explanation> {
    let (mut subjects, mut details, mut count) = (Vec::new(), Vec::new(), 0);
    for kind in PairKind::ALL {
        let kind_samples = || samples.iter().filter(|sample| sample.motion.kind() == kind);
        let logged = kind_samples().map(|sample| sample.polynomials.len()).max().unwrap_or(usize::MAX);
        if logged < kind.polynomial_count() {
            details.push(Detail::Polynomial(PolynomialDetail::Logged { logged, of: kind.polynomial_count() }));
            count += kind_samples().count() as u64;
        }
        subjects.extend(Subject::all_of_kind(kind).iter().skip(logged));
    }
    (!subjects.is_empty()).then(|| Explanation {
        details: take_distinct(details, MAX_OTHER_KEYS),
        reproduced: count,
        samples: count,
        ..Explanation::with_topic(
            Explanation::MISSING_POLYNOMIALS,
            ExplanationTopic::Polynomials { subjects, found: PolynomialEvidence::Missing },
        )
    })
}

/// A wrong polynomial, and the guesses about it, the best first.
struct WrongPolynomial<'a> {
    study: PolynomialStudy<'a>,
    candidates: Vec<Candidate>,
}

impl WrongPolynomial<'_> {
    /// Returns the guesses that reproduce all samples.
    fn complete_guesses(&self) -> impl Iterator<Item = &Candidate> {
        self.candidates.iter().filter(|candidate| candidate.reproduced == self.study.cases.len())
    }

    /// Returns all claims that would explain the polynomial: those of `guesses`, and known mistakes. If there is none,
    /// returns a placeholder.
    fn list_claims<'a>(&self, guesses: impl Iterator<Item = &'a Candidate>) -> Vec<String> {
        let subject = self.study.subject;
        let guesses = guesses.flat_map(|guess| list_claims(subject, guess)).take(MAX_CLAIMS);
        let all: Vec<String> = guesses.chain(find_known_mistakes(&self.study)).collect();
        if all.is_empty() { vec![format!("{subject:?}//")] } else { all }
    }

    /// Returns the explanation of this polynomial alone. It must have at least one candidate.
    fn explain(&self) -> Explanation {
        let (best, others) = (&self.candidates[0], self.complete_guesses());
        let first = list_claims(self.study.subject, best).swap_remove(0);
        let claims = std::iter::once(first).chain(self.list_claims(others));
        let samples = self.study.cases.len() as u64;
        let equal = |other: &&Candidate| {
            let is_likely = other.cost <= best.cost + MAX_COST_DIFFERENCE;
            is_likely && other.reproduced == best.reproduced && other.guess.key() != best.guess.key()
        };
        let found = PolynomialEvidence::Guess(best.guess.clone());
        Explanation {
            details: best.details.iter().cloned().map(|detail| guess_detail(detail, &[self.study.subject])).collect(),
            reproduced: best.reproduced as u64,
            samples,
            example: example::find_smallest_example(&self.study).map(|(_, example)| example),
            same_as: take_distinct(
                self.candidates.iter().filter(equal).map(|other| other.guess.key().to_owned()),
                MAX_OTHER_KEYS,
            ),
            claims: take_distinct(claims, usize::MAX),
            ..Explanation::with_topic(
                best.guess.key(),
                ExplanationTopic::Polynomials { subjects: vec![self.study.subject], found },
            )
        }
    }
}

/// Returns the claims of a guess about a polynomial, one for each formula that the guess may mean
/// ([`Explanation::claims`]). The digest covers the program's formula, not the right one.
fn list_claims(subject: Subject, candidate: &Candidate) -> Vec<String> {
    if candidate.guess.is_general() {
        return vec![format!("{subject:?}/{}/", candidate.guess.claim_key())];
    }
    let only = std::slice::from_ref(&candidate.details);
    let forms = if candidate.forms.is_empty() { only } else { &candidate.forms };
    forms.iter().map(|form| claim_of_form(subject, &candidate.guess, form)).collect()
}

/// Returns the claim that the program's formula is wrong exactly as the details `form` describe. The claim does not
/// contain which coefficients are wrong, because this follows from the details.
pub(super) fn claim_of_form(subject: Subject, guess: &Guess, form: &[PolynomialDetail]) -> String {
    let guess = match guess {
        Guess::Coefficients { .. } => Guess::Coefficients { powers: Vec::new(), wrong: CoefficientGuess::Several },
        other => other.clone(),
    };
    let bare = |detail: &PolynomialDetail| match detail {
        PolynomialDetail::Weight(weight) => PolynomialDetail::Weight(Weight { expected: 0.0, ..weight.clone() }),
        other => other.clone(),
    };
    let form: Vec<PolynomialDetail> = form.iter().map(bare).collect();
    // Factors are rounded, because they are measured.
    format!("{subject:?}/{}/{:016x}", guess.claim_key(), hash_key(&format!("{guess:?} {form:.5?}")))
}

/// Returns the known mistakes that give the logged polynomial in all samples: mistakes in the formulas of this kind, or
/// in passing their results on.
fn find_known_mistakes(study: &PolynomialStudy<'_>) -> Vec<String> {
    let kind = study.subject.kind();
    let Some(number) = Subject::all_of_kind(kind).iter().position(|&other| other == study.subject) else {
        return Vec::new();
    };
    let is_formula = |row: &&Row| {
        let has_kind = row.pair_kind() == Some(kind)
            && matches!(row.area, Area::ParticleParticle | Area::ParticleEdge | Area::ParticleHalfPlane);
        row.kind == RowKind::Wrong && (has_kind || row.area == Area::Handover)
    };
    let reproduces = |row: &&Row| {
        study.cases.iter().all(|case| {
            let predicted = body_polynomials(Student::new(Some(row.mistake)), &case.sample.motion);
            let is_match = |predicted: &Vec<f64>| polynomial_matches(predicted, case.logged, &ROUND_OFF);
            predicted.get(number).is_some_and(is_match)
        })
    };
    CATALOG.iter().filter(is_formula).filter(reproduces).map(|row| format!("{:?}/{}/", study.subject, row.id)).collect()
}

/// Returns a detail of a guess about `subjects` as part of the explanation.
fn guess_detail(mut detail: PolynomialDetail, subjects: &[Subject]) -> Detail {
    if let PolynomialDetail::Named { has_only_edge_pairs, .. } = &mut detail {
        *has_only_edge_pairs = subjects.iter().all(|subject| subject.kind() == PairKind::ParticleEdge);
    }
    Detail::Polynomial(detail)
}

/// Returns all guesses about a polynomial. The guess that reproduces most comes first; if several reproduce as much,
/// the likeliest comes first.
fn collect_candidates(study: &PolynomialStudy) -> Vec<Candidate> {
    let mut all = structure::collect_candidates(study);
    all.extend(collect_misunderstandings(study));
    all.extend(slips::collect_candidates(study));
    all.extend(radius::collect_candidates(study));
    all.extend(terms::collect_candidates(study));
    // A guess that reproduces no more than the right formula is not an explanation.
    let plain = study.count_reproduced();
    all.retain(|guess| guess.reproduced > plain);
    all.sort_by(|one, two| two.reproduced.cmp(&one.reproduced).then(one.cost.total_cmp(&two.cost)));
    all
}

/// Returns the guesses that the student changed the inputs or the formula in one of the ways of [`NAMED_EDITS`]. An
/// example is the use of positions at the end of the step.
fn collect_misunderstandings(study: &PolynomialStudy) -> Vec<Candidate> {
    let candidate = |named: &NamedEdit| {
        named.polynomial(study.subject, &study.cases.first()?.inputs)?;
        let predict = |case: &PolynomialSample| named.polynomial(study.subject, &case.inputs).unwrap_or_default();
        let (reproduced, scaled) = study.count_predicted(predict)?;
        Some(Candidate {
            guess: Guess::Named(named.key.into()),
            details: vec![PolynomialDetail::Named { key: named.key.into(), has_only_edge_pairs: false }],
            forms: Vec::new(),
            cost: named.cost + if scaled { 1.5 } else { 0.0 },
            reproduced,
        })
    };
    NAMED_EDITS.iter().filter_map(candidate).collect()
}

/// Returns the explanation that a polynomial is right except for round-off, but has more round-off than the rules
/// allow. Returns `None` if its error is larger, or if a guess reproduces all samples.
fn explain_nearly_right(suspect: &WrongPolynomial) -> Option<Explanation> {
    let study = &suspect.study;
    let (error, samples) = (study.max_error(), study.cases.len() as u64);
    (error < NEARLY_RIGHT_ERROR && suspect.complete_guesses().next().is_none()).then(|| Explanation {
        details: vec![Detail::Polynomial(PolynomialDetail::RightUpTo(error))],
        samples,
        example: example::find_smallest_example(study).map(|(_, example)| example),
        ..Explanation::with_topic(
            Explanation::NEARLY_RIGHT,
            ExplanationTopic::Polynomials { subjects: vec![study.subject], found: PolynomialEvidence::NearlyRight },
        )
    })
}

/// Returns one explanation with all unexplained polynomials, or `None` if there are none.
fn summarize_unexplained(unknown: &[WrongPolynomial]) -> Option<Explanation> {
    let first = unknown.first()?;
    let lines = |suspect: &WrongPolynomial| {
        let subject = (unknown.len() > 1).then_some(suspect.study.subject);
        suspect.study.count_differences(subject).into_iter().map(Detail::Polynomial)
    };
    Some(Explanation {
        details: take_distinct(unknown.iter().flat_map(lines), MAX_OTHER_KEYS),
        samples: unknown.iter().map(|suspect| suspect.study.cases.len() as u64).sum(),
        example: example::find_smallest_example(&first.study).map(|(_, example)| example),
        claims: take_distinct(unknown.iter().flat_map(|suspect| suspect.list_claims(std::iter::empty())), usize::MAX),
        ..Explanation::with_topic(
            Explanation::UNEXPLAINED,
            ExplanationTopic::Polynomials {
                subjects: unknown.iter().map(|suspect| suspect.study.subject).collect(),
                found: PolynomialEvidence::Nothing,
            },
        )
    })
}

/// Returns the key of the guess that reproduces all samples of the most polynomials. On a tie, it is the key with the
/// lowest total cost. Only guesses that can be the same mistake in several polynomials count ([`Guess::is_general`]),
/// and guesses about radii are left out. For each polynomial, only the first guess with the key is counted. Returns
/// `None` if no key covers at least two polynomials.
fn find_best_shared_key(open: &[WrongPolynomial]) -> Option<String> {
    let mut keys: BTreeMap<&str, (usize, f64)> = BTreeMap::new();
    for suspect in open {
        let mut seen_keys: Vec<&str> = Vec::new();
        // If radii of several kinds of pairs are wrong, other guesses describe the mistake better.
        let is_shared = |guess: &Guess| guess.is_general() && *guess != Guess::Quantity(QuantityGuess::Radius);
        for candidate in suspect.complete_guesses().filter(|candidate| is_shared(&candidate.guess)) {
            let key = candidate.guess.key();
            if !seen_keys.contains(&key) {
                seen_keys.push(key);
                let entry = keys.entry(key).or_default();
                *entry = (entry.0 + 1, entry.1 + candidate.cost);
            }
        }
    }
    let best = keys.into_iter().max_by(|one, two| one.1.0.cmp(&two.1.0).then(two.1.1.total_cmp(&one.1.1)))?;
    (best.1.0 > 1).then(|| best.0.to_owned())
}

/// Returns one explanation that several polynomials share.
fn explain_shared(covered: &[WrongPolynomial], key: &str) -> Explanation {
    let guesses: Vec<&Candidate> = covered
        .iter()
        .filter_map(|suspect| suspect.complete_guesses().find(|candidate| candidate.guess.key() == key))
        .collect();
    let subjects: Vec<Subject> = covered.iter().map(|suspect| suspect.study.subject).collect();
    let likely =
        covered[0].complete_guesses().filter(|candidate| candidate.cost <= guesses[0].cost + MAX_COST_DIFFERENCE);
    let others = likely.map(|candidate| candidate.guess.key()).filter(|other| {
        *other != key
            && covered.iter().all(|suspect| suspect.complete_guesses().any(|candidate| candidate.guess.key() == *other))
    });
    let samples = covered.iter().map(|suspect| suspect.study.cases.len() as u64).sum();
    let examples = covered.iter().filter_map(|suspect| example::find_smallest_example(&suspect.study));
    let details = guesses.iter().flat_map(|guess| &guess.details).map(|detail| guess_detail(detail.clone(), &subjects));
    let found = PolynomialEvidence::Guess(guesses[0].guess.clone());
    Explanation {
        details: take_distinct(details, MAX_OTHER_KEYS),
        reproduced: samples,
        samples,
        example: examples.min_by_key(|(digits, _)| *digits).map(|(_, example)| example),
        same_as: take_distinct(others.map(str::to_owned), MAX_OTHER_KEYS),
        claims: take_distinct(
            covered.iter().flat_map(|suspect| suspect.list_claims(suspect.complete_guesses())),
            usize::MAX,
        ),
        ..Explanation::with_topic(key, ExplanationTopic::Polynomials { subjects, found })
    }
}

/// Returns the first `max_values` distinct values, in order.
fn take_distinct<T: PartialEq>(all: impl IntoIterator<Item = T>, max_values: usize) -> Vec<T> {
    let mut list: Vec<T> = Vec::new();
    for one in all {
        if !list.contains(&one) && list.len() < max_values {
            list.push(one);
        }
    }
    list
}
