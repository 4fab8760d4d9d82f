//! What may be told of a judged trace: findings as values, cut to what the suite's hints let through
//! ([`Hints`](super::Hints)).
use super::{
    Book, Damage, FindingCounts, Residuals, Ruling,
    finding::{Finding, FindingKind, FindingPlace},
};
use serde::{Deserialize, Serialize};

/// What may be told of a trace. Hints that tell nothing make none of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Disclosure {
    /// The book whose verdict counts.
    pub official: Book,
    /// What the original's rules found.
    pub parity: DisclosedBook,
    /// What the fair rules found, if they were asked.
    pub fair: Option<DisclosedBook>,
    /// The residuals (oracle-behaviour.md 6.3), which are values: with full hints only.
    pub residuals: Option<Residuals>,
    /// The first damage that reading passed over.
    pub damage: Option<Damage>,
    /// Whether bytes follow the last record.
    pub trailing_bytes: bool,
}

impl Disclosure {
    /// What the book whose verdict counts found; the original's, if the fair one was not asked.
    #[must_use]
    pub fn official(&self) -> &DisclosedBook {
        match (self.official, &self.fair) {
            (Book::Fair, Some(fair)) => fair,
            _ => &self.parity,
        }
    }
}

/// What one rule book found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DisclosedBook {
    /// Its verdict.
    pub ruling: Ruling,
    /// Steps with at least one finding.
    pub wrong_steps: u64,
    /// How often each kind of finding occurred.
    pub counts: FindingCounts,
    /// The very first finding.
    pub first_divergence: Option<DisclosedFinding>,
    /// The first finding of each kind.
    pub examples: Vec<DisclosedFinding>,
}

/// What may be told of one finding.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum DisclosedFinding {
    /// Where it is and of what kind, without values.
    Place {
        /// The step, from 1; 0 for the first record.
        step: u32,
        /// Its kind.
        kind: FindingKind,
        /// Where in the step.
        place: FindingPlace,
    },
    /// Everything.
    Full(Finding),
}

impl DisclosedFinding {
    /// The step, from 1; 0 for the first record.
    #[must_use]
    pub const fn step(&self) -> u32 {
        match self {
            Self::Place { step, .. } => *step,
            Self::Full(finding) => finding.step,
        }
    }

    /// Its kind.
    #[must_use]
    pub const fn kind(&self) -> FindingKind {
        match self {
            Self::Place { kind, .. } => *kind,
            Self::Full(finding) => finding.kind(),
        }
    }
}
