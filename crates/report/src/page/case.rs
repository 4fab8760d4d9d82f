//! One judged trace on a page.
use super::{
    Case, call, data, document,
    markup::{self, compared, formula, text},
    packed::Precision,
    script, strip,
};
use crate::{
    check::{
        Check, advice,
        books::{BookWords, verdicts},
        divergence::{self, SideBySide, Value},
        first::{first, is_other_scene},
        follows, headline, notes, problem,
    },
    describe::pair_key,
    explain::ExplanationParts,
    number::count,
    style::{Look, Style},
};
use fosssim_evidence::{Evidence, Focus, InspectedCall};
use fosssim_findings::{Finding, FindingDetail, Hints};
use fosssim_judge::{Book, BookFindings, PairWords, fair::cause};
use fosssim_mistakes::diagnose::Explanation;
use fosssim_num::{
    bounded::UNIT_ROUNDOFF,
    tolerances::{FAIR_UNITS, PARITY_MAXIMUM},
};
use fosssim_render::plot::{Embedding, PassPlot, ResidualPlot, STEPS_AXIS, Series};
use std::fmt::Write;

/// The greatest number of calls that are shown.
const CALLS: usize = 6;

/// The heading of the first difference.
pub(super) const FIRST: &str = "First difference";

impl Case<'_> {
    /// Renders a page about this case alone; the title is that of the window.
    pub(super) fn page(&self, title: &str) -> String {
        document(title, &self.html("0"), script())
    }

    /// Renders the case as a page's own content.
    fn html(&self, key: &str) -> String {
        let check = &self.check;
        let look = match (check.accepted(), check.difference()) {
            (true, None) => "good",
            (true, Some(_)) => "warn",
            (false, _) => "bad",
        };
        let mut out = format!(
            "<article class=\"case\" data-case=\"{key}\" data-scene=\"{}\" aria-labelledby=\"title-{key}\">\n\
             <h1 id=\"title-{key}\"><span class=\"chip {look}\">{}</span> {}</h1>\n\
             <p class=\"names\">scene {} &middot; trace {}</p>\n",
            text(check.scene),
            text(check.verdict()),
            text(&headline(check)),
            text(check.scene),
            text(check.trace),
        );
        if check.is_no_trace() {
            return out + "</article>\n";
        }
        if let (Some(sides), Some(cause)) = (check.difference(), cause(check.outcome)) {
            let _ = writeln!(out, "<p><span class=\"chip warn\">the rule books differ</span> {sides}: {cause}</p>");
        }
        let explanations = if is_other_scene(check) { &[][..] } else { check.explanations };
        out += &self.trace_part(key, 1, &(self.stopped() + &mistakes(explanations, self.first().is_some())));
        if let Some(evidence) = self.evidence {
            out += &data::blocks(self, evidence, key, Precision::AsRoomAllows);
        }
        out + "</article>\n"
    }

    /// Returns the finding that is shown first: of the book that counts, or of the other one where that has none.
    fn first(&self) -> Option<&Finding> {
        first(&self.check).filter(|_| self.hints == Hints::Full)
    }

    /// Returns the part about the trace, below a heading of the given depth: the motion next to its cause and the first
    /// wrong values, and below all that needs more room.
    pub(super) fn trace_part(&self, key: &str, depth: usize, mistakes: &str) -> String {
        let evidence = self.evidence.filter(|evidence| !evidence.steps.is_empty());
        let mut out = format!("<div class=\"split{}\">\n", if evidence.is_some() { " has-motion" } else { "" });
        let cause = mistakes.to_owned() + &self.proof();
        if !cause.is_empty() {
            let _ = writeln!(out, "<div class=\"mistakes\">\n{cause}</div>");
        }
        let full = evidence.filter(|_| self.hints == Hints::Full);
        if let Some(evidence) = evidence {
            let _ = writeln!(out, "<div class=\"seen\">\n{}</div>", stage(evidence));
        }
        out += &self.side(depth);
        out += "</div>\n";
        if let Some(evidence) = full {
            out += &plots(evidence, self.check.rules.official(), key, self.first().map(|first| first.step));
            out += &self.calls(evidence, depth);
        }
        let account = self.check.outcome.findings_by(self.check.rules.official());
        if self.hints == Hints::Full && !account.examples.is_empty() {
            out += &findings(account, follows::count(self.check.outcome));
        }
        out
    }

    /// Returns where the trace can't be followed any further, the reason, and the place to check.
    fn stopped(&self) -> String {
        let outcome = self.check.outcome;
        let Some(stop) = outcome.stop_of(self.check.rules.official()) else { return String::new() };
        let (place, message, advice) = problem(&stop, outcome);
        let advice = advice.map(|advice| format!("<p>{advice}</p>")).unwrap_or_default();
        format!(
            "<section class=\"card mistake\"><p class=\"label\">Stopped at {}</p><p class=\"lead\">{}</p>{advice}\
             </section>\n",
            text(&place),
            text(&message)
        )
    }

    /// Returns the sentence that the likely mistake writes the same trace.
    fn proof(&self) -> String {
        let Some(what) = self.what_if.filter(|_| self.hints == Hints::Full) else { return String::new() };
        let words = if what.equal {
            "Proof: the reference with exactly the likely mistake writes the same trace, to the last bit."
        } else {
            "The reference with exactly the likely mistake writes another trace: compare its motion with yours."
        };
        format!("<p class=\"hint\">{words}</p>\n")
    }

    /// Returns the first wrong place, the place to check, and the verdicts of the rule books.
    fn side(&self, depth: usize) -> String {
        let outcome = self.check.outcome;
        let heading = |words: &str| format!("<h{0}>{words}</h{0}>\n", depth + 1);
        let mut out = String::from("<div class=\"side\">\n");
        if let Some(first) = self.first() {
            let _ = writeln!(
                out,
                "<section class=\"card\">{}<p class=\"hint\">{}</p><p>{}</p>{}</section>",
                heading(FIRST),
                text(&step_of(first.step, outcome.steps)),
                text(&subject(first)),
                values(&divergence::side_by_side(&first.detail))
            );
            out += &list(&heading("Where to look"), &advice::lines(&self.check));
        }
        out += &books(&self.check, &heading("Rule books"));
        out += &list(&heading("Notes"), &notes(&self.check));
        out + "</div>\n"
    }

    /// Returns the detection calls that are wrong, and those that only follow from wrong positions.
    fn calls(&self, evidence: &Evidence, depth: usize) -> String {
        let first = self.first().map(|first| first.step);
        let calls = evidence.inspected.iter().flat_map(|up| up.calls.iter().map(move |one| (up.step, one)));
        let mut calls: Vec<_> = calls.collect();
        calls.sort_by_key(|(step, _)| Some(*step) != first);
        // Calls that only follow from where the passes before them led are no mistakes of detection.
        let follows = follows::count(self.check.outcome) > 0;
        let (follow, wrong): (Vec<_>, Vec<_>) = calls.into_iter().partition(|(_, call)| follows && call.pass.index > 0);
        let mut out = String::new();
        if !wrong.is_empty() {
            let _ = writeln!(out, "<h{0}>The detection calls that are wrong</h{0}>", depth + 1);
            out += &some(&wrong, depth, true);
        }
        if !follow.is_empty() {
            let _ = write!(
                out,
                "<details class=\"table\"><summary>Polynomials that follow from wrong positions</summary>\n\
                 <p>Their formulas are right, but the responses or the failsafe before them gave wrong \
                     positions.</p>\n{}</details>\n",
                some(&follow, depth, false)
            );
        }
        out
    }
}

/// Returns a card with these lines; nothing without any.
fn list(heading: &str, lines: &[impl AsRef<str>]) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let lines: String = lines.iter().map(|line| format!("<li>{}</li>", text(line.as_ref()))).collect();
    format!("<section class=\"card\">{heading}<ul>{lines}</ul></section>\n")
}

/// Returns the motion: a strip of all steps, whose place the viewer takes where there are scripts.
fn stage(evidence: &Evidence) -> String {
    let mut out = String::from("<div class=\"card motion\"><div class=\"stage\">\n");
    out += &strip::html(&evidence.steps);
    out += "<noscript><p>The motion viewer needs JavaScript; all else on this page does not.</p></noscript></div>\n";
    if !evidence.window.is_whole(evidence.layout.steps) {
        let _ = writeln!(
            out,
            "<div class=\"bar hint\">The motion is long: steps {} to {} of {} are here.</div>",
            evidence.window.first,
            evidence.window.last,
            count(u64::from(evidence.layout.steps))
        );
    }
    out + "</div>\n"
}

/// Returns the step of a finding in words.
fn step_of(step: u32, steps: u32) -> String {
    match step {
        0 => "the first record".to_owned(),
        step => format!("step {step} of {steps}"),
    }
}

/// Returns the subject of a finding whose values are in a table next to it.
fn subject(finding: &Finding) -> String {
    match &finding.detail {
        FindingDetail::Coefficient { place, .. } | FindingDetail::PolynomialDegree { place, .. } => place.to_string(),
        FindingDetail::WrongNormal { expected, .. } | FindingDetail::ContactTime { expected, .. } => {
            format!("the contact of {}", PairWords(expected.pair))
        }
        FindingDetail::MissedCollision { expected } => {
            format!("{} collide, and the trace misses it", PairWords(expected.pair))
        }
        FindingDetail::Position { particle, .. } if finding.step > 0 => format!("where particle {particle} ends"),
        FindingDetail::Velocity { particle, .. } if finding.step > 0 => {
            format!("the velocity with which particle {particle} ends")
        }
        _ => finding.what().to_string(),
    }
}

/// Writes values side by side: in one notation, and marked from the first digit that differs.
fn values(sides: &SideBySide) -> String {
    let mut out = String::new();
    if !sides.rows.is_empty() {
        out += "<table class=\"values\"><thead><tr><th scope=\"col\">value</th><th scope=\"col\" class=\"num\">expected</th>\
                <th scope=\"col\" class=\"num\">yours</th></tr></thead><tbody>\n";
        for row in &sides.rows {
            let (expected, actual) = match (row.expected, row.actual) {
                (Value::Number(expected), Value::Number(actual)) => compared(expected, actual, row.differs),
                // A value that stands alone is no longer than others.
                (expected, actual) => (alone(expected), alone(actual)),
            };
            let _ = writeln!(
                out,
                "<tr><th scope=\"row\">{}</th><td title=\"{}\">{expected}</td><td title=\"{}\">{actual}</td></tr>",
                row.name,
                row.expected.exact(),
                row.actual.exact()
            );
        }
        out += "</tbody></table>\n";
    }
    out.extend(sides.after.iter().map(|line| format!("<p class=\"hint\">{}</p>\n", text(line))));
    out
}

/// Returns a value without another to compare it with; the title has all its digits.
fn alone(value: Value) -> String {
    match value {
        Value::Number(number) => markup::number(number),
        other => other.exact(),
    }
}

/// Returns the first of some calls, each with its step; the first one is open.
fn some(calls: &[(u32, &InspectedCall)], depth: usize, open: bool) -> String {
    let call =
        |(number, (step, one)): (usize, &(u32, &InspectedCall))| call::html(*step, one, depth + 2, open && number == 0);
    let mut out: String = calls.iter().take(CALLS).enumerate().map(call).collect();
    if calls.len() > CALLS {
        let _ = writeln!(out, "<p class=\"hint\">{} more are not shown.</p>", calls.len() - CALLS);
    }
    out
}

/// Renders explanations, each in a box. An example is left out where the first wrong values are shown next to them.
pub(super) fn mistakes(explanations: &[Explanation], is_shown_beside: bool) -> String {
    let mut out = String::new();
    for one in explanations {
        let ExplanationParts { is_likely, what, evidence, details, example } =
            ExplanationParts::new(one, Style::ColorAndSigns);
        out += "<section class=\"card mistake\">";
        if is_likely {
            out += "<p class=\"label\">Likely mistake</p>";
        }
        // The first sentence is the heading; its general rule follows below.
        let (lead, more) = what.split_once(". ").unwrap_or((&what, ""));
        let dot = if more.is_empty() { "" } else { "." };
        let _ = write!(out, "<p class=\"lead\">{}{dot}</p>", text(lead));
        out.extend((!more.is_empty()).then(|| format!("<p>{}</p>", text(more))));
        out.extend(details.iter().map(|line| format!("<p>{}</p>", formula(line))));
        out.extend(evidence.map(|evidence| format!("<p class=\"hint\">{}</p>", text(&evidence))));
        if !example.is_empty() && !is_shown_beside {
            let _ = write!(
                out,
                "<pre tabindex=\"0\" role=\"region\" aria-label=\"Example\">{}</pre>",
                text(&example.join("\n"))
            );
        }
        out += "</section>\n";
    }
    out
}

/// Returns the verdicts of both rule books, as the text report says them.
fn books(check: &Check<'_>, heading: &str) -> String {
    let Some(verdicts) = verdicts(check) else { return String::new() };
    let line = |(name, look, word, grounds): BookWords| {
        let look = match look {
            Look::Good => "good",
            Look::Bad => "bad",
            _ => "warn",
        };
        let grounds = if grounds.is_empty() { grounds } else { format!(": {}", text(&grounds)) };
        format!("<li>{name}: <strong class=\"{look}\">{word}</strong>{grounds}</li>")
    };
    let lines: String = verdicts.into_iter().map(line).collect();
    format!("<section class=\"card\">{heading}<ul class=\"books\">{lines}</ul></section>\n")
}

/// Returns the bound beyond which a book calls a state wrong. By the fair rules the bound grows with the numbers; the
/// one of the largest numbers is shown.
fn bound(evidence: &Evidence, book: Book) -> f64 {
    match book {
        Book::Parity => PARITY_MAXIMUM,
        Book::Fair => {
            let moduli = evidence.reference.values.iter().map(|value| value.abs());
            FAIR_UNITS * UNIT_ROUNDOFF * moduli.fold(0.0, f64::max)
        }
    }
}

fn plots(evidence: &Evidence, book: Book, key: &str, first: Option<u32>) -> String {
    let tolerance = bound(evidence, book);
    let steps = evidence.steps.len();
    let positions: Vec<f64> = evidence.steps.iter().map(|step| step.position).collect();
    let velocities: Vec<f64> = evidence.steps.iter().map(|step| step.velocity).collect();
    let series = [Series { name: "positions", values: &positions }, Series { name: "velocities", values: &velocities }];
    let residuals = ResidualPlot {
        title: "How far each step ends from where it should",
        series: &series,
        tolerance,
        mark: first.map(|step| (step, "first difference")),
    };
    let expected: Vec<u32> = evidence.steps.iter().map(|step| step.expected_passes).collect();
    let actual: Vec<Option<u32>> = evidence.steps.iter().map(|step| step.actual_passes).collect();
    let passes = PassPlot { title: "Detection passes in each step", expected: &expected, actual: &actual };
    let [left, right] = STEPS_AXIS;
    let figure = |svg: &str| {
        format!(
            "<figure tabindex=\"0\" data-plot=\"{key}\" data-left=\"{left}\" data-right=\"{right}\" \
            data-steps=\"{steps}\">{svg}</figure>\n"
        )
    };
    let mut out = String::new();
    // Flat curves show nothing.
    if evidence.steps.iter().any(|step| !(step.position.max(step.velocity) <= tolerance)) {
        out += &figure(&residuals.svg(Embedding::Inline));
    }
    let differ = evidence.steps.iter().any(|step| step.actual_passes != Some(step.expected_passes));
    if evidence.layout.polynomials && differ {
        out += &figure(&passes.svg(Embedding::Inline));
    }
    if out.is_empty() { out } else { format!("<div class=\"charts\">\n{out}</div>\n") }
}

/// Returns all kinds of findings, folded; those that only follow from wrong positions under that name.
fn findings(account: &BookFindings, follow: u64) -> String {
    let of_formula = |finding: &&Finding| follow > 0 && follows::is_of_formula(finding.kind());
    let total = count(account.counts.total());
    let mut out = format!("<details class=\"table\"><summary>All findings: {total}</summary>\n");
    out += &markup::table("scroll", "Findings", "", &["kind", "#count", "first example"]);
    for example in account.examples.iter().filter(|example| !of_formula(example)) {
        let kind = example.kind();
        let _ = writeln!(
            out,
            "<tr data-step=\"{}\" data-pair=\"{}\"><th scope=\"row\">{}</th><td class=\"num\">{}</td>\
             <td class=\"words\">{}</td></tr>",
            example.step,
            Focus::from(example).pair.map(pair_key).unwrap_or_default(),
            text(&kind.to_string()),
            count(account.counts.get(kind)),
            text(&example.to_string())
        );
    }
    if follow > 0 {
        let _ = writeln!(
            out,
            "<tr><th scope=\"row\">polynomials that follow from wrong positions</th><td class=\"num\">{}</td>\
             <td class=\"words\">their formulas are right</td></tr>",
            count(follow)
        );
    }
    out + "</tbody></table></div></details>\n"
}
