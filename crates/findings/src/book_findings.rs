//! The findings of one rule book in a trace: the same type for both.
use super::{counts::FindingCounts, finding::Finding};

/// The findings of one book.
#[derive(Debug, Clone, Default)]
pub struct BookFindings {
    /// Counts per kind of finding.
    pub counts: FindingCounts,
    /// Steps with at least one finding; the initial record is not a step.
    pub wrong_steps: u64,
    /// The first finding of each kind that occurred, in the order of [`FindingKind::ALL`](super::FindingKind::ALL).
    pub examples: Vec<Finding>,
    /// The very first finding.
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

    /// Sorts the examples, once all of them are there.
    pub fn conclude(&mut self) {
        self.examples.sort_by_key(Finding::kind);
    }
}
