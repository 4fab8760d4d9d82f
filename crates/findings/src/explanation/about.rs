//! The subjects of explanations.
use super::{
    fault::{NotFinite, StageFault},
    guess::Guess,
    near::WrongPairs,
    subject::Subject,
};
use fosssim_model::sim::PairKind;
use serde::{Deserialize, Serialize};

/// The subject of an explanation.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum About {
    /// A known mistake; its id is the explanation's key.
    Mistake,
    /// Stages that are not written yet; their keys are in [`Explanation::same_as`](super::Explanation::same_as).
    Unfinished,
    /// The trace seems to belong to another scene.
    Scene {
        /// Whether the trace has the right number of records.
        has_length: bool,
    },
    /// Wrong polynomials.
    Polynomials {
        /// The wrong polynomials.
        subjects: Vec<Subject>,
        /// The facts that are known about these polynomials.
        found: OfPolynomials,
    },
    /// A stage of a step. Its results are wrong, and all earlier stages are right.
    Stage(StageFault),
    /// Near pairs that a contest's search misses or reports twice; an observation, not a guess.
    Pairs(WrongPairs),
    /// Values that are not finite numbers; an observation, listed before all guesses.
    NotFinite(NotFinite),
}

impl About {
    /// Returns the kinds of pairs that the wrong polynomials belong to, without repetition.
    #[must_use]
    pub fn kinds(&self) -> Vec<PairKind> {
        let Self::Polynomials { subjects, .. } = self else { return Vec::new() };
        PairKind::ALL.into_iter().filter(|kind| subjects.iter().any(|subject| subject.kind() == *kind)).collect()
    }
}

/// The facts that are known about wrong polynomials.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum OfPolynomials {
    /// A guess that reproduces all or some of the polynomials.
    Guess(Guess),
    /// The program does not hand the polynomials to the root finder.
    Missing,
    /// The polynomials are right except for too much round-off.
    NearlyRight,
    /// Nothing else is known.
    Nothing,
}
