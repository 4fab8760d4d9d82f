//! The part of a page about the smallest scene for a cause: the scene, both motions, the differing values, and the
//! computation by hand.
use super::{Card, case::mistakes, markup::escape, render_template};
use crate::{smallest::title, words::describe_first_difference};
use askama::Template;
use fosssim_findings::smallest_scene::SmallestScene;

/// Renders a smallest scene, and its card if it has one. `number` counts the smallest scenes of the page from 1.
pub(super) fn render_article(small: &SmallestScene, card: Option<&Card>, number: usize) -> String {
    let key = format!("small-{number}");
    let most_likely = &small.explanations[..small.explanations.len().min(1)];
    let mistakes = mistakes(most_likely, card.is_some_and(Card::has_values), None);
    let shown = card.map_or_else(|| mistakes.clone(), |card| card.render_with_mistakes(&key, &mistakes));
    render_template(&SmallestContent { small, card, number, key: &key, shown })
}

/// A smallest scene and its card, as the template reads them.
#[derive(Template)]
#[template(path = "smallest.html")]
struct SmallestContent<'a> {
    small: &'a SmallestScene,
    card: Option<&'a Card>,
    number: usize,
    key: &'a str,
    shown: String,
}

/// Returns the preformatted parts and their names. The scene itself comes first.
pub(super) fn list_parts(small: &SmallestScene) -> Vec<(&'static str, &str)> {
    let parts = [Some(small.xml.as_str()), small.difference.as_deref(), small.calculation.as_deref()];
    let named = ["The scene", "The values that differ", "By hand"].into_iter().zip(parts);
    named.filter_map(|(name, text)| Some((name, text?))).collect()
}

/// Renders preformatted text below a label.
pub(super) fn format_pre(label: &str, text: &str) -> String {
    format!("<pre tabindex=\"0\" role=\"region\" aria-label=\"{label}\">{}</pre>\n", escape(text.trim_end()))
}
