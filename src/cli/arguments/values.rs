//! Parsers for values that several commands take as arguments.
use crate::{assignments::Assignment, judge::Rules, report::page::Audience, suite::config::Hints};
use clap::{
    ValueEnum,
    builder::{PossibleValue, PossibleValuesParser, TypedValueParser},
};
use std::str::FromStr;

/// Parses a whole number that is at least one.
pub(in crate::cli) fn parse_positive<N: FromStr>(text: &str) -> Result<N, &'static str> {
    text.trim().parse().map_err(|_| "the value must be a whole number of at least 1")
}

/// The format of a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum TextOrJson {
    /// Readable text.
    Text,
    /// One JSON object.
    Json,
}

/// A word that an argument can have on the command line, its value, and its help text.
type Word<T> = (&'static str, T, &'static str);

/// Returns a parser that accepts one of these words.
fn word_parser<T: Copy + Send + Sync + 'static>(words: &'static [Word<T>]) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(words.iter().map(|(word, _, help)| PossibleValue::new(*word).help(*help))).try_map(
        |found| words.iter().find(|(word, ..)| *word == found).map(|(_, value, _)| *value).ok_or("no such word"),
    )
}

/// Returns the parser for the rule books.
pub(in crate::cli) fn rules_parser() -> impl TypedValueParser<Value = Rules> {
    word_parser(&[
        ("parity", Rules::Parity, "The original's rules alone"),
        (
            "fair",
            Rules::Fair,
            "The fair rules give the verdict, which is independent of round-off, scale and the course's slip",
        ),
        (
            "both",
            Rules::Both,
            "The original's rules give the verdict, and the report shows where and why the fair rules differ",
        ),
    ])
}

/// Returns the parser for the hints of reports.
pub(in crate::cli) fn hints_parser() -> impl TypedValueParser<Value = Hints> {
    word_parser(&[
        ("none", Hints::None, "The verdict only"),
        ("where", Hints::Where, "The place of the first difference"),
        ("what", Hints::What, "The place of the first difference, and the likely mistake in one sentence"),
        ("full", Hints::Full, "Everything, including formulas and values"),
    ])
}

/// Returns the parser for the hints of an explanation, which show at least the likely mistake.
pub(in crate::cli) fn explanation_hints() -> impl TypedValueParser<Value = Hints> {
    word_parser(&[
        ("what", Hints::What, "The likely mistake, in one sentence"),
        (
            "full",
            Hints::Full,
            "The likely mistake with its exact terms and an example, which may reveal the right formula",
        ),
    ])
}

/// Returns the parser for a milestone of the course.
pub(in crate::cli) fn assignment_parser() -> impl TypedValueParser<Value = Assignment> {
    PossibleValuesParser::new(Assignment::list_default_first().map(Assignment::key))
        .try_map(|key| Assignment::from_key(&key.to_ascii_lowercase()).ok_or("no such milestone"))
}

/// Returns the parser for the reader of a page.
pub(in crate::cli) fn audience_parser() -> impl TypedValueParser<Value = Audience> {
    word_parser(&[
        ("staff", Audience::Staff, "Staff, or a student on their own machine: everything in all groups"),
        ("student", Audience::Student, "The student: the visible groups, as the suite's hints allow"),
    ])
}
