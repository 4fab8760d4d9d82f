//! The smallest scene on which a program is still wrong for the same reason, as a value.
use super::{Hints, disclosure::DisclosedFinding, explanation::Explanation};
use serde::{Deserialize, Serialize};

/// The smallest scene for a cause.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SmallestScene {
    /// The name of the scene that it was made from.
    pub origin: String,
    /// The program, as a command names it.
    pub program: String,
    /// The scene, as a file.
    pub xml: String,
    /// The number of bodies.
    pub bodies: usize,
    /// The number of steps.
    pub steps: u32,
    /// The command that finds the scene again.
    pub again: String,
    /// The number of runs of the program.
    pub runs: u32,
    /// Whether no single attempt makes it smaller; else the search was stopped.
    pub is_minimal: bool,
    /// The way the program ended, where it did not end well.
    pub note: Option<String>,
    /// The first thing that is wrong, if hints show it.
    pub first: Option<DisclosedFinding>,
    /// Likely mistakes, the cause first.
    pub explanations: Vec<Explanation>,
    /// The values that differ, in words; with full hints only.
    pub differs: Option<String>,
    /// The reference's computation of the first wrong step; with full hints only.
    pub by_hand: Option<String>,
    /// The scene's card on a page; with full hints only.
    pub card: Option<String>,
}

impl SmallestScene {
    /// Returns the measure by which a scene is smaller than another.
    #[must_use]
    pub const fn size(&self) -> (u32, usize, usize) {
        (self.steps, self.bodies, self.xml.len())
    }

    /// Returns whether none of these has the same scene, or shows the same cause.
    #[must_use]
    pub fn is_new(&self, found: &[Self]) -> bool {
        let cause = |one: &Self| one.explanations.first().filter(|cause| cause.is_vote()).map(Explanation::statement);
        found.iter().all(|one| one.xml != self.xml && (cause(one).is_none() || cause(one) != cause(self)))
    }

    /// Cuts the scene down to what hints allow for students, except for its explanations.
    pub fn cut(&mut self, hints: Hints) {
        if hints < Hints::Full {
            (self.differs, self.by_hand, self.card) = (None, None, None);
            self.first = self.first.take().and_then(|first| hints.cut(first));
        }
    }
}
