//! What may be told of a judged trace: findings as values, cut to what the suite's hints let through
//! ([`Hints`](crate::config::Hints)).
use super::mirror;
use fosssim_judge::{Book, Damage, Finding, FindingCounts, FindingKind, PolynomialPlace, Residuals, Ruling};
use fosssim_model::sim::Pair;
use serde::{Deserialize, Serialize};

/// What may be told of a trace. Hints that tell nothing make none of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Told {
    /// The book whose verdict counts.
    #[serde(with = "mirror::BookForm")]
    pub official: Book,
    /// What the original's rules found.
    pub parity: ToldBook,
    /// What the fair rules found, if they were asked.
    pub fair: Option<ToldBook>,
    /// The residuals (oracle-behaviour.md 6.3), which are values: with full hints only.
    #[serde(with = "mirror::residuals")]
    pub residuals: Option<Residuals>,
    /// The first damage that reading passed over.
    #[serde(with = "mirror::damage")]
    pub damage: Option<Damage>,
    /// Whether bytes follow the last record.
    pub trailing_bytes: bool,
}

impl Told {
    /// What the book whose verdict counts found; the original's, if the fair one was not asked.
    #[must_use]
    pub fn official(&self) -> &ToldBook {
        match (self.official, &self.fair) {
            (Book::Fair, Some(fair)) => fair,
            _ => &self.parity,
        }
    }
}

/// What one rule book found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ToldBook {
    /// Its verdict.
    #[serde(with = "mirror::RulingForm")]
    pub ruling: Ruling,
    /// Steps with at least one finding.
    pub wrong_steps: u64,
    /// How often each kind of finding occurred.
    #[serde(with = "mirror::counts")]
    pub counts: FindingCounts,
    /// The very first finding.
    pub first_divergence: Option<ToldFinding>,
    /// The first finding of each kind.
    pub examples: Vec<ToldFinding>,
}

/// What may be told of one finding.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum ToldFinding {
    /// Where it is and of what kind, without values.
    Place {
        /// The step, from 1; 0 for the first record.
        step: u32,
        /// Its kind.
        #[serde(with = "mirror::kind")]
        kind: FindingKind,
        /// Where in the step.
        place: ToldPlace,
    },
    /// Everything.
    Full(#[serde(with = "mirror::FindingForm")] Finding),
}

impl ToldFinding {
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

/// Where in its step a finding lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ToldPlace {
    /// In no place that could be named.
    Step,
    /// At a pair of the scene.
    Pair(#[serde(with = "mirror::PairForm")] Pair),
    /// At a polynomial.
    Polynomial(#[serde(with = "mirror::PolynomialPlaceForm")] PolynomialPlace),
    /// At a particle.
    Particle(usize),
    /// At the objects with these numbers, of which the trace alone speaks.
    Objects(i32, i32),
}
