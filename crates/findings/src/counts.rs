//! Counts of findings by kind.
use super::finding::FindingKind;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The number of findings of each kind, in the order of [`FindingKind::ALL`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(into = "BTreeMap<FindingKind, u64>", from = "BTreeMap<FindingKind, u64>")]
pub struct FindingCounts([u64; FindingKind::ALL.len()]);

impl FindingCounts {
    /// Returns the count of one kind.
    pub fn get(&self, kind: FindingKind) -> u64 {
        self.0[kind as usize]
    }

    /// Adds `count` findings of one kind.
    pub fn add(&mut self, kind: FindingKind, count: u64) {
        self.0[kind as usize] += count;
    }

    /// Returns the number of findings that make the original's collision verdict fail. They concern collisions and
    /// polynomials.
    pub fn collisions(&self) -> u64 {
        self.total() - self.get(FindingKind::Position) - self.get(FindingKind::Velocity)
    }

    /// Returns the number of findings of all kinds.
    pub fn total(&self) -> u64 {
        self.0.iter().sum()
    }
}

impl From<FindingCounts> for BTreeMap<FindingKind, u64> {
    fn from(counts: FindingCounts) -> Self {
        FindingKind::ALL.into_iter().zip(counts.0).filter(|(_, count)| *count > 0).collect()
    }
}

impl From<BTreeMap<FindingKind, u64>> for FindingCounts {
    fn from(found: BTreeMap<FindingKind, u64>) -> Self {
        Self(FindingKind::ALL.map(|kind| found.get(&kind).copied().unwrap_or_default()))
    }
}

impl std::ops::AddAssign for FindingCounts {
    fn add_assign(&mut self, other: Self) {
        for (own, others) in self.0.iter_mut().zip(other.0) {
            *own += others;
        }
    }
}
