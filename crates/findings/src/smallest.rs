//! The smallest scene on which a program is still wrong for the same reason, as a value.
use super::{Hints, disclosure::DisclosedFinding, explanation::Explanation};
use serde::{Deserialize, Serialize};

/// The smallest scene for a cause.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SmallestScene {
    /// The name of the original scene.
    pub origin: String,
    /// The path of the program, as commands use it.
    pub program: String,
    /// The scene file's content.
    pub xml: String,
    /// The number of bodies.
    pub bodies: usize,
    /// The number of steps.
    pub steps: u32,
    /// The command that makes the same scene again.
    pub again: String,
    /// The number of times that the program was run.
    pub runs: u32,
    /// Whether no single change makes the scene smaller; false if the search was stopped early.
    pub is_minimal: bool,
    /// The end of the program, if it did not end well.
    pub note: Option<String>,
    /// The first fault, if hints show it.
    pub first: Option<DisclosedFinding>,
    /// The likely mistakes, beginning with the cause.
    pub explanations: Vec<Explanation>,
    /// The values that differ, as text; only with full hints.
    pub differs: Option<String>,
    /// The reference's computation of the first wrong step; only with full hints.
    pub by_hand: Option<String>,
    /// The scene's card on a page; with full hints only.
    pub card: Option<String>,
}

impl SmallestScene {
    /// Returns the size of the scene, for comparing scenes.
    #[must_use]
    pub const fn size(&self) -> (u32, usize, usize) {
        (self.steps, self.bodies, self.xml.len())
    }

    /// Returns whether `found` contains no scene with the same content or cause.
    #[must_use]
    pub fn is_new(&self, found: &[Self]) -> bool {
        let cause = |one: &Self| one.explanations.first().filter(|cause| cause.is_vote()).map(Explanation::statement);
        found.iter().all(|one| one.xml != self.xml && (cause(one).is_none() || cause(one) != cause(self)))
    }

    /// Removes everything that the hints do not allow, except for the explanations.
    pub fn cut(&mut self, hints: Hints) {
        if hints < Hints::Full {
            (self.differs, self.by_hand, self.card) = (None, None, None);
            self.first = self.first.take().and_then(|first| hints.cut(first));
        }
    }
}
