//! Tries misunderstandings that have a formula of their own.
use super::study::{Candidate, PolynomialStudy};
use crate::assignments::t2m2::specials::{SPECIALS, Special};
use crate::diagnose::{Guess, PolynomialDetail};

/// Those that reproduce at least half of the wrong samples.
pub(super) fn candidates(study: &PolynomialStudy) -> Vec<Candidate> {
    let of = |special: &Special| {
        let (reproduced, scaled) = study.count(|case| (special.polynomial)(&case.inputs))?;
        Some(Candidate {
            guess: Guess::Special(special.key.into()),
            details: vec![PolynomialDetail::Special(special.key.into())],
            cost: if scaled { 3.5 } else { 2.5 },
            reproduced,
            general: true,
        })
    };
    SPECIALS.iter().filter(|special| special.subject == study.subject).filter_map(of).collect()
}
