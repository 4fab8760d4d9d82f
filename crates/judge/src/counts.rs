//! How often something was found.
use super::finding::FindingKind;

/// How often each kind of finding occurred.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FindingCounts([u64; FindingKind::ALL.len()]);

impl FindingCounts {
    /// The count of one kind.
    #[must_use]
    pub fn get(&self, kind: FindingKind) -> u64 {
        self.0[kind as usize]
    }

    /// Adds `count` findings of one kind.
    pub fn add(&mut self, kind: FindingKind, count: u64) {
        self.0[kind as usize] += count;
    }

    /// Findings that fail the original's collision verdict: collisions and polynomials.
    #[must_use]
    pub fn collisions(&self) -> u64 {
        self.total() - self.get(FindingKind::Position) - self.get(FindingKind::Velocity)
    }

    /// The sum over all kinds.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.0.iter().sum()
    }
}

impl std::ops::AddAssign for FindingCounts {
    fn add_assign(&mut self, other: Self) {
        for (own, others) in self.0.iter_mut().zip(other.0) {
            *own += others;
        }
    }
}
