//! Data types for explanations of wrong traces. Reports turn them into sentences.
mod area;
pub mod detail;
pub mod example;
pub mod fault;
pub mod guess;
mod input;
mod reading;
mod subject;
pub mod topic;
pub mod wrong_pairs;

pub use area::Area;
pub use detail::{Amount, Detail, PolynomialDetail, Ratios, StageDetail, Substitute, Weight};
pub use example::{Example, ExamplePlace, ExampleValue, StepRecord};
pub use fault::{
    ChangeRatio, ChangedParticles, ChangedQuantity, GeometricPartError, LoopEnd, NanStage, NonFiniteValue, Quantity,
    RoundCountError, StageFault, StepStage, WrongChange, WrongDecisions, WrongMotion, WrongPositions, WrongResponses,
    WrongVectors, WrongZoneRounds, WrongZones,
};
pub use guess::{CoefficientGuess, Guess, ListGuess, QuantityGuess};
pub use input::Input;
pub use reading::Reading;
pub use subject::Subject;
pub use topic::{ExplanationTopic, PolynomialEvidence};
pub use wrong_pairs::{PairCounts, WrongPairs};

use fosssim_model::sim::PairKind;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// An explanation of what is wrong with a program: a likely mistake or an observation, with the evidence for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Explanation {
    /// The name of the explanation, which never changes. It is the id of a known mistake (such as `pe-square-no-eh`),
    /// or the name of a general finding (such as `reversed`).
    pub key: String,
    /// The subject of the explanation, with the facts that a sentence can state without revealing a formula.
    #[serde(rename = "about")]
    pub topic: ExplanationTopic,
    /// The lines that describe the fault completely, such as the terms of each coefficient and their weights. They may
    /// reveal the right formula.
    pub details: Vec<Detail>,
    /// The number of samples that the mistake reproduces up to round-off.
    pub reproduced: u64,
    /// The number of samples that were checked. A sample is a polynomial or a step.
    pub samples: u64,
    /// A small example, if there is one.
    pub example: Option<Example>,
    /// The keys of other known mistakes that reproduce the same samples. The trace cannot distinguish them from this
    /// one.
    pub same_as: Vec<String>,
    /// The keys of mistakes that the trace refutes: no program with such a mistake could write the trace.
    #[serde(rename = "denies")]
    pub contradicted_keys: Vec<String>,
    /// All guesses that would produce the polynomials; the explanation's own guess is first. Each is a string with two
    /// slashes: `EdgeOverlap/DIGEST/FORM` for a guess and a digest of its exact form, `EdgeOverlap/DIGEST/` for a guess
    /// without forms, `EdgeOverlap/ID/` for a known mistake, and `EdgeOverlap//` if there is no guess. Digests do not
    /// reveal a formula.
    pub claims: Vec<String>,
}

impl Explanation {
    /// The key of the explanation that the trace probably belongs to another scene. No other explanation is reported
    /// with it.
    pub const OTHER_SCENE: &'static str = "other-scene";

    /// The key for stages that are not written. They are reported in one explanation.
    pub const UNFINISHED: &'static str = "unfinished";

    /// The key for pairs that are checked in the wrong order.
    pub const ORDER: &'static str = StageFault::Order.key();

    /// The key for nearby pairs that a contest's search misses or reports twice.
    pub const PAIRS: &'static str = "near-pairs";

    /// The key for values that are not finite numbers.
    pub const NOT_FINITE: &'static str = "not-a-number";

    /// The key for polynomials that are wrong without an explanation.
    pub const UNEXPLAINED: &'static str = "unexplained";

    /// The key for polynomials that are right, but have too much round-off.
    pub const NEARLY_RIGHT: &'static str = "nearly-right";

    /// The key for polynomials that the program never passes to the root finder.
    pub const MISSING_POLYNOMIALS: &'static str = "missing-polynomials";

    /// Returns whether a key can belong to an explanation that names no known mistake.
    pub fn is_general_key(key: &str) -> bool {
        let constants = [
            Self::OTHER_SCENE,
            Self::UNFINISHED,
            Self::PAIRS,
            Self::NOT_FINITE,
            Self::UNEXPLAINED,
            Self::NEARLY_RIGHT,
            Self::MISSING_POLYNOMIALS,
        ];
        constants.contains(&key)
            || key.starts_with("stage-")
            || QuantityGuess::ALL.iter().any(|guess| guess.name() == key)
            || ListGuess::ALL.iter().any(|guess| guess.name() == key)
            || CoefficientGuess::ALL.iter().any(|guess| guess.name() == key)
    }

    /// Creates an explanation that has no evidence yet.
    pub fn with_topic(key: impl Into<String>, about: ExplanationTopic) -> Self {
        Self {
            key: key.into(),
            topic: about,
            details: Vec::new(),
            reproduced: 0,
            samples: 0,
            example: None,
            same_as: Vec::new(),
            contradicted_keys: Vec::new(),
            claims: Vec::new(),
        }
    }

    /// Creates the explanation that a trace probably belongs to another scene. `has_length` is true if the trace has
    /// the right number of records.
    pub fn for_other_scene(has_length: bool) -> Self {
        Self::with_topic(Self::OTHER_SCENE, ExplanationTopic::Scene { has_length })
    }

    /// Creates an explanation of wrong polynomials without details.
    pub fn for_wrong_polynomials(subjects: Vec<Subject>, found: PolynomialEvidence) -> Self {
        Self::with_topic(Self::UNEXPLAINED, ExplanationTopic::Polynomials { subjects, found })
    }

    /// Returns whether the explanation is that the trace probably belongs to another scene.
    pub fn is_other_scene(&self) -> bool {
        matches!(self.topic, ExplanationTopic::Scene { .. })
    }

    /// Returns whether the explanation reports the first value that is not finite. All levels of hints show it, except
    /// for the lowest.
    pub const fn reports_non_finite_value(&self) -> bool {
        matches!(self.topic, ExplanationTopic::NotFinite(_))
    }

    /// Returns whether the explanation is a known mistake that reproduces every sample.
    pub fn is_proven(&self) -> bool {
        self.topic == ExplanationTopic::Mistake && self.reproduced > 0 && self.is_complete()
    }

    /// Returns whether the explanation names stages that are not written.
    pub fn is_unfinished(&self) -> bool {
        self.topic == ExplanationTopic::Unfinished
    }

    /// Returns whether the explanation only says that polynomials are wrong.
    pub fn is_unexplained(&self) -> bool {
        self.key == Self::UNEXPLAINED
    }

    /// Returns whether the explanation reports polynomials that are not passed to the root finder.
    pub fn reports_missing_polynomials(&self) -> bool {
        matches!(self.topic, ExplanationTopic::Polynomials { found: PolynomialEvidence::Missing, .. })
    }

    /// Returns whether the explanation is that the pairs are in another order, or that some are left out.
    pub fn is_about_pairs(&self) -> bool {
        [Self::ORDER, "stage-pairs-skipped"].contains(&self.key.as_str())
    }

    /// Returns a key for the explanation's sentence. Explanations have the same key if and only if they have the same
    /// sentence.
    pub fn statement(&self) -> String {
        match &self.topic {
            ExplanationTopic::Polynomials { found: PolynomialEvidence::Guess(guess), .. } if guess.is_general() => {
                guess.claim_key()
            }
            ExplanationTopic::Polynomials { found: PolynomialEvidence::Guess(_), .. } => {
                self.claims.first().unwrap_or(&self.key).clone()
            }
            ExplanationTopic::Stage(fault) => format!("{}/{fault:?}", self.key),
            ExplanationTopic::NotFinite(found) => format!("{}/{:?}", self.key, found.stage),
            _ => self.key.clone(),
        }
    }

    /// Returns the wrong polynomials that the explanation is about; empty if it is about something else.
    pub fn subjects(&self) -> Vec<Subject> {
        if let ExplanationTopic::Polynomials { subjects, .. } = &self.topic {
            return subjects.clone();
        }
        let claims = self.claims_by_subject();
        let all = PairKind::ALL.into_iter().flat_map(Subject::all_of_kind).copied();
        all.filter(|subject| claims.contains_key(format!("{subject:?}").as_str())).collect()
    }

    /// Returns the claims, grouped by polynomial. Each claim is listed with its guess or known mistake, and as a whole.
    pub fn claims_by_subject(&self) -> BTreeMap<&str, Vec<(&str, &str)>> {
        let mut all: BTreeMap<&str, Vec<(&str, &str)>> = BTreeMap::new();
        // A guess that reproduces only a part explains no polynomial completely.
        let is_part = matches!(self.topic, ExplanationTopic::Polynomials { found: PolynomialEvidence::Guess(_), .. })
            && !self.is_complete();
        for (number, claim) in self.claims.iter().enumerate() {
            let mut parts = claim.split('/');
            let (Some(subject), Some(guess)) = (parts.next(), parts.next()) else { continue };
            let subject_claims = all.entry(subject).or_default();
            if !(guess.is_empty() || is_part && number == 0) {
                subject_claims.push((guess, claim));
            }
        }
        all
    }

    /// Returns whether the explanation names a wrong stage of a step. That is an observation, not a guess.
    pub fn names_stage(&self) -> bool {
        self.stage().is_some()
    }

    /// Returns whether the explanation only says that a stage is wrong.
    pub const fn is_vague(&self) -> bool {
        matches!(
            self.topic,
            ExplanationTopic::Stage(StageFault::AfterRounds | StageFault::FirstRound | StageFault::ManyContacts)
        )
    }

    /// Returns the stage of a step that is wrong, if the explanation names one.
    pub fn stage(&self) -> Option<StepStage> {
        match &self.topic {
            ExplanationTopic::Stage(fault) => Some(fault.stage()),
            _ => None,
        }
    }

    /// Returns whether the explanation reproduces every sample.
    pub const fn is_complete(&self) -> bool {
        self.reproduced == self.samples && self.samples > 0
    }

    /// Returns whether the explanation is about the program, and not about this trace alone. Other traces may then
    /// confirm it.
    pub fn is_about_program(&self) -> bool {
        use PolynomialEvidence::{NearlyRight, Nothing};
        let is_nothing = matches!(self.topic, ExplanationTopic::Polynomials { found: Nothing | NearlyRight, .. });
        !is_nothing && !self.is_other_scene() && !self.reports_non_finite_value()
    }

    /// Returns whether the explanation reproduces every sample or names a wrong stage.
    pub fn is_exhaustive(&self) -> bool {
        self.is_complete() || self.names_stage()
    }
}
