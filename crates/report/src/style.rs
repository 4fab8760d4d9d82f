//! Decoration for terminals: colors and signs on top of text that makes sense without them.
use crate::formula;

/// Whether a report is decorated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Style {
    /// Plain text, for files, pipes and users who want no color.
    #[default]
    Plain,
    /// Color codes, for terminals.
    Color,
    /// Color codes, and formulas with Unicode's signs, for terminals that show these.
    ColorAndSigns,
}

/// The style of a piece of text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// A verdict or value that is right.
    Good,
    /// A verdict or value that is wrong.
    Bad,
    /// A warning.
    Notice,
    /// A heading.
    Strong,
    /// Less important text.
    Faint,
}

impl Style {
    /// Returns the text, decorated. Padding has to be done before.
    #[must_use]
    pub fn paint(self, look: Look, text: &str) -> String {
        let code = match (self, look) {
            (Self::Plain, _) => return text.to_owned(),
            (_, Look::Good) => "1;32",
            (_, Look::Bad) => "1;31",
            (_, Look::Notice) => "33",
            (_, Look::Strong) => "1",
            (_, Look::Faint) => "2",
        };
        format!("\x1b[{code}m{text}\x1b[0m")
    }

    /// Returns the line with its formulas as this style writes them.
    pub(crate) fn set(self, line: &str) -> String {
        if self == Self::ColorAndSigns { formula::with_signs(line) } else { line.to_owned() }
    }
}
