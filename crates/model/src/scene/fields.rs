//! Typed reading of an element's attributes, with a problem for each value that cannot be read.
//!
//! If a method returns `None`, the problem has been reported.
use std::{borrow::Cow, ops::Range};

use quick_xml::escape::{EscapeError, unescape};

use super::grammar;
use super::model::Color;
use super::numbers::{self, NumberError};
use super::problem::{Problem, Report, Severity, quote};
use super::tag::{Attribute, Tag, join_names};
use fosssim_num::vector::Vec2;

/// The number of objects of a kind. Indices that point to such objects must be below it.
#[derive(Debug, Clone, Copy)]
pub(super) struct ObjectCount {
    /// The name of such an object in messages, such as `particle`.
    pub(super) noun: &'static str,
    pub(super) count: usize,
    /// Whether the number is certain. After broken XML or a misspelt element it is uncertain, and indices are not
    /// checked.
    pub(super) is_certain: bool,
}

/// The attributes of one element.
pub(super) struct TagFields<'d, 't, 'r> {
    tag: &'d Tag<'t>,
    number: Option<usize>,
    report: &'r mut Report,
}

impl<'d, 't, 'r> TagFields<'d, 't, 'r> {
    /// Creates the reader of an element's attributes. `number` is the element's number among its kind, if there may be
    /// several.
    pub(super) fn new(tag: &'d Tag<'t>, number: Option<usize>, report: &'r mut Report) -> Self {
        Self { tag, number, report }
    }

    pub(super) fn has_attribute(&self, name: &str) -> bool {
        self.raw_attribute(name).is_some()
    }

    /// Returns the range of an attribute's value in the text, or of the element if the attribute is missing.
    pub(super) fn span(&self, name: &str) -> Range<usize> {
        self.raw_attribute(name).map_or_else(|| self.tag.span.clone(), |attribute| attribute.span.clone())
    }

    /// Reports an error about an attribute's value, in the form `NAME of ELEMENT MESSAGE`.
    pub(super) fn report_error(&mut self, name: &str, message: &str, help: impl Into<String>) {
        self.report_problem(Severity::Error, name, || (message.to_owned(), help.into()));
    }

    /// Reports a warning about an attribute's value, in the form `NAME of ELEMENT MESSAGE`.
    pub(super) fn warn(&mut self, name: &str, message: &str, help: impl Into<String>) {
        self.report_problem(Severity::Warning, name, || (message.to_owned(), help.into()));
    }

    /// Reports an error about an attribute's value, which is shown as written.
    pub(super) fn report_bad_value(&mut self, name: &str, help: impl Into<String>) {
        let written = self.raw_attribute(name).map_or("", |attribute| attribute.value);
        self.report_problem(Severity::Error, name, || (format!("is `{}`", quote(written)), help.into()));
    }

    /// Reports a warning about an attribute's value, which is shown as written.
    pub(super) fn warn_bad_value(&mut self, name: &str, help: impl Into<String>) {
        let written = self.raw_attribute(name).map_or("", |attribute| attribute.value);
        self.report_problem(Severity::Warning, name, || (format!("is `{}`", quote(written)), help.into()));
    }

    /// Reports a problem, whose text is created only if the report has room for it.
    fn report_problem(&mut self, severity: Severity, name: &str, message_and_help: impl FnOnce() -> (String, String)) {
        let (span, tag, number) = (self.span(name), self.tag, self.number);
        self.report.add(severity, || {
            let (message, help) = message_and_help();
            Problem::from_element(tag.rule.name, &span, format!("`{name}` of {} {message}", describe_tag(tag, number)))
                .with_attribute(name)
                .with_help(help)
        });
    }

    /// Returns whether an attribute is absent or empty.
    pub(super) fn is_blank(&self, name: &str) -> bool {
        self.raw_attribute(name).is_none_or(|attribute| attribute.value.is_empty())
    }

    /// Returns the text of a required attribute. If it is missing or cannot be read, reports the problem and returns
    /// `None`, as the methods below do.
    pub(super) fn text(&mut self, name: &str, what: &str) -> Option<String> {
        let attribute = self.require(name, what)?;
        let text = self.decode(attribute)?.into_owned();
        if attribute.value.contains('\n') {
            self.warn(name, "has a line break, which vanishes", "the original joins lines without a space");
        }
        Some(text)
    }

    /// Returns the text of an optional attribute. The outer `None` means that the attribute cannot be read.
    pub(super) fn optional_text(&mut self, name: &str) -> Option<Option<String>> {
        if self.has_attribute(name) { self.text(name, "").map(Some) } else { Some(None) }
    }

    /// Returns the value of `choices` that a required attribute names.
    pub(super) fn choice<T: Copy>(&mut self, name: &str, choices: &[(&str, T)]) -> Option<T> {
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        let attribute = self.require(name, &join_names(&names))?;
        let text = self.decode(attribute)?;
        if let Some((_, value)) = choices.iter().find(|(name, _)| *name == text) {
            return Some(*value);
        }
        let help = match grammar::find_closest(&text, names.iter().copied()) {
            Some(meant) => format!("did you mean `{meant}`?"),
            None => format!("the allowed values are {}", join_names(&names)),
        };
        self.report_bad_value(name, help);
        None
    }

    /// Returns a required scalar.
    pub(super) fn scalar(&mut self, name: &str) -> Option<f64> {
        let attribute = self.require(name, "a number")?;
        self.number(attribute)
    }

    /// Returns an optional scalar, or the default if the attribute is missing.
    pub(super) fn scalar_or(&mut self, name: &str, default: f64) -> Option<f64> {
        match self.raw_attribute(name) {
            Some(attribute) => self.number(attribute),
            None => Some(default),
        }
    }

    /// Returns two required scalars.
    pub(super) fn vector(&mut self, x: &str, y: &str) -> Option<Vec2> {
        let (x, y) = (self.scalar(x), self.scalar(y));
        Some(Vec2::new(x?, y?))
    }

    /// Returns a required whole number of 32 bits.
    pub(super) fn integer(&mut self, name: &str) -> Option<i32> {
        let attribute = self.require(name, "a whole number")?;
        let text = self.single_line_text(attribute)?;
        match numbers::parse_integer(&text) {
            Ok(value) => Some(value),
            Err(error) => self.report_number(name, &text, error),
        }
    }

    /// Returns a required index of an existing object.
    pub(super) fn index(&mut self, name: &str, objects: ObjectCount) -> Option<usize> {
        let written = self.integer(name)?;
        let index = usize::try_from(written).ok();
        if index.is_some_and(|index| index < objects.count) {
            return index;
        }
        if objects.is_certain || index.is_none() {
            self.report_problem(Severity::Error, name, || {
                let help = match objects.count {
                    0 => format!("there is no {}", objects.noun),
                    1 => "must be 0; numbering starts at 0".to_owned(),
                    count => format!("must be between 0 and {}; numbering starts at 0", count - 1),
                };
                (format!("is {written}, but the scene has no such {}", objects.noun), help)
            });
        }
        None
    }

    /// Returns the value of a required boolean.
    pub(super) fn boolean(&mut self, name: &str) -> Option<bool> {
        let attribute = self.require(name, "0 or 1")?;
        let text = self.single_line_text(attribute)?;
        let text = text.trim_ascii();
        let help = match text.to_ascii_lowercase().as_str() {
            "0" => return Some(false),
            "1" => return Some(true),
            "true" | "yes" => "write `1`",
            "false" | "no" => "write `0`",
            _ => "must be `0` or `1`",
        };
        self.report_bad_value(name, help);
        None
    }

    /// Returns the color in the attributes `r`, `g` and `b`, each between 0 and 1.
    pub(super) fn color(&mut self) -> Option<Color> {
        let mut component = |name: &str| {
            let value = self.scalar(name)?;
            if (0.0..=1.0).contains(&value) {
                return Some(value);
            }
            self.report_bad_value(name, "must be between 0 and 1");
            None
        };
        let (red, green, blue) = (component("r"), component("g"), component("b"));
        Some(Color { red: red?, green: green?, blue: blue? })
    }

    fn raw_attribute(&self, name: &str) -> Option<&'d Attribute<'t>> {
        self.tag.attributes.iter().find(|attribute| attribute.name == name)
    }

    /// Returns a required attribute. Its absence is not reported if it may be misspelt or unreadable.
    fn require(&mut self, name: &str, what: &str) -> Option<&'d Attribute<'t>> {
        let attribute = self.raw_attribute(name);
        if attribute.is_none() && !self.tag.is_broken && !self.tag.intended_names.contains(name) {
            let (tag, number) = (self.tag, self.number);
            self.report.add_error(|| {
                Problem::from_element(
                    tag.rule.name,
                    &tag.span,
                    format!("{} has no `{name}`", describe_tag(tag, number)),
                )
                .with_attribute(name)
                .with_help(format!("required: {what}"))
            });
        }
        attribute
    }

    /// Returns the value as the original reads it: lines joined, references translated.
    fn decode(&mut self, attribute: &'d Attribute<'t>) -> Option<Cow<'d, str>> {
        let joined: Cow<'d, str> = if attribute.value.contains('\n') {
            attribute.value.replace('\n', "").into()
        } else {
            attribute.value.into()
        };
        let result = match &joined {
            Cow::Borrowed(text) => unescape(text),
            Cow::Owned(text) => unescape(text).map(|text| Cow::Owned(text.into_owned())),
        };
        match result {
            Ok(text) => Some(text),
            Err(error) => {
                let message = match error {
                    EscapeError::UnrecognizedEntity(_, name) => format!("has an unknown entity `&{};`", quote(&name)),
                    EscapeError::UnterminatedEntity(_) => "has an `&` without `;`".to_owned(),
                    EscapeError::InvalidCharRef(_) => "has a reference to a character that does not exist".to_owned(),
                    other => format!("cannot be read: {other}"),
                };
                self.report_error(
                    attribute.name,
                    &message,
                    "the known references are `&lt;` `&gt;` `&amp;` `&apos;` `&quot;` `&#65;` `&#x41;`",
                );
                None
            }
        }
    }

    /// Returns the text of a number. The text must be on one line.
    fn single_line_text(&mut self, attribute: &'d Attribute<'t>) -> Option<Cow<'d, str>> {
        let text = self.decode(attribute)?;
        if attribute.value.trim_ascii().contains('\n') {
            let help = format!("the original joins the lines and reads `{}`", quote(&text));
            self.report_error(attribute.name, "has a line break inside", help);
            return None;
        }
        Some(text)
    }

    fn number(&mut self, attribute: &'d Attribute<'t>) -> Option<f64> {
        let text = self.single_line_text(attribute)?;
        match numbers::parse_scalar(&text) {
            Ok((value, vanished)) => {
                if vanished {
                    let message = format!("is `{}`, which becomes zero", quote(&text));
                    self.warn(attribute.name, &message, "the smallest 64-bit number is 5e-324");
                }
                Some(value)
            }
            Err(error) => self.report_number(attribute.name, &text, error),
        }
    }

    fn report_number<T>(&mut self, name: &str, text: &str, error: NumberError) -> Option<T> {
        self.report_problem(Severity::Error, name, || describe_error(text, &error));
        None
    }
}

/// Returns the name of an element for messages, such as `particle 3` or `integrator`.
fn describe_tag(tag: &Tag<'_>, number: Option<usize>) -> String {
    match number {
        Some(number) => format!("{} {number}", tag.rule.name),
        None => tag.rule.name.to_owned(),
    }
}

/// Returns the message about a bad number, which names the error and the remedy.
fn describe_error(text: &str, error: &NumberError) -> (String, String) {
    use NumberError::{Comma, Empty, NoNumber, NotFinite, NotWhole, Overflow, TooLarge, Trailing};
    let text = quote(text.trim_ascii());
    match error {
        Empty => ("is empty".to_owned(), "write a number".to_owned()),
        NoNumber => (format!("must be a number, not `{text}`"), "write a number such as `-1.5e-3`".to_owned()),
        Trailing(prefix) => (
            format!("is `{text}`, which is more than a number"),
            format!("the original reads `{}` and ignores the rest", quote(prefix)),
        ),
        Comma(point) => (format!("is `{text}`, with a decimal comma"), format!("write `{}`", quote(point))),
        NotFinite => (format!("is `{text}`"), "only finite numbers are allowed".to_owned()),
        Overflow => (format!("is `{text}`, too large"), "the largest 64-bit number is 1.8e308".to_owned()),
        NotWhole => (format!("is `{text}`"), "write a whole number".to_owned()),
        TooLarge => (format!("is `{text}`, beyond 32 bits"), "write -2147483648 to 2147483647".to_owned()),
    }
}
