//! Explanations, as values; reports turn them into sentences.
pub mod about;
mod area;
pub mod detail;
pub mod example;
pub mod fault;
pub mod guess;
mod input;
pub mod near;
mod reading;
mod subject;

pub use about::{About, OfPolynomials};
pub use area::Area;
pub use detail::{Amount, Detail, PolynomialDetail, Ratios, StageDetail, Substitute, Weight};
pub use example::{Example, ExamplePlace, ExampleValue, StepRecord};
pub use fault::{
    ChangeCause, ChangeRatio, ChangedParticles, ChangedQuantity, LoopEnd, NanStage, NotFinite, Quantity, StageFault,
    StepStage, WrongChange, WrongDecisions, WrongGeometric, WrongMotion, WrongNumber, WrongPositions, WrongResponses,
    WrongVectors, WrongZoneRounds, WrongZones,
};
pub use guess::{CoefficientGuess, Guess, ListGuess, QuantityGuess};
pub use input::Input;
pub use near::{PairCounts, WrongPairs};
pub use reading::Reading;
pub use subject::Subject;

use fosssim_model::sim::PairKind;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A likely mistake, with the evidence for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Explanation {
    /// A stable key for machines: the id of a known mistake (such as `pe-square-no-eh`) or of a general finding (such
    /// as `reversed`).
    pub key: String,
    /// The subject of the explanation, with the facts that a sentence can state without revealing a formula.
    pub about: About,
    /// The exact form, line by line: the terms of each coefficient and their weights. It may reveal the right formula.
    pub details: Vec<Detail>,
    /// The number of checked samples that the mistake reproduces to round-off.
    pub reproduced: u64,
    /// The number of checked samples, which are polynomials or steps.
    pub samples: u64,
    /// One small example.
    pub example: Option<Example>,
    /// Keys of other known mistakes that reproduce the same samples; this trace cannot distinguish them.
    pub same_as: Vec<String>,
    /// Keys of mistakes that the trace contradicts, because no program with such a mistake could write the trace.
    pub denies: Vec<String>,
    /// All guesses that would produce the polynomials, one word each. A word consists of the polynomial and the known
    /// mistake, or of the polynomial, a digest of the guess and a digest of its exact form. Digests do not reveal a
    /// formula. The explanation's own guess comes first. For a polynomial without a guess, the word is only its name.
    pub claims: Vec<String>,
}

impl Explanation {
    /// The key of the explanation that the trace probably belongs to another scene. It is reported alone.
    pub const OTHER_SCENE: &'static str = "other-scene";

    /// The key of unwritten stages, which are reported together.
    pub const UNFINISHED: &'static str = "unfinished";

    /// The key of pairs that are checked in the wrong order.
    pub const ORDER: &'static str = StageFault::Order.key();

    /// The key of near pairs that a contest's search misses or reports twice.
    pub const PAIRS: &'static str = "near-pairs";

    /// The key of values that are not finite numbers.
    pub const NOT_FINITE: &'static str = "not-a-number";

    /// The key of faults without any explanation.
    pub const UNEXPLAINED: &'static str = "unexplained";

    /// The key of polynomials that are right except for too much round-off.
    pub const NEARLY_RIGHT: &'static str = "nearly-right";

    /// The key of polynomials that no detection logs.
    pub const MISSING_POLYNOMIALS: &'static str = "missing-polynomials";

    /// Returns whether an explanation that names no mistake of the catalogue may have this key.
    #[must_use]
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

    /// Creates an explanation without evidence.
    #[must_use]
    pub fn about(key: impl Into<String>, about: About) -> Self {
        Self {
            key: key.into(),
            about,
            details: Vec::new(),
            reproduced: 0,
            samples: 0,
            example: None,
            same_as: Vec::new(),
            denies: Vec::new(),
            claims: Vec::new(),
        }
    }

    /// Creates the explanation that a trace probably belongs to another scene. `has_length` is whether the number of
    /// records is right.
    #[must_use]
    pub fn for_other_scene(has_length: bool) -> Self {
        Self::about(Self::OTHER_SCENE, About::Scene { has_length })
    }

    /// Creates an explanation of wrong polynomials without an exact form.
    #[must_use]
    pub fn for_wrong(subjects: Vec<Subject>, found: OfPolynomials) -> Self {
        Self::about(Self::UNEXPLAINED, About::Polynomials { subjects, found })
    }

    /// Returns whether the explanation is that the trace probably belongs to another scene.
    #[must_use]
    pub fn is_other_scene(&self) -> bool {
        matches!(self.about, About::Scene { .. })
    }

    /// Returns whether the explanation reports the first value that is not finite; every level of hints except the
    /// lowest shows it.
    #[must_use]
    pub const fn is_not_finite(&self) -> bool {
        matches!(self.about, About::NotFinite(_))
    }

    /// Returns whether the explanation is a known mistake that reproduces every sample.
    #[must_use]
    pub fn is_proven(&self) -> bool {
        self.about == About::Mistake && self.reproduced > 0 && self.is_complete()
    }

    /// Returns whether the explanation names stages that the student has not written.
    #[must_use]
    pub fn is_unfinished(&self) -> bool {
        self.about == About::Unfinished
    }

    /// Returns whether the explanation reports wrong polynomials without an exact form.
    #[must_use]
    pub fn is_unexplained(&self) -> bool {
        self.key == Self::UNEXPLAINED
    }

    /// Returns whether the explanation reports polynomials that are not handed over.
    #[must_use]
    pub fn is_of_missing(&self) -> bool {
        matches!(self.about, About::Polynomials { found: OfPolynomials::Missing, .. })
    }

    /// Returns a key of the statement: equal for explanations with the same text, different for others.
    #[must_use]
    pub fn statement(&self) -> String {
        match &self.about {
            About::Polynomials { found: OfPolynomials::Guess(guess), .. } if guess.is_general() => guess.word(),
            About::Polynomials { found: OfPolynomials::Guess(_), .. } => {
                self.claims.first().unwrap_or(&self.key).clone()
            }
            About::Stage(fault) => format!("{}/{fault:?}", self.key),
            About::NotFinite(found) => format!("{}/{:?}", self.key, found.stage),
            _ => self.key.clone(),
        }
    }

    /// Returns the wrong polynomials, if the explanation is about polynomials.
    #[must_use]
    pub fn subjects(&self) -> Vec<Subject> {
        if let About::Polynomials { subjects, .. } = &self.about {
            return subjects.clone();
        }
        let claims = self.claims_by_subject();
        let all = PairKind::ALL.into_iter().flat_map(Subject::all_of_kind).copied();
        all.filter(|subject| claims.contains_key(format!("{subject:?}").as_str())).collect()
    }

    /// Groups the claims by polynomial, each with its guess or known mistake, and the whole word.
    #[must_use]
    pub fn claims_by_subject(&self) -> BTreeMap<&str, Vec<(&str, &str)>> {
        let mut all: BTreeMap<&str, Vec<(&str, &str)>> = BTreeMap::new();
        // A guess that reproduces only a part explains no polynomial completely.
        let is_part =
            matches!(self.about, About::Polynomials { found: OfPolynomials::Guess(_), .. }) && !self.is_complete();
        for (number, claim) in self.claims.iter().enumerate() {
            let mut parts = claim.split('/');
            let (Some(subject), Some(guess)) = (parts.next(), parts.next()) else { continue };
            let of_subject = all.entry(subject).or_default();
            if !(guess.is_empty() || is_part && number == 0) {
                of_subject.push((guess, claim));
            }
        }
        all
    }

    /// Returns whether the explanation names a wrong stage of a step, which is an observation and not a guess.
    #[must_use]
    pub fn is_of_stage(&self) -> bool {
        self.stage().is_some()
    }

    /// Returns whether the explanation only states that a stage is wrong.
    #[must_use]
    pub const fn is_vague(&self) -> bool {
        matches!(self.about, About::Stage(StageFault::AfterRounds | StageFault::FirstRound | StageFault::ManyContacts))
    }

    /// Returns the stage of a step that the explanation reports as wrong.
    #[must_use]
    pub fn stage(&self) -> Option<StepStage> {
        match &self.about {
            About::Stage(fault) => Some(fault.stage()),
            _ => None,
        }
    }

    /// Returns whether the explanation reproduces every sample.
    #[must_use]
    pub const fn is_complete(&self) -> bool {
        self.reproduced == self.samples && self.samples > 0
    }

    /// Returns whether the explanation is about the program, so that other traces may confirm it.
    #[must_use]
    pub fn is_vote(&self) -> bool {
        use OfPolynomials::{NearlyRight, Nothing};
        let is_nothing = matches!(self.about, About::Polynomials { found: Nothing | NearlyRight, .. });
        !is_nothing && !self.is_other_scene() && !self.is_not_finite()
    }

    /// Returns whether the explanation covers all its polynomials or stages.
    #[must_use]
    pub fn is_settled(&self) -> bool {
        self.is_complete() || self.is_of_stage()
    }
}
