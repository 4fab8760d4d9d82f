//! The findings of a rule book in a trace. Both rule books use the same type.
use super::{counts::FindingCounts, finding::Finding};

/// The findings of one rule book.
#[derive(Debug, Clone, Default)]
pub struct BookFindings {
    /// The number of findings of each kind.
    pub counts: FindingCounts,
    /// The number of steps with at least one finding. The initial record is not a step.
    pub wrong_steps: u64,
    /// The first finding of each kind that occurs, in the order of [`FindingKind::ALL`](super::FindingKind::ALL).
    pub examples: Vec<Finding>,
    /// The first finding in the trace, of any kind.
    pub first_divergence: Option<Finding>,
}

impl BookFindings {
    /// Keeps a finding if it is the first of the trace, or the first of its kind.
    pub fn keep_first(&mut self, first: &Finding) {
        if self.first_divergence.is_none() {
            self.first_divergence = Some(*first);
        }
        if !self.examples.iter().any(|example| example.kind() == first.kind()) {
            self.examples.push(*first);
        }
    }

    /// Sorts the examples. This is called after all findings were added.
    pub fn conclude(&mut self) {
        self.examples.sort_by_key(Finding::kind);
    }
}
