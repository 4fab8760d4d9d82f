//! The card of a scene: the picture and words of a wrong trace, for pages that are put together later.
use super::{Case, data, packed::Precision};
use fosssim_findings::Hints;
use serde::{Deserialize, Serialize};

/// The placeholder for the key of a card until its page is known. No text holds it: text has no control characters.
const KEY: &str = "\u{1}";

/// The placeholder for the cause that all scenes together give, which is known only later.
const CAUSE: &str = "\u{2}";

/// A card.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Card {
    /// The part that needs no script.
    html: String,
    /// The motions, and the findings that the viewer shows; empty without a motion.
    data: String,
    /// The data with rounded motions, for a page without room for exact ones; empty if that saves nothing.
    #[serde(default)]
    rounded: String,
}

/// Motions smaller than this are not worth rounding, in bytes.
const SMALL: usize = 60_000;

impl Card {
    /// Returns the card of a case below a heading of this depth; nothing if hints forbid it.
    #[must_use]
    pub fn for_case(case: &Case<'_>, depth: usize) -> Option<Self> {
        if case.hints == Hints::None {
            return None;
        }
        let blocks =
            |precision| case.evidence.map(|evidence| data::blocks(case, evidence, KEY, precision)).unwrap_or_default();
        let data = blocks(Precision::AsRoomAllows);
        let rounded = if data.len() > SMALL { blocks(Precision::Rounded) } else { String::new() };
        let rounded = if rounded.len() < data.len() { rounded } else { String::new() };
        Some(Self { html: case.trace_part(KEY, depth, CAUSE), data, rounded })
    }

    /// Returns a card with words only.
    #[must_use]
    pub fn from_words(words: &str) -> Self {
        Self { html: format!("<p>{}</p>\n", super::markup::text(words)), ..Self::default() }
    }

    /// Returns the card with a remark above it.
    #[must_use]
    pub fn noting(self, words: &str) -> Self {
        Self { html: Self::from_words(words).html + &self.html, ..self }
    }

    /// Returns the card as it is kept.
    #[must_use]
    pub fn to_kept(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }

    /// Returns a card that has been kept.
    #[must_use]
    pub fn from_kept(text: &str) -> Option<Self> {
        serde_json::from_str(text).ok()
    }

    /// Returns the bytes of the part without script, and of the motions.
    pub(super) fn sizes(&self) -> (usize, usize) {
        (self.html.len(), self.data.len())
    }

    /// Returns whether it shows the first difference with its values.
    pub(super) fn has_values(&self) -> bool {
        self.html.contains(super::case::FIRST)
    }

    /// Renders the part that needs no script, under a key that no other card of the page has, with its mistakes.
    pub(super) fn html(&self, key: &str, mistakes: &str) -> String {
        let html = self.html.replace(KEY, key);
        if html.contains(CAUSE) { html.replace(CAUSE, mistakes) } else { mistakes.to_owned() + &html }
    }

    /// Returns the motions.
    pub(super) fn data(&self, key: &str) -> String {
        self.data.replace(KEY, key)
    }

    /// Returns the bytes of rounded motions; `None` if they are no smaller than the others.
    pub(super) fn rounded_size(&self) -> Option<usize> {
        (!self.rounded.is_empty()).then_some(self.rounded.len())
    }

    /// Returns the motions, rounded.
    pub(super) fn round_motions(&self, key: &str) -> String {
        self.rounded.replace(KEY, key)
    }
}
