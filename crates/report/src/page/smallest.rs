//! The smallest scene for a cause, on a page: the scene, both motions, the values that differ, the computation by hand.
use super::{Card, case::mistakes, markup::text};
use crate::{smallest::title, words::first_divergence};
use fosssim_findings::smallest::SmallestScene;
use std::fmt::Write;

/// Renders a smallest scene, the `number`-th of its page, with its card if there is one.
pub(super) fn article(small: &SmallestScene, card: Option<&Card>, number: usize) -> String {
    let key = format!("small-{number}");
    let mut out = format!(
        "<article class=\"case\" id=\"{key}\" data-case=\"{key}\" data-scene=\"small.xml\" \
         aria-labelledby=\"title-{key}\">\n<details class=\"scene\"{}><summary><h3 \
         id=\"title-{key}\">{}</h3></summary>\n",
        if number == 1 { " open" } else { "" },
        text(&title(small)),
    );
    let first = small.first.as_ref().filter(|_| card.is_none()).map(first_divergence);
    for line in small.note.iter().cloned().chain(first) {
        let _ = writeln!(out, "<p>{}</p>", text(&line));
    }
    out += &pre("The scene", &small.xml);
    let mistakes = mistakes(&small.explanations[..small.explanations.len().min(1)], card.is_some_and(Card::has_values));
    out += &card.map_or_else(|| mistakes.clone(), |card| card.html(&key, &mistakes));
    let parts =
        [("The values that differ", small.differs.as_ref()), ("By hand", small.by_hand.as_ref().map(|it| &it.text))];
    for (heading, words) in parts.into_iter().filter_map(|(heading, words)| Some((heading, words?))) {
        let _ = write!(out, "<h4>{heading}</h4>\n{}", pre(heading, words));
    }
    out += "</details>\n";
    out += &card.map(|card| card.data(&key)).unwrap_or_default();
    out + "</article>\n"
}

/// Renders text as a terminal shows it.
pub(super) fn pre(label: &str, words: &str) -> String {
    format!("<pre tabindex=\"0\" role=\"region\" aria-label=\"{label}\">{}</pre>\n", text(words.trim_end()))
}
