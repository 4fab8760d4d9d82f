//! The content of a judged trace that reports use. [`Hints`](super::Hints) remove what the reader may not see.
use super::{
    Book, Damage, FindingCounts, Outcome, Residuals, Rules, Ruling,
    finding::{Finding, FindingKind, FindingPlace},
};
use serde::{Deserialize, Serialize};

/// The part of a judged trace that a report may show. At the lowest level of hints, nothing is shown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Disclosure {
    /// The rule book that gives the verdict.
    pub official: Book,
    /// The findings by the original's rules.
    pub parity: DisclosedBook,
    /// The findings by the fair rules, if they were requested.
    pub fair: Option<DisclosedBook>,
    /// The residuals (oracle-behavior.md 6.3), which only full hints show, because they are values.
    pub residuals: Option<Residuals>,
    /// The first damage that the reader skipped.
    pub damage: Option<Damage>,
    /// Whether bytes follow the last record.
    pub trailing_bytes: bool,
}

impl Disclosure {
    /// Creates a disclosure of everything that was found by judging a trace.
    pub fn from_outcome(outcome: &Outcome, rules: Rules) -> Self {
        let book = |book: Book| {
            let found = outcome.findings_by(book);
            DisclosedBook {
                ruling: outcome.ruling(book),
                wrong_steps: found.wrong_steps,
                counts: found.counts,
                first_divergence: found.first_divergence.map(DisclosedFinding::Full),
                examples: found.examples.iter().copied().map(DisclosedFinding::Full).collect(),
            }
        };
        Self {
            official: rules.official(),
            parity: book(Book::Parity),
            fair: outcome.fair.is_some().then(|| book(Book::Fair)),
            residuals: Some(outcome.parity.residuals),
            damage: outcome.damage.clone(),
            trailing_bytes: outcome.trailing_bytes,
        }
    }

    /// Returns the findings by the official rule book, or by the original's rules if the fair rules were not requested.
    pub fn official(&self) -> &DisclosedBook {
        match (self.official, &self.fair) {
            (Book::Fair, Some(fair)) => fair,
            _ => &self.parity,
        }
    }
}

/// The findings by one rule book that a report may show.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DisclosedBook {
    /// The verdict by the rule book.
    pub ruling: Ruling,
    /// The number of steps with at least one finding.
    pub wrong_steps: u64,
    /// The number of findings of each kind.
    pub counts: FindingCounts,
    /// The first finding in the trace, of any kind.
    pub first_divergence: Option<DisclosedFinding>,
    /// The first finding of each kind.
    pub examples: Vec<DisclosedFinding>,
}

/// The part of a finding that a report may show.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum DisclosedFinding {
    /// The kind of the finding, and the step and object that it is about, without values.
    Place {
        /// The step number, from 1; 0 for the first record.
        step: u32,
        /// The kind of finding.
        kind: FindingKind,
        /// The object of the step that the finding is about.
        place: FindingPlace,
    },
    /// The whole finding, with its values.
    Full(Finding),
}

impl DisclosedFinding {
    /// Returns the kind of the finding.
    pub const fn kind(&self) -> FindingKind {
        match self {
            Self::Place { kind, .. } => *kind,
            Self::Full(finding) => finding.kind(),
        }
    }
}
