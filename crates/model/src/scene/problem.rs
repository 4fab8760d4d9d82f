//! Describes the problems of a scene: each has a position, a description of the fault and perhaps a correction.
use std::{fmt, ops::Range};

/// The maximum number of errors, and of warnings, that are kept for one scene. Further ones are only counted.
pub const MAX_PROBLEMS: usize = 200;

/// The severity of a problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The scene is rejected.
    Error,
    /// The scene loads, but its meaning probably differs from the author's intention.
    Warning,
}

/// One problem of a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// Whether the problem is an error or a warning.
    pub severity: Severity,
    /// The line of the problem, from 1.
    pub line: usize,
    /// The column of the problem in characters, from 1.
    pub column: usize,
    /// The bytes of the file that the problem is about. The range may be empty.
    pub span: Range<usize>,
    /// The element that the problem is about.
    pub element: Option<String>,
    /// The attribute that the problem is about.
    pub attribute: Option<String>,
    /// The description of the fault, as a phrase in lower case.
    pub message: String,
    /// The allowed values, or the remedy.
    pub help: Option<String>,
    /// Whether the fault is in the markup, such as a tag without its end. Other problems may follow from it.
    pub is_markup: bool,
}

impl fmt::Display for Problem {
    /// Writes `line:column: message (help)`; a warning is marked.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: ", self.line, self.column)?;
        if self.severity == Severity::Warning {
            f.write_str("warning: ")?;
        }
        f.write_str(&self.message)?;
        self.help.as_ref().map_or(Ok(()), |help| write!(f, " ({help})"))
    }
}

/// The reason why a scene was rejected: its errors and warnings, in the order of their positions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problems {
    /// The scene's name, as the caller gave it.
    pub source: String,
    /// The problems, at least one of them an error.
    pub list: Vec<Problem>,
    /// The number of further problems that were not kept ([`MAX_PROBLEMS`]).
    pub omitted_count: usize,
}

impl Problems {
    /// Returns a rejection of the whole text, whose position is the start of the text.
    pub(super) fn from_whole_text(source: &str, message: String, help: &str) -> Self {
        Self { source: source.to_owned(), list: vec![Problem::new(0..0, message).with_help(help)], omitted_count: 0 }
    }
}

impl fmt::Display for Problems {
    /// Writes one problem per line, without the source's name and without a newline at the end.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, problem) in self.list.iter().enumerate() {
            let separator = if number == 0 { "" } else { "\n" };
            write!(f, "{separator}{problem}")?;
        }
        match self.omitted_count {
            0 => Ok(()),
            more => write!(f, "\nand {more} more"),
        }
    }
}

impl std::error::Error for Problems {}

// A problem is created as an error in line 1, column 1. The report sets its severity and position.
impl Problem {
    pub(super) fn new(span: Range<usize>, message: impl Into<String>) -> Self {
        let (severity, message) = (Severity::Error, message.into());
        Self {
            severity,
            line: 1,
            column: 1,
            span,
            element: None,
            attribute: None,
            message,
            help: None,
            is_markup: false,
        }
    }

    /// Creates a problem of the element `element`.
    pub(super) fn from_element(element: &str, span: &Range<usize>, message: impl Into<String>) -> Self {
        Self { element: Some(quote(element)), ..Self::new(span.clone(), message) }
    }

    pub(super) fn with_attribute(self, name: &str) -> Self {
        Self { attribute: Some(quote(name)), ..self }
    }

    pub(super) fn in_markup(self) -> Self {
        Self { is_markup: true, ..self }
    }

    pub(super) fn with_help(self, help: impl Into<String>) -> Self {
        self.with_optional_help(Some(help.into()))
    }

    pub(super) fn with_optional_help(self, help: Option<String>) -> Self {
        Self { help, ..self }
    }
}

/// Collects problems. They are created only while there is room, so the work is proportional to the file's length.
#[derive(Debug, Default)]
pub(super) struct Report {
    list: Vec<Problem>,
    /// The number of kept problems of each severity.
    kept_counts: [usize; 2],
    omitted_count: usize,
}

impl Report {
    pub(super) fn add_error(&mut self, problem: impl FnOnce() -> Problem) {
        self.add(Severity::Error, problem);
    }

    pub(super) fn add_warning(&mut self, problem: impl FnOnce() -> Problem) {
        self.add(Severity::Warning, problem);
    }

    pub(super) fn add(&mut self, severity: Severity, problem: impl FnOnce() -> Problem) {
        let kept_count = &mut self.kept_counts[severity as usize];
        if *kept_count < MAX_PROBLEMS {
            *kept_count += 1;
            self.list.push(Problem { severity, ..problem() });
        } else {
            self.omitted_count += 1;
        }
    }

    pub(super) fn has_errors(&self) -> bool {
        self.kept_counts[Severity::Error as usize] > 0
    }

    /// Returns the problems in the order of their positions, and the number of further problems. The spans refer to
    /// `text`.
    pub(super) fn finish(mut self, text: &[u8]) -> (Vec<Problem>, usize) {
        self.list.sort_by_key(|problem| (problem.span.start, problem.severity));
        let mut cursor = TextCursor::from_start(text);
        for problem in &mut self.list {
            (problem.line, problem.column) = cursor.advance(text, problem.span.start);
        }
        (self.list, self.omitted_count)
    }
}

/// A position in the text that moves forward and counts lines and characters.
struct TextCursor {
    offset: usize,
    line: usize,
    column: usize,
}

impl TextCursor {
    fn from_start(text: &[u8]) -> Self {
        // A byte order mark has no width on the screen.
        let at = if text.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { offset: at, line: 1, column: 1 }
    }

    fn advance(&mut self, text: &[u8], to: usize) -> (usize, usize) {
        let to = to.min(text.len());
        for &byte in text.get(self.offset..to).unwrap_or_default() {
            if byte == b'\n' {
                self.line += 1;
                self.column = 1;
            } else if byte & 0xc0 != 0x80 {
                // Every byte except UTF-8 continuations starts a character.
                self.column += 1;
            }
        }
        self.offset = self.offset.max(to);
        (self.line, self.column)
    }
}

/// Returns a part of the scene for a message, with control characters escaped, and shortened if it is long.
pub(super) fn quote(text: &str) -> String {
    const MAX_SHOWN_CHARS: usize = 40;
    let mut quoted: String = text.chars().take(MAX_SHOWN_CHARS).flat_map(char::escape_debug).collect();
    // Quotation marks need no escape between backquotes.
    quoted = quoted.replace("\\\"", "\"").replace("\\'", "'");
    if text.chars().nth(MAX_SHOWN_CHARS).is_some() {
        quoted.push_str("...");
    }
    quoted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_lines_and_characters() {
        let text = "\u{feff}a\né b\r\nc".as_bytes();
        let mut report = Report::default();
        report.add_warning(|| Problem::new(13..13, "third"));
        report.add_error(|| Problem::new(8..9, "second").with_help("do this"));
        report.add_error(|| Problem::from_element("e", &(3..4), "first"));
        let (list, omitted_count) = report.finish(text);
        let shown = Problems { source: "x".into(), list, omitted_count }.to_string();
        assert_eq!(shown, "1:1: first\n2:3: second (do this)\n3:2: warning: third");
    }

    #[test]
    fn the_list_is_capped_and_the_rest_counted() {
        let mut report = Report::default();
        for _ in 0..MAX_PROBLEMS + 3 {
            report.add_error(|| Problem::new(0..0, "e"));
        }
        report.add_warning(|| Problem::new(0..0, "w"));
        let (list, omitted_count) = report.finish(b"");
        assert_eq!((list.len(), omitted_count), (MAX_PROBLEMS + 1, 3));
        let shown = Problems { source: String::new(), list, omitted_count }.to_string();
        assert!(shown.ends_with("1:1: warning: w\nand 3 more"), "{shown}");
    }

    #[test]
    fn quoted_text_is_harmless_and_short() {
        assert_eq!(quote("a\u{1b}\n\"'"), "a\\u{1b}\\n\"'");
        assert_eq!(quote(&"é".repeat(41)), format!("{}...", "é".repeat(40)));
    }
}
