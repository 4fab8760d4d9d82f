//! One judged trace on a page.
use super::{Case, call, data, markup::text, packed::Precision, strip};
use crate::{
    check::{divergence_text, follows, headline},
    explain,
    number::count,
};
use fosssim_evidence::{Evidence, Focus, InspectedCall};
use fosssim_findings::Hints;
use fosssim_judge::{Book, BookFindings, Outcome, Ruling};
use fosssim_mistakes::diagnose::Explanation;
use fosssim_num::tolerances::PARITY_MAXIMUM;
use fosssim_render::plot::{Embedding, PASSES_AXIS, PassPlot, RESIDUALS_AXIS, ResidualPlot, Series};
use std::fmt::Write;

/// The greatest number of calls that are shown.
const CALLS: usize = 6;

impl Case<'_> {
    /// The case as a page's own content.
    pub(super) fn html(&self, key: &str) -> String {
        let check = &self.check;
        let look = if check.accepted() { "good" } else { "bad" };
        let mut out = format!(
            "<article class=\"case\" data-case=\"{key}\" data-scene=\"{}\" aria-labelledby=\"title-{key}\">\n\
             <h1 id=\"title-{key}\"><span class=\"{look}\">{}</span>: {}</h1>\n\
             <p class=\"names\">scene {}<br>trace {}</p>\n",
            text(check.scene),
            text(&check.verdict().to_uppercase()),
            text(&headline(check)),
            text(check.scene),
            text(check.trace),
        );
        if !self.is_other_scene() && !check.explanations.is_empty() {
            out += "<h2>What explains it</h2>\n";
            out += &mistakes(check.explanations);
        }
        out += &self.trace_part(key, 1);
        if let Some(evidence) = self.evidence {
            out += &data::blocks(self, evidence, key, Precision::AsRoomAllows);
        }
        out + "</article>\n"
    }

    /// Where the trace is another scene's, nothing that differs is a mistake.
    fn is_other_scene(&self) -> bool {
        self.check.explanations.iter().any(|one| one.is_other_scene())
    }

    /// What is shown of the trace, below a heading of the given depth.
    pub(super) fn trace_part(&self, key: &str, depth: usize) -> String {
        let outcome = self.check.outcome;
        let is_full = self.hints == Hints::Full;
        let heading = |words: &str| format!("<h{0}>{words}</h{0}>\n", depth + 1);
        let mut out = books(outcome);
        let account = outcome.findings_by(self.check.rules.official());
        let other = outcome.fair.as_ref().and_then(|fair| fair.findings.first_divergence.as_ref());
        let first = account.first_divergence.as_ref().or(other);
        if let (Some(first), true) = (first, is_full && !self.is_other_scene()) {
            let _ = writeln!(
                out,
                "{}<pre tabindex=\"0\" role=\"region\" aria-label=\"First divergence\">{}</pre>",
                heading("Where it goes wrong first"),
                text(&divergence_text(first, outcome.steps))
            );
        }
        if let Some(evidence) = self.evidence.filter(|evidence| !evidence.steps.is_empty()) {
            out += &heading("The motion");
            if let (Some(what), true) = (self.what_if, is_full) {
                let words = if what.equal {
                    "Proof: the reference with exactly the likely mistake writes the same trace, to the last bit."
                } else {
                    "The reference with exactly the likely mistake writes another trace: look at its motion beside yours."
                };
                let _ = writeln!(out, "<p>{words}</p>");
            }
            let _ = writeln!(
                out,
                "<details class=\"motion\" hidden><summary>Look at {}</summary><div class=\"stage\"></div></details>\n\
                 <noscript><p>The motion viewer needs JavaScript; all else on this page does not.</p></noscript>",
                if is_full { "both motions" } else { "the motion" }
            );
            if !evidence.window.is_whole(evidence.layout.steps) {
                let _ = writeln!(
                    out,
                    "<p class=\"hint\">The motion is long: steps {} to {} of {} are here.</p>",
                    evidence.window.first,
                    evidence.window.last,
                    count(u64::from(evidence.layout.steps))
                );
            }
            out += &heading("All steps");
            out += &strip::html(&evidence.steps);
            if is_full {
                out += &plots(evidence, key, first.map(|first| first.step));
                let calls = evidence.inspected.iter().flat_map(|up| up.calls.iter().map(move |one| (up.step, one)));
                let mut calls: Vec<_> = calls.collect();
                calls.sort_by_key(|(step, _)| Some(*step) != first.map(|first| first.step));
                // What only follows from where the passes before it led is no mistake of detection.
                let follows = follows::count(outcome) > 0;
                let (follow, wrong): (Vec<_>, Vec<_>) =
                    calls.into_iter().partition(|(_, call)| follows && call.pass.index > 0);
                if !wrong.is_empty() {
                    out += &heading("The detection calls that are wrong");
                    out += &some(&wrong, depth);
                }
                if !follow.is_empty() {
                    let _ = write!(
                        out,
                        "<details class=\"table\"><summary>Polynomials that follow from wrong positions</summary>\n\
                         <p>Their formulas are right: they look at where the responses or the failsafe before them led.</p>\n{}</details>\n",
                        some(&follow, depth)
                    );
                }
            }
        }
        if is_full && !account.examples.is_empty() {
            out += &heading("Findings");
            out += &findings(account);
        }
        out
    }
}

/// The first ones of some calls, each with its step.
fn some(calls: &[(u32, &InspectedCall)], depth: usize) -> String {
    let mut out: String = calls.iter().take(CALLS).map(|(step, one)| call::html(*step, one, depth + 2)).collect();
    if calls.len() > CALLS {
        let _ = writeln!(out, "<p>{} more are not shown.</p>", calls.len() - CALLS);
    }
    out
}

/// Explanations, each in a box.
pub(super) fn mistakes(explanations: &[Explanation]) -> String {
    let mut out = String::new();
    for one in explanations {
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
        out += "</div>\n";
    }
    out
}

/// The verdicts of both rule books.
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

fn plots(evidence: &Evidence, key: &str, first: Option<u32>) -> String {
    let steps = evidence.steps.len();
    let positions: Vec<f64> = evidence.steps.iter().map(|step| step.position).collect();
    let velocities: Vec<f64> = evidence.steps.iter().map(|step| step.velocity).collect();
    let series = [Series { name: "positions", values: &positions }, Series { name: "velocities", values: &velocities }];
    let residuals = ResidualPlot {
        title: "How far each step ends from where it should, given its own start",
        series: &series,
        tolerance: Some(PARITY_MAXIMUM),
        mark: first.map(|step| (step, "first divergence")),
    };
    let expected: Vec<u32> = evidence.steps.iter().map(|step| step.expected_passes).collect();
    let actual: Vec<Option<u32>> = evidence.steps.iter().map(|step| step.actual_passes).collect();
    let passes = PassPlot { title: "Detection passes in each step", expected: &expected, actual: &actual };
    let figure = |svg: &str, [left, right]: [f64; 2]| {
        format!(
            "<figure data-plot=\"{key}\" data-left=\"{left}\" data-right=\"{right}\" data-steps=\"{steps}\">{svg}</figure>\n"
        )
    };
    let mut out = figure(&residuals.svg(Embedding::Inline), RESIDUALS_AXIS);
    if evidence.layout.polynomials {
        out += &figure(&passes.svg(Embedding::Inline), PASSES_AXIS);
    }
    out
}

fn findings(account: &BookFindings) -> String {
    let mut out = String::from(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Findings\"><table><thead><tr>\
         <th scope=\"col\">kind</th><th scope=\"col\">count</th><th scope=\"col\">first example</th></tr></thead><tbody>\n",
    );
    for example in &account.examples {
        let kind = example.kind();
        let _ = writeln!(
            out,
            "<tr data-step=\"{}\" data-pair=\"{}\"><th scope=\"row\">{}</th><td class=\"num\">{}</td><td>{}</td></tr>",
            example.step,
            Focus::from(example).pair.map(data::key).unwrap_or_default(),
            text(&kind.to_string()),
            count(account.counts.get(kind)),
            text(&example.to_string())
        );
    }
    out + "</tbody></table></div>\n"
}
