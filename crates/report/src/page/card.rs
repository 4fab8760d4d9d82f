//! The card of a scene: what is drawn of a wrong trace while it is at hand, for pages that are put together later.
use super::{Case, data, packed::Precision};
use fosssim_findings::Hints;
use serde::{Deserialize, Serialize};

/// The placeholder for the key of a card until its page is known. No text holds it: text has no control characters.
const KEY: &str = "\u{1}";

/// The placeholder for what all scenes together say about its mistake, which is known later, too.
const CAUSE: &str = "\u{2}";

/// A card.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Card {
    /// The part that needs no script.
    html: String,
    /// The motions and what the viewer tells of them; empty where there is no motion.
    data: String,
    /// The data with rounded motions, for a page that has no room for exact ones; empty where that saves nothing.
    #[serde(default)]
    rounded: String,
}

/// Motions smaller than this are not worth rounding, in bytes.
const SMALL: usize = 60_000;

impl Card {
    /// Returns the card of a case below a heading of this depth; nothing where hints are to say nothing.
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

    /// Returns a card that only says something.
    #[must_use]
    pub fn saying(words: &str) -> Self {
        Self { html: format!("<p>{}</p>\n", super::markup::text(words)), ..Self::default() }
    }

    /// Returns the card with a remark above it.
    #[must_use]
    pub fn noting(self, words: &str) -> Self {
        Self { html: Self::saying(words).html + &self.html, ..self }
    }

    /// Returns the card as it is kept.
    #[must_use]
    pub fn kept(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }

    /// Returns a card that has been kept.
    #[must_use]
    pub fn from_kept(text: &str) -> Option<Self> {
        serde_json::from_str(text).ok()
    }

    /// Returns the bytes of what is there without script, and of the motions.
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

    /// Returns the bytes of rounded motions; `None` where they are no smaller than the others.
    pub(super) fn rounded_size(&self) -> Option<usize> {
        (!self.rounded.is_empty()).then_some(self.rounded.len())
    }

    /// Returns the motions, rounded.
    pub(super) fn rounded(&self, key: &str) -> String {
        self.rounded.replace(KEY, key)
    }
}
