//! The level of detail in reports, which decides how much of a finding they show.
use super::{
    disclosure::{DisclosedBook, DisclosedFinding, Disclosure},
    finding::Finding,
};
use serde::{Deserialize, Serialize};

/// The level of detail in reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hints {
    /// Reports show only the verdict.
    None,
    /// Reports show the verdict and the place of the first difference: its kind, step, pair and polynomial.
    Where,
    /// Reports show the verdict, the place of the first difference, and the likely mistake as a sentence.
    What,
    /// Reports show everything, including expected and actual values, and the exact form of the mistake. This may
    /// reveal a right formula.
    Full,
}

impl Hints {
    /// Returns the level's name in suites, and a few words about its meaning.
    pub const fn describe(self) -> (&'static str, &'static str) {
        match self {
            Self::None => ("none", "the verdict only"),
            Self::Where => ("where", "where the first difference is"),
            Self::What => ("what", "where the first difference is, and the likely mistake in a sentence"),
            Self::Full => ("full", "everything, including formulas and values"),
        }
    }

    /// Returns whether reports show likely mistakes at this level.
    pub const fn explains(self) -> bool {
        matches!(self, Self::What | Self::Full)
    }

    /// Returns the part of a disclosure that this level shows. This is `None` at [`Hints::None`], only the places and
    /// kinds of findings at the next two levels, and everything at [`Hints::Full`].
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
        let cut = |finding: DisclosedFinding| self.limit_finding(finding);
        DisclosedBook {
            first_divergence: book.first_divergence.and_then(cut),
            examples: book.examples.into_iter().filter_map(cut).collect(),
            ..book
        }
    }

    /// Returns the part of a finding that this level shows, or `None` if it shows nothing. Parts that an earlier level
    /// has removed are not restored.
    pub const fn limit_finding(self, finding: DisclosedFinding) -> Option<DisclosedFinding> {
        match finding {
            DisclosedFinding::Full(finding) => self.disclose_finding(&finding),
            DisclosedFinding::Place { .. } => Some(finding),
        }
    }

    /// Returns the part of a finding that this level shows. This is `None` at [`Hints::None`], and has no values below
    /// [`Hints::Full`].
    pub const fn disclose_finding(self, finding: &Finding) -> Option<DisclosedFinding> {
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
