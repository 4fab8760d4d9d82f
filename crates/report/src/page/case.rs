//! One judged trace on a page.
use super::{Case, call, data, markup::text};
use crate::{
    check::{divergence_text, headline},
    explain,
    number::{count, general},
};
use fosssim_evidence::{Class, Evidence};
use fosssim_judge::{Account, Book, Outcome, Ruling};
use fosssim_num::tolerances::PARITY_MAXIMUM;
use fosssim_render::plot::{Embedding, PASSES_AXIS, Passes, RESIDUALS_AXIS, Residuals, Series};
use std::fmt::Write;

/// So many calls are shown.
const CALLS: usize = 6;

impl Case<'_> {
    pub(super) fn html(&self, number: usize) -> String {
        let check = &self.check;
        let outcome = check.outcome;
        let look = if check.accepted() { "good" } else { "bad" };
        let mut out = format!(
            "<article class=\"case\" data-case=\"{number}\" data-scene=\"{}\" aria-labelledby=\"title-{number}\">\n\
             <h1 id=\"title-{number}\"><span class=\"{look}\">{}</span>: {}</h1>\n\
             <p class=\"names\">scene {}<br>trace {}</p>\n",
            text(check.scene),
            text(&check.verdict().to_uppercase()),
            text(&headline(check)),
            text(check.scene),
            text(check.trace),
        );
        out += &books(outcome);
        let is_other_scene = check.explanations.iter().any(|one| one.is_other_scene());
        if !is_other_scene {
            out += &self.mistakes();
        }
        let account = outcome.account(check.rules.official());
        let other = outcome.fair.as_ref().and_then(|fair| fair.first_divergence.as_ref());
        let first = account.first_divergence.or(other);
        if let (Some(first), false) = (first, is_other_scene) {
            let _ = writeln!(out, "<h2>Where it goes wrong first</h2>");
            let _ = writeln!(
                out,
                "<pre tabindex=\"0\" role=\"region\" aria-label=\"First divergence\">{}</pre>",
                text(&divergence_text(first, outcome.steps))
            );
        }
        if let Some(evidence) = self.evidence {
            let _ = writeln!(
                out,
                "<h2>The motion</h2>\n<details class=\"motion\" hidden><summary>Look at both motions</summary>\
                 <div class=\"stage\"></div></details>\n<noscript><p>The motion viewer needs JavaScript; all else on this page \
                 does not.</p></noscript>"
            );
            if !evidence.window.is_whole(evidence.layout.steps) {
                let _ = writeln!(
                    out,
                    "<p class=\"hint\">The motion is long: steps {} to {} of {} are here, exact to the last bit.</p>",
                    evidence.window.first,
                    evidence.window.last,
                    count(u64::from(evidence.layout.steps))
                );
            }
            out += &plots(evidence, number, first.map(|first| first.step));
            let calls = evidence.close_ups.iter().flat_map(|up| up.calls.iter().map(move |one| (up.step, one)));
            let mut calls: Vec<_> = calls.collect();
            calls.sort_by_key(|(step, _)| Some(*step) != first.map(|first| first.step));
            if !calls.is_empty() {
                out += "<h2>The detection calls that are wrong</h2>\n";
                out.extend(calls.iter().take(CALLS).map(|(step, one)| call::html(*step, one)));
                if calls.len() > CALLS {
                    let _ = writeln!(out, "<p>{} more are not shown.</p>", calls.len() - CALLS);
                }
            }
        }
        if !account.examples.is_empty() {
            out += &findings(&account);
        }
        if let Some(evidence) = self.evidence {
            out += &data::blocks(self, evidence, number);
        }
        out + "</article>\n"
    }

    fn mistakes(&self) -> String {
        if self.check.explanations.is_empty() {
            return String::new();
        }
        let mut out = String::from("<h2>What explains it</h2>\n");
        for (place, one) in self.check.explanations.iter().enumerate() {
            let lines = explain::lines(std::slice::from_ref(one));
            let (first, rest) = lines.split_first().map_or(("", &[][..]), |(first, rest)| (first.as_str(), rest));
            let _ = write!(out, "<div class=\"mistake\"><p>{}</p>", text(first));
            if !rest.is_empty() {
                let _ = write!(
                    out,
                    "<pre tabindex=\"0\" role=\"region\" aria-label=\"Details\">{}</pre>",
                    text(&rest.join("\n"))
                );
            }
            if let (0, Some(what)) = (place, self.what_if) {
                let words = if what.equal {
                    "Proof: the reference with exactly this mistake writes the same trace, to the last bit."
                } else {
                    "The reference with exactly this mistake writes another trace: look at its motion beside yours below."
                };
                let _ = write!(out, "<p>{words}</p>");
            }
            out += "</div>\n";
        }
        out
    }
}

/// What both rule books say.
fn books(outcome: &Outcome) -> String {
    let row = |name: &str, book: Book| {
        let ruling = outcome.ruling(book);
        let look = if ruling == Ruling::Accepted { "good" } else { "bad" };
        format!(
            "<tr><th scope=\"row\">{name}</th><td class=\"{look}\">{}</td><td>{} of {} steps right</td></tr>\n",
            ruling.words(),
            count(u64::from(outcome.right_steps(book))),
            count(u64::from(outcome.steps))
        )
    };
    let fair = if outcome.fair.is_some() { row("the fair rules", Book::Fair) } else { String::new() };
    format!(
        "<table><caption>Both rule books</caption><tbody>\n{}{fair}</tbody></table>\n",
        row("the original's rules", Book::Parity)
    )
}

fn plots(evidence: &Evidence, number: usize, first: Option<u32>) -> String {
    let steps = evidence.steps.len();
    if steps == 0 {
        return String::new();
    }
    let positions: Vec<f64> = evidence.steps.iter().map(|step| step.position).collect();
    let velocities: Vec<f64> = evidence.steps.iter().map(|step| step.velocity).collect();
    let series = [Series { name: "positions", values: &positions }, Series { name: "velocities", values: &velocities }];
    let residuals = Residuals {
        title: "How far each step ends from where it should, given its own start",
        series: &series,
        tolerance: Some(PARITY_MAXIMUM),
        mark: first.map(|step| (step, "first divergence")),
    };
    let expected: Vec<u32> = evidence.steps.iter().map(|step| step.expected_passes).collect();
    let actual: Vec<Option<u32>> = evidence.steps.iter().map(|step| step.actual_passes).collect();
    let passes = Passes { title: "Detection passes in each step", expected: &expected, actual: &actual };
    let figure = |svg: &str, [left, right]: [f64; 2]| {
        format!(
            "<figure data-plot=\"{number}\" data-left=\"{left}\" data-right=\"{right}\" data-steps=\"{steps}\">{svg}</figure>\n"
        )
    };
    let count_of = |class: Class| evidence.steps.iter().filter(|step| step.class == class).count();
    let mut out = format!(
        "<h2>All steps</h2>\n<p>{} right, {} wrong by themselves, {} right but starting from where a wrong step has led.</p>\n",
        count_of(Class::Right),
        count_of(Class::Wrong),
        count_of(Class::Inherited)
    );
    out += &figure(&residuals.svg(Embedding::Inline), RESIDUALS_AXIS);
    if evidence.layout.polynomials {
        out += &figure(&passes.svg(Embedding::Inline), PASSES_AXIS);
    }
    out
}

fn findings(account: &Account<'_>) -> String {
    let mut out = String::from(
        "<h2>Findings</h2>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Findings\"><table><thead><tr>\
         <th scope=\"col\">kind</th><th scope=\"col\">count</th><th scope=\"col\">first example</th></tr></thead><tbody>\n",
    );
    for example in account.examples {
        let kind = example.kind();
        let _ = writeln!(
            out,
            "<tr><th scope=\"row\">{}</th><td class=\"num\">{}</td><td>{}</td></tr>",
            text(&kind.to_string()),
            count(account.counts.get(kind)),
            text(&example.to_string())
        );
    }
    out + "</tbody></table></div>\n"
}

/// A number in a table.
pub(super) fn number(value: f64) -> String {
    text(&general(value))
}
