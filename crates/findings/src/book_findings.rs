//! The findings of a rule book in a trace. Both rule books use the same type.
use super::{counts::FindingCounts, finding::Finding};

/// The findings of one rule book.
#[derive(Debug, Clone, Default)]
pub struct BookFindings {
    /// The number of findings of each kind.
    pub counts: FindingCounts,
    /// The number of steps with at least one finding; the initial record is not a step.
    pub wrong_steps: u64,
    /// The first finding of each kind that occurred, in the order of [`FindingKind::ALL`](super::FindingKind::ALL).
    pub examples: Vec<Finding>,
    /// The earliest finding of the trace.
    pub first_divergence: Option<Finding>,
}

impl BookFindings {
    /// Keeps a finding if it is the first, or the first of its kind.
    pub fn keep_first(&mut self, first: &Finding) {
        if self.first_divergence.is_none() {
            self.first_divergence = Some(*first);
        }
        if !self.examples.iter().any(|example| example.kind() == first.kind()) {
            self.examples.push(*first);
        }
    }

    /// Sorts the examples after all of them were added.
    pub fn conclude(&mut self) {
        self.examples.sort_by_key(Finding::kind);
    }
}
