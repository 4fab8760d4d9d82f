//! One judged trace on a page.
use super::{
    Case, call, data,
    markup::{self, escape, mark_difference, render_formula},
    packed_motions::Precision,
    render_document, render_template, script, strip,
};
use crate::{
    check::{
        Check, advice,
        books::verdicts,
        consequences, describe_problem,
        divergence::{self, Row, Value},
        first_finding::{find_first, is_other_scene},
        further_commands::suggest_next,
        list_notes, render_headline,
    },
    describe::pair_key,
    explain::ExplanationParts,
    number::group_digits,
    style::{Style, TextStyle},
};
use askama::Template;
use fosssim_evidence::{Evidence, Focus, InspectedCall};
use fosssim_findings::{Finding, FindingDetail, Hints};
use fosssim_judge::{Book, BookFindings, PairText, fair::find_cause};
use fosssim_mistakes::diagnose::Explanation;
use fosssim_num::{
    bounded::UNIT_ROUNDOFF,
    tolerances::{FAIR_UNITS, PARITY_MAX_RESIDUAL},
};
use fosssim_render::plot::{PassPlot, PlotTarget, ResidualPlot, STEPS_AXIS, Series};

/// The maximum number of detection calls that a page shows.
const MAX_CALLS: usize = 6;

/// The heading of the first difference.
pub(super) const FIRST_HEADING: &str = "First difference";

/// A detection call and the number of its step.
type StepCall<'e> = (u32, &'e InspectedCall);

impl Case<'_> {
    /// Renders a page about one case. `title` is the title of the browser's window.
    pub(super) fn render_page(&self, title: &str) -> String {
        render_document(title, &self.render_content("0"), script())
    }

    /// Renders the case as the whole content of a page.
    fn render_content(&self, key: &str) -> String {
        let check = &self.check;
        let verdict_class = match (check.is_accepted(), check.difference()) {
            (true, None) => "good",
            (true, Some(_)) => "warn",
            (false, _) => "bad",
        };
        let explanations = if is_other_scene(check) { &[][..] } else { check.explanations };
        let mistakes = self.describe_stop() + &mistakes(explanations, self.first().is_some(), None);
        let data = self.evidence.map(|evidence| data::render_blocks(self, evidence, key, Precision::Budgeted));
        let content = self.render_trace_part(key, 1, &mistakes) + &data.unwrap_or_default();
        render_template(&CaseContent { check, key, verdict_class, content })
    }

    /// Returns the finding that is shown first; `None` if there is none, or if the hints hide it.
    fn first(&self) -> Option<&Finding> {
        find_first(&self.check).filter(|_| self.hints == Hints::Full)
    }

    /// Renders the part about the trace, below a heading of level `depth`. The motion is next to its cause and the
    /// first wrong values. Everything that needs more space is below them.
    pub(super) fn render_trace_part(&self, key: &str, depth: usize, mistakes: &str) -> String {
        render_template(&TraceContent { case: self, check: &self.check, key, depth, mistakes })
    }

    /// Returns the data of the motion viewer, if there are any.
    fn motion(&self) -> Option<&Evidence> {
        self.evidence.filter(|evidence| !evidence.steps.is_empty())
    }

    /// Describes where and why judging stopped, with advice about what to check.
    fn describe_stop(&self) -> String {
        let outcome = self.check.outcome;
        let Some(stop) = outcome.stop_by(self.check.rules.official()) else { return String::new() };
        let (place, message, advice) = describe_problem(&stop, outcome);
        let advice = advice.map(|advice| format!("<p>{advice}</p>")).unwrap_or_default();
        format!(
            "<section class=\"card mistake\"><p class=\"label\">Stopped at {}</p><p class=\"lead\">{}</p>{advice}\
             </section>\n",
            escape(&place),
            escape(&message)
        )
    }

    /// Returns a sentence about whether a program with the likely mistake writes the same trace; `None` if there is no
    /// such run, or if the hints hide it.
    fn describe_proof(&self) -> Option<&'static str> {
        let what = self.mistake_run.filter(|_| self.hints == Hints::Full)?;
        Some(if what.equal {
            "Proof: the reference with exactly the likely mistake writes the same trace, bit for bit."
        } else {
            "The reference with exactly the likely mistake writes a different trace, by round-off or by more. \
             Compare its motion with yours."
        })
    }
}

/// The content of a page about one case, for the template.
#[derive(Template)]
#[template(path = "case.html")]
struct CaseContent<'a> {
    check: &'a Check<'a>,
    key: &'a str,
    /// The CSS class for the color of the verdict.
    verdict_class: &'static str,
    content: String,
}

/// The content of the part about a trace, for the template, with the mistakes as HTML.
#[derive(Template)]
#[template(path = "trace.html")]
struct TraceContent<'a> {
    case: &'a Case<'a>,
    check: &'a Check<'a>,
    key: &'a str,
    depth: usize,
    mistakes: &'a str,
}

/// Explanations for the template, which gives each its own box.
#[derive(Template)]
#[template(path = "mistakes.html")]
struct Mistakes {
    mistakes: Vec<ExplanationParts>,
    is_shown_beside: bool,
}

impl TraceContent<'_> {
    /// Returns the detection calls and their steps, with those of the first wrong step first. The first list has calls
    /// whose differences only follow from earlier wrong passes. The second list has calls that are wrong themselves.
    fn group_calls<'e>(&self, evidence: &'e Evidence) -> (Vec<StepCall<'e>>, Vec<StepCall<'e>>) {
        let first = self.case.first().map(|first| first.step);
        let calls = evidence.inspected.iter().flat_map(|up| up.calls.iter().map(move |call| (up.step, call)));
        let mut calls: Vec<_> = calls.collect();
        calls.sort_by_key(|(step, _)| Some(*step) != first);
        let follows = consequences::count_consequences(self.check.outcome) > 0;
        calls.into_iter().partition(|(_, call)| follows && call.pass.index > 0)
    }

    /// Renders the first calls of a list. If `open`, the first one is unfolded.
    fn render_first_calls(&self, calls: &[StepCall<'_>], open: bool) -> String {
        let call = |(number, (step, call)): (usize, &StepCall<'_>)| {
            call::render_call(*step, call, self.depth + 2, open && number == 0)
        };
        let mut out: String = calls.iter().take(MAX_CALLS).enumerate().map(call).collect();
        if calls.len() > MAX_CALLS {
            out += &format!("<p class=\"hint\">{} more are not shown.</p>\n", calls.len() - MAX_CALLS);
        }
        out
    }

    /// Returns the first finding of each kind, without findings that only follow from wrong positions.
    fn examples<'b>(&self, account: &'b BookFindings) -> impl Iterator<Item = &'b Finding> {
        let follows = consequences::count_consequences(self.check.outcome) > 0;
        account.examples.iter().filter(move |example| !(follows && consequences::is_formula_fault(example.kind())))
    }

    /// Renders plots of the error at the end of each step, and of the detection passes.
    fn plots(&self, evidence: &Evidence) -> String {
        let (key, first) = (self.key, self.case.first().map(|first| first.step));
        let tolerance = state_bound(evidence, self.check.rules.official());
        let step_count = evidence.steps.len();
        let positions: Vec<f64> = evidence.steps.iter().map(|step| step.position).collect();
        let velocities: Vec<f64> = evidence.steps.iter().map(|step| step.velocity).collect();
        let series =
            [Series { name: "positions", values: &positions }, Series { name: "velocities", values: &velocities }];
        let residuals = ResidualPlot {
            title: "Error at the end of each step",
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
                data-steps=\"{step_count}\">{svg}</figure>\n"
            )
        };
        let mut out = String::new();
        // A curve that would be flat is not drawn.
        if evidence.steps.iter().any(|step| !(step.position.max(step.velocity) <= tolerance)) {
            out += &figure(&residuals.svg(PlotTarget::Page));
        }
        let differ = evidence.steps.iter().any(|step| step.actual_passes != Some(step.expected_passes));
        if evidence.layout.has_polynomials && differ {
            out += &figure(&passes.svg(PlotTarget::Page));
        }
        if out.is_empty() { out } else { format!("<div class=\"charts\">\n{out}</div>\n") }
    }
}

/// Describes a finding whose values are in a table next to the text.
fn describe_finding(finding: &Finding) -> String {
    match &finding.detail {
        FindingDetail::Coefficient { place, .. } | FindingDetail::PolynomialDegree { place, .. } => place.to_string(),
        FindingDetail::WrongNormal { expected, .. } | FindingDetail::ContactTime { expected, .. } => {
            format!("the contact of {}", PairText(expected.pair))
        }
        FindingDetail::MissedCollision { expected } => {
            format!("{} collide, but the trace has no such collision", PairText(expected.pair))
        }
        FindingDetail::Position { particle, .. } if finding.step > 0 => format!("where particle {particle} ends"),
        FindingDetail::Velocity { particle, .. } if finding.step > 0 => {
            format!("the velocity of particle {particle} at the end")
        }
        _ => finding.describe().to_string(),
    }
}

/// Formats two values side by side as HTML, in the same notation. They are marked from the first digit that differs.
fn compare_cells(row: &Row) -> (String, String) {
    match (row.expected, row.actual) {
        (Value::Number(expected), Value::Number(actual)) => mark_difference(expected, actual, row.differs),
        // A single value is formatted like other numbers.
        (expected, actual) => (format_value(expected), format_value(actual)),
    }
}

/// Formats a single value as HTML. All digits are in its tooltip.
fn format_value(value: Value) -> String {
    match value {
        Value::Number(number) => markup::render_number(number),
        other => other.exact(),
    }
}

/// Renders explanations, each in its own box. If the first wrong values are shown next to them, an explanation's
/// example is left out. `wrong_state` describes a wrong state. It replaces the text about polynomials that no mistake
/// explains.
pub(super) fn mistakes(explanations: &[Explanation], is_shown_beside: bool, wrong_state: Option<&str>) -> String {
    let parts = explanations.iter().map(|explanation| match wrong_state.filter(|_| explanation.is_unexplained()) {
        Some(state) => ExplanationParts { sentence: state.to_owned(), ..ExplanationParts::default() },
        None => ExplanationParts::new(explanation, Style::ColorAndSigns),
    });
    render_template(&Mistakes { mistakes: parts.collect(), is_shown_beside })
}

/// Splits a sentence about a mistake into its first sentence, which becomes the heading, and the general rule after it.
fn split_lead(what: &str) -> (String, Option<&str>) {
    match what.split_once(". ") {
        Some((lead, more)) if !more.is_empty() => (format!("{lead}."), Some(more)),
        _ => (what.to_owned(), None),
    }
}

/// Returns the bound beyond which a rule book rejects a state. For the fair rules, the bound grows with the numbers, so
/// this is the bound for the largest numbers.
fn state_bound(evidence: &Evidence, book: Book) -> f64 {
    match book {
        Book::Parity => PARITY_MAX_RESIDUAL,
        Book::Fair => {
            let moduli = evidence.reference.values.iter().map(|value| value.abs());
            FAIR_UNITS * UNIT_ROUNDOFF * moduli.fold(0.0, f64::max)
        }
    }
}
