//! The level of detail in a report, which limits findings.
use super::{
    disclosure::{DisclosedBook, DisclosedFinding, Disclosure},
    finding::Finding,
};
use serde::{Deserialize, Serialize};

/// The level of detail in a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hints {
    /// Only the verdict.
    None,
    /// The verdict and the place of the first difference: kind, step, pair and polynomial.
    Where,
    /// The verdict, the place of the first difference, and the likely mistake as a sentence.
    What,
    /// Everything: expected and actual values, and the mistake in detail. This may reveal a right formula.
    Full,
}

impl Hints {
    /// Returns the level's name in suites, and its meaning in a few words.
    #[must_use]
    pub const fn describe(self) -> (&'static str, &'static str) {
        match self {
            Self::None => ("none", "the verdict only"),
            Self::Where => ("where", "where the first difference is"),
            Self::What => ("what", "where the first difference is, and the likely mistake in a sentence"),
            Self::Full => ("full", "everything, formulas and values included"),
        }
    }

    /// Returns whether likely mistakes are shown at this level.
    #[must_use]
    pub const fn explains(self) -> bool {
        matches!(self, Self::What | Self::Full)
    }

    /// Limits the facts about a trace to the level: nothing at [`Hints::None`], only places and kinds of findings at
    /// the next levels, everything at [`Hints::Full`].
    #[must_use]
    pub fn disclose(self, all: Disclosure) -> Option<Disclosure> {
        match self {
            Self::None => None,
            Self::Where | Self::What => Some(Disclosure {
                parity: self.disclose_book(all.parity),
                fair: all.fair.map(|book| self.disclose_book(book)),
                residuals: None,
                ..all
            }),
            Self::Full => Some(all),
        }
    }

    fn disclose_book(self, book: DisclosedBook) -> DisclosedBook {
        let cut = |finding: DisclosedFinding| self.cut(finding);
        DisclosedBook {
            first_divergence: book.first_divergence.and_then(cut),
            examples: book.examples.into_iter().filter_map(cut).collect(),
            ..book
        }
    }

    /// Returns the part of a finding that both levels show.
    #[must_use]
    pub const fn cut(self, finding: DisclosedFinding) -> Option<DisclosedFinding> {
        match finding {
            DisclosedFinding::Full(finding) => self.finding(&finding),
            DisclosedFinding::Place { .. } => Some(finding),
        }
    }

    /// Returns the part of a finding that the level shows: nothing at [`Hints::None`], and no values below
    /// [`Hints::Full`].
    #[must_use]
    pub const fn finding(self, finding: &Finding) -> Option<DisclosedFinding> {
        match self {
            Self::None => None,
            Self::Where | Self::What => Some(DisclosedFinding::Place {
                step: finding.step,
                kind: finding.kind(),
                place: finding.detail.place(),
            }),
            Self::Full => Some(DisclosedFinding::Full(*finding)),
        }
    }
}
