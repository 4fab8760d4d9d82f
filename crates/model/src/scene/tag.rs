//! One tag: its attributes as written, with their positions, and all errors in their syntax and names.
//!
//! Values are neither translated nor interpreted here; `fields` does that.
use std::{borrow::Cow, collections::BTreeSet, ops::Range};

use quick_xml::events::attributes::{AttrError, Attributes};

use super::problem::{Problem, Report, quote};
use super::{grammar, rule::Rule};

/// An attribute as written.
#[derive(Debug)]
pub(super) struct Attribute<'t> {
    pub(super) name: &'t str,
    pub(super) value: &'t str,
    /// The range of the value in the text. It includes the quotation marks only if the value is empty.
    pub(super) span: Range<usize>,
}

/// A known child of the scene.
#[derive(Debug)]
pub(super) struct Tag<'t> {
    pub(super) rule: &'static Rule,
    /// The bytes of `<name`.
    pub(super) span: Range<usize>,
    /// The known attributes, each once.
    pub(super) attributes: Vec<Attribute<'t>>,
    /// The probable intended names of misspelt attributes.
    pub(super) intended_names: BTreeSet<&'static str>,
    /// Whether some attributes of the tag could not be read.
    pub(super) is_broken: bool,
}

/// Reads a tag. `inner` is the part of `text` between `<` and `>` or `/>`, and `span` the bytes of `<name`.
pub(super) fn read<'t>(
    text: &'t str,
    rule: &'static Rule,
    inner: &'t str,
    span: Range<usize>,
    report: &mut Report,
) -> Tag<'t> {
    let (start, name_length) = (span.start + 1, span.len() - 1);
    let mut tag = Tag { rule, span, attributes: Vec::new(), intended_names: BTreeSet::new(), is_broken: false };
    let mut found = Attributes::new(inner, name_length);
    // The library's own check compares each attribute with all others; here there are few names to compare with.
    found.with_checks(false);
    for attribute in found {
        match attribute {
            Ok(attribute) => {
                let name = attribute.key.into_inner();
                let Cow::Borrowed(value) = attribute.value else { continue };
                tag.add(text, name, value, report);
            }
            Err(error) => {
                // The text after the error may belong to a different element.
                tag.is_broken = true;
                report.add_error(|| syntax_problem(rule, inner, start, &error));
                break;
            }
        }
    }
    tag
}

impl<'t> Tag<'t> {
    fn add(&mut self, text: &'t str, name: &'t str, value: &'t str, report: &mut Report) {
        let at = offset(text, name);
        let name_span = at..at + name.len();
        let rule = self.rule;
        if !rule.attributes.contains(&name) {
            report.add_error(|| {
                let similar = grammar::find_closest(name, rule.attributes.iter().copied());
                self.intended_names.extend(similar);
                let help = match similar {
                    Some(similar) => format!("did you mean `{similar}`?"),
                    None if rule.attributes.is_empty() => format!("`{}` has none", rule.name),
                    None => format!("`{}` has {}", rule.name, join_names(rule.attributes)),
                };
                Problem::from_element(
                    rule.name,
                    &name_span,
                    format!("unknown attribute `{}` of `{}`", quote(name), rule.name),
                )
                .with_attribute(name)
                .with_help(help)
            });
        } else if self.attributes.iter().any(|other| other.name == name) {
            report.add_error(|| {
                Problem::from_element(rule.name, &name_span, format!("a second `{name}` of `{}`", rule.name))
                    .with_attribute(name)
                    .with_help("the original takes the first; remove one")
            });
        } else {
            let at = offset(text, value);
            let span = if value.is_empty() { at - 1..at + 1 } else { at..at + value.len() };
            self.attributes.push(Attribute { name, value, span });
        }
    }
}

/// Returns the problem of an attribute that is not written correctly. `start` is the offset of `inner` in the text.
fn syntax_problem(rule: &Rule, inner: &str, start: usize, error: &AttrError) -> Problem {
    let (at, message) = match *error {
        AttrError::ExpectedEq(at) => (at, "`=` and a value are missing after"),
        AttrError::ExpectedValue(at) => (at, "a value is missing after"),
        AttrError::UnquotedValue(at) => (at, "quotation marks are missing around the value after"),
        AttrError::ExpectedQuote(at, _) => (at, "the closing quotation mark is missing after"),
        AttrError::Duplicated(at, _) => (at, "an attribute occurs twice after"),
    };
    // The position is after the relevant word and its white space.
    let before = inner.get(..at).unwrap_or(inner).trim_ascii_end();
    let word = before.rfind(|c: char| c.is_ascii_whitespace()).map_or(0, |space| space + 1);
    let bare = before.rfind(['"', '\'']).map_or(0, |quotation| quotation + 1);
    let (from, message, help) = if let Some(other) = before[bare..].rfind('<') {
        (bare + other, "a `<`".to_owned(), "is the `>` of this element missing?")
    } else if before[word..].starts_with('/') {
        (word, "a `/`".to_owned(), "`/` must be directly before `>`")
    } else {
        (word, format!("{message} `{}`", quote(&before[word..])), "attributes are written `name=\"value\"`")
    };
    Problem::from_element(rule.name, &(start + from..start + before.len()), format!("{message} in `{}`", rule.name))
        .with_help(help)
        .in_markup()
}

/// Returns whether a byte is white space of XML.
pub(super) fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\n' | b'\r' | b'\t')
}

/// Returns the offset at which `part` starts in `text`.
pub(super) fn offset(text: &str, part: &str) -> usize {
    (part.as_ptr() as usize).saturating_sub(text.as_ptr() as usize).min(text.len())
}

/// Returns the names joined for a message, such as `a`, `b` and `c`.
pub(super) fn join_names(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
    }
}
