//! The page of `explain`: the likely mistakes of a program, trace by trace and all together.
use super::{
    Card,
    case::mistakes,
    document,
    graded::{self, key, rank},
    markup::text,
    script, smallest,
};
use crate::{case::Case, diagnosis::Diagnosis, words::first_divergence};
use fosssim_mistakes::diagnose::{Explanation, is_named_in};
use std::fmt::Write;

/// One trace with its pictures.
type ExplainedCase<'a> = (&'a Case, Option<&'a Card>);

/// Returns how hard the fault is to see; the smallest value is the clearest case. These cases come later: no pictures,
/// another mistake than the common ones, several mistakes that can't be distinguished, a large motion.
fn telling((case, card): ExplainedCase<'_>, common: &[Explanation]) -> (bool, usize, usize, usize) {
    let own = &case.explanations;
    (card.is_none(), rank(common, own), own.len(), card.map_or(0, |card| card.sizes().1))
}

/// A page about some traces of one program.
#[derive(Debug, Clone)]
pub struct ExplainedPage<'a> {
    /// The diagnosis that the page shows.
    pub diagnosis: &'a Diagnosis,
    /// The card of each of its traces, in their order, then that of each of its smallest scenes.
    pub cards: &'a [Option<Card>],
}

impl ExplainedPage<'_> {
    /// Renders the file.
    #[must_use]
    pub fn html(&self) -> String {
        let Diagnosis { cases, common, located, smallest: small } = self.diagnosis;
        let wrong = cases.iter().filter(|case| !case.accepted).count();
        let look = if wrong == 0 { "good" } else { "bad" };
        let title = match (&cases[..], wrong) {
            ([], _) => "The smallest scenes on which it is wrong".to_owned(),
            ([case], 0) => format!("{}: nothing to explain", case.scene),
            ([case], _) => format!("{}: what is wrong", case.scene),
            (_, 1) => format!("1 of {} traces is wrong", cases.len()),
            (_, wrong) => format!("{wrong} of {} traces are wrong", cases.len()),
        };
        let mut body = format!("<h1><span class=\"{look}\">{}</span></h1>\n", text(&title));
        body.extend(located.as_ref().map(graded::located));
        // A single trace has these words itself.
        for one in common.iter().filter(|_| cases.len() > 1) {
            let explained = cases.iter().filter(|case| is_named_in(one, &case.explanations)).count();
            let _ = writeln!(body, "<h2>Likely cause of {explained} of {wrong} wrong traces</h2>");
            body += &mistakes(std::slice::from_ref(one), false);
        }
        let all: Vec<ExplainedCase<'_>> =
            cases.iter().zip(self.cards).map(|(case, card)| (case, card.as_ref())).collect();
        let first =
            (0..all.len()).filter(|&number| !cases[number].accepted).min_by_key(|&number| telling(all[number], common));
        for (number, (small, card)) in small.iter().zip(&self.cards[cases.len()..]).enumerate() {
            body += &smallest::article(small, card.as_ref(), number + 1);
        }
        for (number, &one) in all.iter().enumerate() {
            body += &article(one, number, first == Some(number));
        }
        document(&title, &body, script())
    }
}

fn article((case, card): ExplainedCase<'_>, number: usize, open: bool) -> String {
    let Case { scene, trace, accepted, note, first, explanations } = case;
    let key = key(&format!("{number} {scene}"));
    let (look, word) = if *accepted { ("good", "right") } else { ("bad", "wrong") };
    let mut out = format!(
        "<article class=\"case\" data-case=\"{key}\" data-scene=\"{0}\" aria-labelledby=\"title-{key}\">\n\
         <details class=\"scene\"{1}><summary><h2 id=\"title-{key}\"><span class=\"chip {look}\">{word}</span> {0}</h2></summary>\n\
         <p class=\"names\">{2}</p>\n",
        text(scene),
        if open { " open" } else { "" },
        text(trace),
    );
    for line in note.iter().cloned().chain(first.as_ref().map(first_divergence)) {
        let _ = writeln!(out, "<p>{}</p>", text(&line));
    }
    if !*accepted && explanations.is_empty() {
        out += "<p>No known mistake explains it.</p>\n";
    }
    let mistakes = mistakes(explanations, card.is_some_and(Card::has_values));
    out += &card.map_or_else(|| mistakes.clone(), |card| card.html(&key, &mistakes));
    out += "</details>\n";
    out += &card.map(|card| card.data(&key)).unwrap_or_default();
    out + "</article>\n"
}
