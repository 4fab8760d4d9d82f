//! The part of a judged trace that a report may show: findings as values. [`Hints`](super::Hints) limit it to what a
//! reader may see.
use super::{
    Book, Damage, FindingCounts, Outcome, Residuals, Rules, Ruling,
    finding::{Finding, FindingKind, FindingPlace},
};
use serde::{Deserialize, Serialize};

/// The part of a trace that a report may show; the lowest level of hints shows none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Disclosure {
    /// The rule book whose verdict counts.
    pub official: Book,
    /// The findings of the original's rules.
    pub parity: DisclosedBook,
    /// The findings of the fair rules, if requested.
    pub fair: Option<DisclosedBook>,
    /// The residuals (oracle-behavior.md 6.3). Residuals are values, so only full hints show them.
    pub residuals: Option<Residuals>,
    /// The first damage that the reader skipped.
    pub damage: Option<Damage>,
    /// Whether bytes follow the last record.
    pub trailing_bytes: bool,
}

impl Disclosure {
    /// Creates a disclosure of everything that judging found.
    #[must_use]
    pub fn from_outcome(judged: &Outcome, rules: Rules) -> Self {
        let book = |book: Book| {
            let found = judged.findings_by(book);
            DisclosedBook {
                ruling: judged.ruling(book),
                wrong_steps: found.wrong_steps,
                counts: found.counts,
                first_divergence: found.first_divergence.map(DisclosedFinding::Full),
                examples: found.examples.iter().copied().map(DisclosedFinding::Full).collect(),
            }
        };
        Self {
            official: rules.official(),
            parity: book(Book::Parity),
            fair: judged.fair.is_some().then(|| book(Book::Fair)),
            residuals: Some(judged.parity.residuals),
            damage: judged.damage.clone(),
            trailing_bytes: judged.trailing_bytes,
        }
    }

    /// Returns the findings of the official rule book, or the original's if the fair rules were not requested.
    #[must_use]
    pub fn official(&self) -> &DisclosedBook {
        match (self.official, &self.fair) {
            (Book::Fair, Some(fair)) => fair,
            _ => &self.parity,
        }
    }
}

/// The findings of one rule book.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DisclosedBook {
    /// The book's verdict.
    pub ruling: Ruling,
    /// The number of steps with at least one finding.
    pub wrong_steps: u64,
    /// The number of findings of each kind.
    pub counts: FindingCounts,
    /// The earliest finding.
    pub first_divergence: Option<DisclosedFinding>,
    /// The first finding of each kind.
    pub examples: Vec<DisclosedFinding>,
}

/// The part of one finding that a report may show.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum DisclosedFinding {
    /// The place and the kind of the finding, without values.
    Place {
        /// The step number, from 1; 0 for the first record.
        step: u32,
        /// The finding's kind.
        kind: FindingKind,
        /// The place of the finding in its step.
        place: FindingPlace,
    },
    /// The whole finding, with its values.
    Full(Finding),
}

impl DisclosedFinding {
    /// Returns the finding's kind.
    #[must_use]
    pub const fn kind(&self) -> FindingKind {
        match self {
            Self::Place { kind, .. } => *kind,
            Self::Full(finding) => finding.kind(),
        }
    }
}
