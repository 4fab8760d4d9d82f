//! The card of a scene: the picture and the text about a wrong trace, for pages that are assembled later.
use super::{Case, data, packed::Precision};
use fosssim_findings::Hints;
use serde::{Deserialize, Serialize};

/// The placeholder for a card's key until its page is known. The key is a control character, which no text contains.
const KEY_PLACEHOLDER: &str = "\u{1}";

/// The placeholder for the common cause of all scenes, which is known later.
const CAUSE_MARK: &str = "\u{2}";

/// A card.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Card {
    /// The part that works without a script.
    html: String,
    /// The motions and the findings for the viewer; empty without a motion.
    data: String,
    /// The data with rounded motions, for pages that have no space for exact ones; empty if rounding saves nothing.
    #[serde(default)]
    rounded: String,
}

/// The minimum size of motions that are rounded, in bytes.
const MIN_ROUNDED_BYTES: usize = 60_000;

impl Card {
    /// Returns the card of a case below a heading of level `depth`; `None` if hints forbid it.
    #[must_use]
    pub fn for_case(case: &Case<'_>, depth: usize) -> Option<Self> {
        if case.hints == Hints::None {
            return None;
        }
        let blocks = |precision| {
            case.evidence
                .map(|evidence| data::render_blocks(case, evidence, KEY_PLACEHOLDER, precision))
                .unwrap_or_default()
        };
        let data = blocks(Precision::AsRoomAllows);
        let rounded = if data.len() > MIN_ROUNDED_BYTES { blocks(Precision::Rounded) } else { String::new() };
        let rounded = if rounded.len() < data.len() { rounded } else { String::new() };
        Some(Self { html: case.trace_part(KEY_PLACEHOLDER, depth, CAUSE_MARK), data, rounded })
    }

    /// Returns a card that contains only text.
    #[must_use]
    pub fn from_words(words: &str) -> Self {
        Self { html: format!("<p>{}</p>\n", super::markup::text(words)), ..Self::default() }
    }

    /// Returns the card with a note above its content.
    #[must_use]
    pub fn with_remark(self, words: &str) -> Self {
        Self { html: Self::from_words(words).html + &self.html, ..self }
    }

    /// Returns the card in its stored form.
    #[must_use]
    pub fn to_stored(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }

    /// Parses a card in its stored form.
    #[must_use]
    pub fn from_stored(text: &str) -> Option<Self> {
        serde_json::from_str(text).ok()
    }

    /// Returns the sizes of the part without script and of the motions, in bytes.
    pub(super) fn sizes(&self) -> (usize, usize) {
        (self.html.len(), self.data.len())
    }

    /// Returns whether the card shows the values of the first difference.
    pub(super) fn has_values(&self) -> bool {
        self.html.contains(super::case::FIRST_HEADING)
    }

    /// Renders the part without script, with its mistakes, under a key that is unique on the page.
    pub(super) fn html(&self, key: &str, mistakes: &str) -> String {
        let html = self.html.replace(KEY_PLACEHOLDER, key);
        if html.contains(CAUSE_MARK) { html.replace(CAUSE_MARK, mistakes) } else { mistakes.to_owned() + &html }
    }

    /// Returns the exact motions as script text, with the key replaced by `key`.
    pub(super) fn data(&self, key: &str) -> String {
        self.data.replace(KEY_PLACEHOLDER, key)
    }

    /// Returns the number of bytes of rounded motions; `None` if rounding saves nothing.
    pub(super) fn rounded_size(&self) -> Option<usize> {
        (!self.rounded.is_empty()).then_some(self.rounded.len())
    }

    /// Returns the rounded motions as script text.
    pub(super) fn round_motions(&self, key: &str) -> String {
        self.rounded.replace(KEY_PLACEHOLDER, key)
    }
}
