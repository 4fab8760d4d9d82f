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
    /// A mistake of the catalogue, with this key.
    Mistake,
    /// Stages that are not written yet; their keys are in [`Explanation::same_as`](super::Explanation::same_as).
    Unfinished,
    /// The question whether the trace is of its scene.
    Scene {
        /// Whether at least the number of records is right.
        has_length: bool,
    },
    /// Wrong polynomials.
    Polynomials {
        /// Which ones.
        subjects: Vec<Subject>,
        /// The facts that are found out about them.
        found: OfPolynomials,
    },
    /// A stage of a step: its results are wrong, and everything before is right.
    Stage(StageFault),
    /// Near pairs that a contest's search leaves out or reports twice: an observation.
    Pairs(WrongPairs),
    /// Values that are not finite numbers: an observation, which comes before all guesses.
    NotFinite(NotFinite),
}

impl About {
    /// Returns the kinds of pairs whose polynomials it is about, each once.
    #[must_use]
    pub fn kinds(&self) -> Vec<PairKind> {
        let Self::Polynomials { subjects, .. } = self else { return Vec::new() };
        PairKind::ALL.into_iter().filter(|kind| subjects.iter().any(|subject| subject.kind() == *kind)).collect()
    }
}

/// The facts that are found out about wrong polynomials.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum OfPolynomials {
    /// A guess that reproduces them, or a part.
    Guess(Guess),
    /// The polynomials are not handed over.
    Missing,
    /// The polynomials are right except for too much round-off.
    NearlyRight,
    /// Nothing.
    Nothing,
}
