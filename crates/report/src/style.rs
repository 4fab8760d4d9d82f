//! Decoration for terminals: colors on top of text that makes sense without them.

/// Whether a report is decorated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Style {
    /// Plain text, for files, pipes and users who want no color.
    #[default]
    Plain,
    /// Color codes, for terminals.
    Color,
}

/// The look of a piece of text.
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
            (Self::Color, Look::Good) => "1;32",
            (Self::Color, Look::Bad) => "1;31",
            (Self::Color, Look::Notice) => "33",
            (Self::Color, Look::Strong) => "1",
            (Self::Color, Look::Faint) => "2",
        };
        format!("\x1b[{code}m{text}\x1b[0m")
    }
}
