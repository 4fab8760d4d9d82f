//! The style of text for terminals. The text can be understood without its colors and signs.
use crate::formula;

/// The use of colors and mathematical signs in a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Style {
    /// Plain text, for files, pipes and users who want no color.
    #[default]
    Plain,
    /// Colors, for terminals.
    Color,
    /// Colors, and mathematical signs in formulas, for terminals that can show them.
    ColorAndSigns,
}

/// The purpose of a piece of text, which determines its color.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TextStyle {
    /// A verdict or a value that is right.
    Right,
    /// A verdict or a value that is wrong.
    Wrong,
    /// A warning or a notice.
    Notice,
    /// A heading.
    Strong,
    /// Text that is less important.
    Faint,
}

impl Style {
    /// Returns a text with the terminal codes for its color. Padding must be added before this call.
    pub fn paint(self, look: TextStyle, text: &str) -> String {
        let code = match (self, look) {
            (Self::Plain, _) => return text.to_owned(),
            (_, TextStyle::Right) => "1;32",
            (_, TextStyle::Wrong) => "1;31",
            (_, TextStyle::Notice) => "33",
            (_, TextStyle::Strong) => "1",
            (_, TextStyle::Faint) => "2",
        };
        format!("\x1b[{code}m{text}\x1b[0m")
    }

    /// Returns a line in which formulas are written as this style requires.
    pub(crate) fn format_formulas(self, line: &str) -> String {
        if self == Self::ColorAndSigns { formula::to_mathematical_signs(line) } else { line.to_owned() }
    }
}
