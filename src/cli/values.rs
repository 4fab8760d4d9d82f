//! Values that several commands take as arguments.
use crate::judge;
use clap::ValueEnum;
use std::str::FromStr;

/// A count that can't be zero.
pub(super) fn at_least_one<N: FromStr>(word: &str) -> Result<N, &'static str> {
    word.trim().parse().map_err(|_| "it is a whole number, 1 or more")
}

/// How a report is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum TextOrJson {
    /// For people.
    Text,
    /// For programs; one JSON object.
    Json,
}

/// Which rule books are asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Rules {
    /// The original's rules alone.
    Parity,
    /// The fair rules give the verdict: round-off, scale and the course's own slip can't change it.
    Fair,
    /// The original's rules give the verdict, and the report says where the fair ones differ, and why.
    Both,
}

impl From<Rules> for judge::Rules {
    fn from(rules: Rules) -> Self {
        match rules {
            Rules::Parity => Self::Parity,
            Rules::Fair => Self::Fair,
            Rules::Both => Self::Both,
        }
    }
}
