//! What explanations are about.
use fosssim_model::sim::PairKind;

/// What an explanation is about.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum About {
    /// A mistake of the catalogue, the one of this key.
    Mistake,
    /// Stages that are not written yet; their keys are in [`Explanation::same_as`](super::Explanation::same_as).
    Unfinished,
    /// The question whether the trace is of its scene.
    Scene,
    /// Wrong polynomials.
    Polynomials {
        /// The kinds of their pairs, each polynomial's.
        kinds: Vec<PairKind>,
        /// What is found out about them.
        found: OfPolynomials,
    },
    /// A stage of a step: what it leaves is wrong, and everything before is right.
    Stage(StepStage),
}

/// What is found out about wrong polynomials.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OfPolynomials {
    /// A guess that reproduces them, or a part.
    Guess,
    /// They are not handed over.
    Missing,
    /// They are right but for too much round-off.
    NearlyRight,
    /// Nothing.
    Nothing,
}

/// The stages of a step that can be told apart, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum StepStage {
    /// Which pairs collide, and when.
    Detection,
    /// The vectors between colliding objects.
    ContactVectors,
    /// Responses and impulse rounds.
    Responses,
    /// Impact zones and the rigid failsafe.
    Zones,
}
