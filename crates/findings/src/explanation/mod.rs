//! Explanations as values: sentences are made of them where reports are.
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
    /// A stable key for machines: the id of a known mistake (`pe-square-no-eh`) or of a general finding (`reversed`).
    pub key: String,
    /// The mistake, with what a sentence to the student can say of it without giving a formula away.
    pub about: About,
    /// The exact form, a line each: which term of which coefficient has which weight. May give the right formula away.
    pub details: Vec<Detail>,
    /// The number of checked samples that it reproduces to round-off.
    pub reproduced: u64,
    /// The number of samples that were examined: polynomials, or steps.
    pub samples: u64,
    /// One small example.
    pub example: Option<Example>,
    /// Keys of other known mistakes that reproduce the same samples, so that this trace can't distinguish them.
    pub same_as: Vec<String>,
    /// Keys of mistakes that the trace contradicts: it does what a program with these mistakes never does.
    pub denies: Vec<String>,
    /// All guesses that would make its polynomials as they are, one word each. A word has the polynomial, then the
    /// known mistake, or a digest of the guess and one of its exact form, which give nothing away. The guess of the
    /// explanation comes first. A polynomial that nothing makes has a word without a guess.
    pub claims: Vec<String>,
}

impl Explanation {
    /// The key of the question whether a trace is of its scene, which is no explanation: then there is no other.
    pub const OTHER_SCENE: &'static str = "other-scene";

    /// The key of stages that are still empty, reported as one.
    pub const UNFINISHED: &'static str = "unfinished";

    /// The key of pairs that are checked in another order.
    pub const ORDER: &'static str = StageFault::Order.key();

    /// The key of near pairs that a contest's search leaves out or reports twice.
    pub const PAIRS: &'static str = "near-pairs";

    /// The key of values that are not finite numbers.
    pub const NOT_FINITE: &'static str = "not-a-number";

    /// The key of what nothing is known to explain.
    pub const UNEXPLAINED: &'static str = "unexplained";

    /// The key of polynomials that are right except for too much round-off.
    pub const NEARLY_RIGHT: &'static str = "nearly-right";

    /// Returns an explanation without any evidence for it yet.
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

    /// Returns the question whether a trace is of its scene; `has_length` states that at least the number of records is
    /// right.
    #[must_use]
    pub fn for_other_scene(has_length: bool) -> Self {
        Self::about(Self::OTHER_SCENE, About::Scene { has_length })
    }

    /// Creates the explanation that these polynomials are wrong, without an exact form that holds in most traces.
    #[must_use]
    pub fn for_wrong(subjects: Vec<Subject>, found: OfPolynomials) -> Self {
        Self::about(Self::UNEXPLAINED, About::Polynomials { subjects, found })
    }

    /// Returns whether this is the question whether the trace is of its scene.
    #[must_use]
    pub fn is_other_scene(&self) -> bool {
        matches!(self.about, About::Scene { .. })
    }

    /// Returns whether it reports the first value that is not a finite number, which is shown at every level of hints
    /// but the lowest.
    #[must_use]
    pub const fn is_not_finite(&self) -> bool {
        matches!(self.about, About::NotFinite(_))
    }

    /// Returns whether it is a mistake that reproduces all tried samples.
    #[must_use]
    pub fn is_proven(&self) -> bool {
        self.about == About::Mistake && self.reproduced > 0 && self.is_complete()
    }

    /// Returns whether it names stages that are still empty.
    #[must_use]
    pub fn is_unfinished(&self) -> bool {
        self.about == About::Unfinished
    }

    /// Returns whether it reports wrong polynomials and has no exact form for them.
    #[must_use]
    pub fn is_unexplained(&self) -> bool {
        self.key == Self::UNEXPLAINED
    }

    /// Returns whether it reports polynomials that are not handed over.
    #[must_use]
    pub fn is_of_missing(&self) -> bool {
        matches!(self.about, About::Polynomials { found: OfPolynomials::Missing, .. })
    }

    /// Returns the statement in one word: equal for explanations in the same words, and different for others.
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

    /// Returns the polynomials that it is about, if it is about polynomials.
    #[must_use]
    pub fn subjects(&self) -> Vec<Subject> {
        if let About::Polynomials { subjects, .. } = &self.about {
            return subjects.clone();
        }
        let claims = self.claims_by_subject();
        let all = PairKind::ALL.into_iter().flat_map(Subject::all_of_kind).copied();
        all.filter(|subject| claims.contains_key(format!("{subject:?}").as_str())).collect()
    }

    /// Lists for each of its polynomials all that would make it: the guess or the known mistake, and the whole word.
    #[must_use]
    pub fn claims_by_subject(&self) -> BTreeMap<&str, Vec<(&str, &str)>> {
        let mut all: BTreeMap<&str, Vec<(&str, &str)>> = BTreeMap::new();
        // A guess that reproduces only a part makes none of the polynomials.
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

    /// Returns whether it reports which stage of a step is wrong, which is an observation and no guess.
    #[must_use]
    pub fn is_of_stage(&self) -> bool {
        self.stage().is_some()
    }

    /// Returns whether it only reports that something is wrong with a stage.
    #[must_use]
    pub const fn is_vague(&self) -> bool {
        matches!(self.about, About::Stage(StageFault::AfterRounds | StageFault::FirstRound | StageFault::ManyContacts))
    }

    /// Returns the stage of a step that it reports as wrong.
    #[must_use]
    pub fn stage(&self) -> Option<StepStage> {
        match &self.about {
            About::Stage(fault) => Some(fault.stage()),
            _ => None,
        }
    }

    /// Returns whether it reproduces everything that was examined.
    #[must_use]
    pub const fn is_complete(&self) -> bool {
        self.reproduced == self.samples && self.samples > 0
    }

    /// Returns whether it describes the program, so that other traces may confirm it.
    #[must_use]
    pub fn is_vote(&self) -> bool {
        use OfPolynomials::{NearlyRight, Nothing};
        let is_nothing = matches!(self.about, About::Polynomials { found: Nothing | NearlyRight, .. });
        !is_nothing && !self.is_other_scene() && !self.is_not_finite()
    }

    /// Returns whether it explains all that it is about, if that is possible.
    #[must_use]
    pub fn is_settled(&self) -> bool {
        self.is_complete() || self.is_of_stage()
    }
}
