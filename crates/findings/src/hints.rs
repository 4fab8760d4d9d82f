//! How much a report tells a student, and what of findings that lets through.
use super::{
    Book, Outcome, Rules,
    disclosure::{DisclosedBook, DisclosedFinding, Disclosure},
    finding::Finding,
};
use serde::Deserialize;

/// How much a report tells a student.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hints {
    /// The verdict only.
    None,
    /// Where: kind, step, pair and polynomial of the first divergence.
    Where,
    /// The likely mistake in a sentence, too.
    What,
    /// Everything: expected and actual values, and the mistake in detail. May give a right formula away.
    Full,
}

impl Hints {
    /// Its name in suites, and what it means in a few words.
    #[must_use]
    pub const fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::None => ("none", "the verdict only"),
            Self::Where => ("where", "where the first divergence is"),
            Self::What => ("what", "where the first divergence is, and the likely mistake in a sentence"),
            Self::Full => ("full", "everything, formulas and values included"),
        }
    }

    /// Whether likely mistakes are told at this level.
    #[must_use]
    pub const fn explains(self) -> bool {
        matches!(self, Self::What | Self::Full)
    }

    /// Cuts what judging found down to this level: nothing at [`Hints::None`]; below [`Hints::Full`] where findings
    /// are, and of what kind; there everything.
    #[must_use]
    pub fn tell(self, judged: &Outcome, rules: Rules) -> Option<Disclosure> {
        (self > Self::None).then(|| Disclosure {
            official: rules.official(),
            parity: self.tell_book(judged, Book::Parity),
            fair: judged.fair.is_some().then(|| self.tell_book(judged, Book::Fair)),
            residuals: (self == Self::Full).then_some(judged.parity.residuals),
            damage: judged.damage.clone(),
            trailing_bytes: judged.trailing_bytes,
        })
    }

    fn tell_book(self, judged: &Outcome, book: Book) -> DisclosedBook {
        let found = judged.findings_by(book);
        DisclosedBook {
            ruling: judged.ruling(book),
            wrong_steps: found.wrong_steps,
            counts: found.counts,
            first_divergence: found.first_divergence.as_ref().and_then(|first| self.finding(first)),
            examples: found.examples.iter().filter_map(|example| self.finding(example)).collect(),
        }
    }

    /// The part of a finding that may be told: nothing at [`Hints::None`], no values below [`Hints::Full`].
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
