//! The page of `explain`. It shows the likely mistakes of a program, for each trace and for all traces together.
use super::{
    Card,
    case::mistakes,
    grade_page::{self, scene_key},
    render_document, render_template, script, smallest,
};
use crate::{case::Case, diagnosis::Diagnosis, grade::rank, words::describe_first_difference};
use askama::Template;
use fosssim_mistakes::diagnose::{Explanation, is_named_in};

/// A trace, and its card if it has one.
type ExplainedCase<'a> = (&'a Case, Option<&'a Card>);

/// Returns how hard the fault of a case is to see. The clearest case has the smallest value. The criteria are whether
/// the case has a picture, whether its mistake is a common one, the number of mistakes that can't be distinguished, and
/// the size of the motion.
fn clarity_rank((case, card): ExplainedCase<'_>, common: &[Explanation]) -> (bool, usize, usize, usize) {
    let own = &case.explanations;
    (card.is_none(), rank(common, own), own.len(), card.map_or(0, |card| card.sizes().1))
}

/// A page about several traces of the same program.
#[derive(Debug, Clone)]
pub struct ExplainedPage<'a> {
    /// The diagnosis that the page shows.
    pub diagnosis: &'a Diagnosis,
    /// The cards of the diagnosis's traces, in order, and after them the cards of its smallest scenes.
    pub cards: &'a [Option<Card>],
}

impl ExplainedPage<'_> {
    /// Renders the page as one HTML file.
    pub fn html(&self) -> String {
        let cases = &self.diagnosis.cases;
        let wrong_count = cases.iter().filter(|case| !case.accepted).count();
        let title_class = if wrong_count == 0 && !cases.is_empty() { "good" } else { "bad" };
        let title = match (&cases[..], wrong_count) {
            ([], _) => "The smallest scenes on which the program is wrong".to_owned(),
            ([case], 0) => format!("{}: nothing to explain", case.scene),
            ([case], _) => format!("{}: what is wrong", case.scene),
            (_, 1) => format!("1 of {} traces is wrong", cases.len()),
            (_, wrong_count) => format!("{wrong_count} of {} traces are wrong", cases.len()),
        };
        let content = ExplainedContent { page: self, title: &title, title_class, wrong: wrong_count };
        render_document(&title, &render_template(&content), script())
    }
}

/// The content of the page, for the template.
#[derive(Template)]
#[template(path = "explained.html")]
struct ExplainedContent<'a> {
    page: &'a ExplainedPage<'a>,
    title: &'a str,
    /// The CSS class for the color of the title.
    title_class: &'static str,
    /// The number of traces that are wrong.
    wrong: usize,
}

/// The part of the page about one trace, with its card and its motion if it has them.
struct Trace<'a> {
    case: &'a Case,
    key: String,
    open: bool,
    shown: String,
    motion: String,
}

impl ExplainedContent<'_> {
    /// Returns the mistakes that explain several traces, and the number of these traces. For a single trace the list is
    /// empty, because its card names them.
    fn shared_mistakes(&self) -> impl Iterator<Item = (&Explanation, usize)> {
        let Diagnosis { cases, common, .. } = self.page.diagnosis;
        let count_explained =
            |explanation| cases.iter().filter(|case| is_named_in(explanation, &case.explanations)).count();
        common.iter().filter(|_| cases.len() > 1).map(move |explanation| (explanation, count_explained(explanation)))
    }

    /// Renders an article for each smallest scene.
    fn smallest(&self) -> String {
        let Diagnosis { cases, smallest: small, .. } = self.page.diagnosis;
        let small = small.iter().zip(&self.page.cards[cases.len()..]).zip(1..);
        small.map(|((small, card), number)| smallest::render_article(small, card.as_ref(), number)).collect()
    }

    /// Returns the parts about the traces. The clearest one is unfolded.
    fn traces(&self) -> Vec<Trace<'_>> {
        let Diagnosis { cases, common, .. } = self.page.diagnosis;
        let all: Vec<ExplainedCase<'_>> = cases.iter().zip(self.page.cards.iter().map(Option::as_ref)).collect();
        let wrong = (0..all.len()).filter(|&number| !cases[number].accepted);
        let first = wrong.min_by_key(|&number| clarity_rank(all[number], common));
        let trace = |(number, (case, card)): (usize, ExplainedCase<'_>)| {
            let key = scene_key(&format!("{number} {}", case.scene));
            let mistakes = mistakes(&case.explanations, card.is_some_and(Card::has_values), None);
            let article = card.map_or_else(|| mistakes.clone(), |card| card.render_with_mistakes(&key, &mistakes));
            let motion = card.map(|card| card.data(&key)).unwrap_or_default();
            Trace { case: &cases[number], key, open: first == Some(number), shown: article, motion }
        };
        all.into_iter().enumerate().map(trace).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grade::samples;

    #[test]
    fn a_page_of_smallest_scenes_alone_is_about_a_wrong_program() {
        let diagnosis = Diagnosis { smallest: vec![samples::smallest(Vec::new())], ..Diagnosis::default() };
        let page = ExplainedPage { diagnosis: &diagnosis, cards: &[None] }.html();
        assert!(page.contains("<span class=\"bad\">The smallest scenes"), "{page:.2000}");
    }
}
