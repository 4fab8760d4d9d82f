//! The style of text for terminals. Colors and signs are added to text that can be understood without them.
use crate::formula;

/// The style in which a report is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Style {
    /// Plain text, for files, pipes and users who want no color.
    #[default]
    Plain,
    /// Colors, for terminals.
    Color,
    /// Colors and mathematical signs in formulas, for terminals that can show them.
    ColorAndSigns,
}

/// The style of a piece of text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// The style of a right verdict or value.
    Good,
    /// The style of a wrong verdict or value.
    Bad,
    /// The style of a warning.
    Notice,
    /// The style of a heading.
    Strong,
    /// The style of less important text.
    Faint,
}

impl Style {
    /// Returns the text with the codes of a style. Padding must be added before this call.
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

    /// Returns the line, with its formulas as the style requires.
    pub(crate) fn set(self, line: &str) -> String {
        if self == Self::ColorAndSigns { formula::with_signs(line) } else { line.to_owned() }
    }
}
