//! The subjects of explanations.
use super::{
    fault::{NonFiniteValue, StageFault},
    guess::Guess,
    subject::Subject,
    wrong_pairs::WrongPairs,
};
use fosssim_model::sim::PairKind;
use serde::{Deserialize, Serialize};

/// The subject of an explanation, with the facts that a sentence can state.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum ExplanationTopic {
    /// A known mistake, whose id is the explanation's key.
    Mistake,
    /// Stages that are not written yet; their keys are in [`Explanation::same_as`](super::Explanation::same_as).
    Unfinished,
    /// The trace probably belongs to another scene.
    Scene {
        /// Whether the trace has as many records as the scene requires.
        has_length: bool,
    },
    /// Wrong polynomials.
    Polynomials {
        /// The polynomials that are wrong.
        subjects: Vec<Subject>,
        /// The facts that are known about these polynomials.
        found: PolynomialEvidence,
    },
    /// A stage of a step whose results are wrong, although the results of all earlier stages are right.
    Stage(StageFault),
    /// Nearby pairs that a contest's search misses or reports twice. This is an observation, not a guess.
    Pairs(WrongPairs),
    /// Values that are not finite numbers. This is an observation, and reports show it before all guesses.
    NotFinite(NonFiniteValue),
}

impl ExplanationTopic {
    /// Returns the kinds of pairs that the wrong polynomials belong to. Each kind is listed once.
    pub fn kinds(&self) -> Vec<PairKind> {
        let Self::Polynomials { subjects, .. } = self else { return Vec::new() };
        PairKind::ALL.into_iter().filter(|kind| subjects.iter().any(|subject| subject.kind() == *kind)).collect()
    }
}

/// The facts that are known about wrong polynomials.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum PolynomialEvidence {
    /// A guess that reproduces all or some of the polynomials.
    Guess(Guess),
    /// The program does not pass the polynomials to the root finder.
    Missing,
    /// The polynomials are right, but have too much round-off.
    NearlyRight,
    /// Nothing is known except that they are wrong.
    Nothing,
}
