//! The smallest scene that was found on which a program is still wrong for the same reason.
use super::{Hints, disclosure::DisclosedFinding, explanation::Explanation};
use serde::{Deserialize, Serialize};

/// The smallest scene that was found on which the program makes a given mistake.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SmallestScene {
    /// The name of the scene from which this one was made.
    pub origin: String,
    /// The path of the program, as commands use it.
    pub program: String,
    /// The content of the scene's file.
    pub xml: String,
    /// The number of bodies in the scene.
    pub bodies: usize,
    /// The number of steps that the scene has.
    pub steps: u32,
    /// The command that finds the same scene again.
    #[serde(rename = "again")]
    pub command: String,
    /// The number of times that the program was run.
    pub runs: u32,
    /// Whether no single change makes the scene smaller; false if the search was stopped early.
    pub is_minimal: bool,
    /// A note on how the program ended; `None` if it ended normally.
    pub note: Option<String>,
    /// The first fault, if the hints show it.
    #[serde(rename = "first")]
    pub first_finding: Option<DisclosedFinding>,
    /// The likely mistakes. The first one is the cause for which the scene was made.
    pub explanations: Vec<Explanation>,
    /// The values that differ, as text; `None` without full hints.
    #[serde(rename = "differs")]
    pub difference: Option<String>,
    /// The reference's computation of the first wrong step, as text; `None` without full hints.
    #[serde(rename = "by_hand")]
    pub calculation: Option<String>,
    /// The name of the stored card that shows the scene; `None` without full hints.
    pub card: Option<String>,
}

impl SmallestScene {
    /// Returns the size of the scene, by which scenes are compared.
    pub const fn size(&self) -> (u32, usize, usize) {
        (self.steps, self.bodies, self.xml.len())
    }

    /// Removes everything that the hints do not allow, except for the explanations.
    pub fn limit_to_hints(&mut self, hints: Hints) {
        if hints < Hints::Full {
            (self.difference, self.calculation, self.card) = (None, None, None);
            self.first_finding = self.first_finding.take().and_then(|first| hints.limit_finding(first));
        }
    }
}
