//! The card of a scene: the picture and the text about a wrong trace. Cards are stored, and pages are assembled from
//! them later.
use super::{Case, data, packed_motions::Precision};
use fosssim_findings::Hints;
use serde::{Deserialize, Serialize};

/// The placeholder for a card's key, until the card's page is known. It is a control character, which no text contains.
pub(super) const KEY_PLACEHOLDER: &str = "\u{1}";

/// The placeholder for the mistakes that all scenes have in common, which are known later.
const CAUSE_MARK: &str = "\u{2}";

/// The stored part of a page about one scene.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Card {
    /// The HTML that is useful without a script.
    html: String,
    /// The motions and the findings for the viewer, as script text; empty if there is no motion.
    data: String,
    /// The data with rounded motions, for pages without space for exact ones; empty if rounding saves nothing.
    #[serde(default)]
    pub(super) rounded: String,
}

/// The size in bytes from which motions are rounded.
const ROUNDING_THRESHOLD_BYTES: usize = 60_000;

impl Card {
    /// Returns the card of a case, below a heading of level `depth`; `None` if the hints do not allow it.
    pub fn for_case(case: &Case<'_>, depth: usize) -> Option<Self> {
        if case.hints == Hints::None {
            return None;
        }
        let blocks = |precision| {
            case.evidence
                .map(|evidence| data::render_blocks(case, evidence, KEY_PLACEHOLDER, precision))
                .unwrap_or_default()
        };
        let data = blocks(Precision::Budgeted);
        let rounded = if data.len() > ROUNDING_THRESHOLD_BYTES { blocks(Precision::Rounded) } else { String::new() };
        let rounded = if rounded.len() < data.len() { rounded } else { String::new() };
        Some(Self { html: case.render_trace_part(KEY_PLACEHOLDER, depth, CAUSE_MARK), data, rounded })
    }

    /// Returns a card that contains only text.
    pub fn from_text(text: &str) -> Self {
        Self { html: format!("<p>{}</p>\n", super::markup::escape(text)), ..Self::default() }
    }

    /// Returns the card with a remark above its content.
    #[must_use]
    pub fn with_remark(self, remark: &str) -> Self {
        Self { html: Self::from_text(remark).html + &self.html, ..self }
    }

    /// Returns the card in the form in which it is stored.
    pub fn to_stored(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }

    /// Parses a card in the form in which it is stored; `None` if it is damaged.
    pub fn from_stored(text: &str) -> Option<Self> {
        serde_json::from_str(text).ok()
    }

    /// Returns the size of the HTML and that of the motions, in bytes.
    pub(super) fn sizes(&self) -> (usize, usize) {
        (self.html.len(), self.data.len())
    }

    /// Returns whether the card shows the values of the first difference.
    pub(super) fn has_values(&self) -> bool {
        self.html.contains(super::case::FIRST_HEADING)
    }

    /// Returns the card's HTML with the mistakes inserted. `key` makes the element IDs unique on the page.
    pub(super) fn render_with_mistakes(&self, key: &str, mistakes: &str) -> String {
        let html = self.html.replace(KEY_PLACEHOLDER, key);
        if html.contains(CAUSE_MARK) { html.replace(CAUSE_MARK, mistakes) } else { mistakes.to_owned() + &html }
    }

    /// Returns the exact motions as script text, in which `key` replaces the placeholder.
    pub(super) fn data(&self, key: &str) -> String {
        self.data.replace(KEY_PLACEHOLDER, key)
    }

    /// Returns the size of the rounded motions in bytes; `None` if rounding saves nothing.
    pub(super) fn rounded_size(&self) -> Option<usize> {
        (!self.rounded.is_empty()).then_some(self.rounded.len())
    }
}
