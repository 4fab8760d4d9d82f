//! What an explanation says, as values: sentences are made of it where reports are.
use super::{
    about::{About, OfPolynomials},
    detail::Detail,
    example::Example,
    fault::{self, StepStage},
};
use crate::student::{Row, find};

/// A likely mistake, with the evidence for it.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// A stable key for machines: the id of a known mistake (`pe-square-no-eh`) or of a general finding (`reversed`).
    pub key: String,
    /// What is wrong: what can be said in a sentence to the student without giving a formula away.
    pub about: About,
    /// The exact form, a line each: which term of which coefficient has which weight. May give the right formula away.
    pub details: Vec<Detail>,
    /// Of the samples that were looked at, how many it reproduces to round-off.
    pub reproduced: u64,
    /// Samples that were looked at: polynomials, or steps.
    pub samples: u64,
    /// One small example.
    pub example: Option<Example>,
    /// Keys of other known mistakes that reproduce the same samples: this trace can't tell them apart.
    pub same_as: Vec<String>,
    /// Keys of empty stages that the trace speaks against: it shows something of them.
    pub denies: Vec<String>,
}

impl Explanation {
    /// The key of the question whether a trace is of its scene, which is no explanation: nothing else is said then.
    pub const OTHER_SCENE: &'static str = "other-scene";

    /// The key of stages that are still empty, told as one ([`several`](super::several)).
    pub const UNFINISHED: &'static str = "unfinished";

    /// The key of pairs that are looked at in another order.
    pub const ORDER: &'static str = fault::ORDER;

    /// The key of what is no finite number.
    pub const NOT_FINITE: &'static str = "not-a-number";

    /// The key of what nothing is known to explain.
    pub(super) const UNEXPLAINED: &'static str = "unexplained";

    /// The key of what is right but for too much round-off.
    pub const NEARLY_RIGHT: &'static str = "nearly-right";

    /// The question whether a trace is of its scene; `has_length` says that at least the number of records is right.
    pub(super) fn of_other_scene(has_length: bool) -> Self {
        Self {
            key: Self::OTHER_SCENE.to_owned(),
            about: About::Scene { has_length },
            details: Vec::new(),
            reproduced: 0,
            samples: 0,
            example: None,
            same_as: Vec::new(),
            denies: Vec::new(),
        }
    }

    /// Whether this is the question whether the trace is of its scene.
    #[must_use]
    pub fn is_other_scene(&self) -> bool {
        matches!(self.about, About::Scene { .. })
    }

    /// Whether it says from where on there is what is no finite number: at every level of hints but the lowest.
    #[must_use]
    pub const fn is_not_finite(&self) -> bool {
        matches!(self.about, About::NotFinite(_))
    }

    /// Whether it names stages that are still empty.
    #[must_use]
    pub fn is_unfinished(&self) -> bool {
        self.about == About::Unfinished
    }

    /// Whether it says of polynomials that nothing explains them.
    #[must_use]
    pub(super) fn is_unexplained(&self) -> bool {
        matches!(self.about, About::Polynomials { found: OfPolynomials::Nothing, .. })
    }

    /// Whether it says that polynomials are not handed over.
    #[must_use]
    pub(super) fn is_of_missing(&self) -> bool {
        matches!(self.about, About::Polynomials { found: OfPolynomials::Missing, .. })
    }

    /// Whether these explanations of a trace name it, told or as not to be told apart; of what is not written yet, one stage.
    #[must_use]
    pub fn is_named_in(&self, explanations: &[Self]) -> bool {
        let stages = if self.is_unfinished() { self.same_as.as_slice() } else { &[] };
        let is_meant = |key: &String| *key == self.key || stages.contains(key);
        let row = find(&self.key);
        explanations.iter().any(|one| {
            is_meant(&one.key)
                || one.same_as.iter().any(is_meant)
                || row.is_some_and(|row| one.is_in_other_words(row) && one.is_complete())
        })
    }

    /// Whether this, found in the polynomials of one kind alone, is this known mistake: `radii-squared-apart` of particles and
    /// edges is `pe-radii-squared-apart`.
    pub(super) fn is_in_other_words(&self, row: &Row) -> bool {
        let is_called_so = row.id.split_once('-').is_some_and(|(_, own)| own == self.key);
        let About::Polynomials { subjects, .. } = &self.about else { return false };
        is_called_so && subjects.first().is_some_and(|first| Some(first.kind()) == row.kind_of_pair())
    }

    /// Whether it says which stage of a step is wrong, which is an observation and no guess.
    #[must_use]
    pub fn is_of_stage(&self) -> bool {
        self.stage().is_some()
    }

    /// The stage of a step that it says is wrong.
    pub(super) fn stage(&self) -> Option<StepStage> {
        match &self.about {
            About::Stage(fault) => Some(fault.stage()),
            _ => None,
        }
    }

    /// Whether it reproduces everything that was looked at.
    #[must_use]
    pub const fn is_complete(&self) -> bool {
        self.reproduced == self.samples && self.samples > 0
    }
}
