//! The report on one trace: verdict, residuals, the fair rules, findings, first divergence.
//!
//! [`text`](Check::text) is for people, [`json`](Check::json) for programs (`schemas/check.schema.json`). Both say the
//! same and depend on nothing but the outcome.

pub(crate) mod advice;
mod asked;
pub(crate) mod books;
mod closer;
pub(crate) mod divergence;
mod fair;
mod fair_view;
pub(crate) mod first;
pub(crate) mod follows;
mod looks_like;
mod plots;
mod steps;
mod text;

pub use asked::{is_wrong, no_verdict, not_read};
pub use looks_like::{LOOKED_AT, looks_like};
pub use plots::plots;
pub use steps::{LISTED, StepChoice, WrongSteps};
pub use text::stopped;
pub(crate) use text::{headline, notes, problem};

use super::{
    describe::step_error,
    explain::{self, ExplanationView},
    grade::annotation,
    style::Style,
    view::{CHECK_SCHEMA, FindingView, document},
};
pub(crate) use fair_view::cause_view;
use fair_view::{CountedView, FairView};
use fosssim_findings::{Book, Damage, FindingKind, Outcome, Overall, Residuals, Rules, Ruling, Stop};
use fosssim_judge::{Unreadable, fair::cause};
use fosssim_mistakes::diagnose::Explanation;
use fosssim_model::sim::SearchCounts;
use serde::Serialize;
use std::collections::BTreeMap;
use steps::WrongStepView;

/// A judged trace with the names under which people know it.
#[derive(Debug, Clone, Copy)]
pub struct Check<'a> {
    /// The scene as typed.
    pub scene: &'a str,
    /// The trace as typed.
    pub trace: &'a str,
    /// The outcome of judging.
    pub outcome: &'a Outcome,
    /// Likely mistakes, the likeliest first; empty where nothing is wrong or nobody has asked.
    pub explanations: &'a [Explanation],
    /// Which rule books were asked.
    pub rules: Rules,
    /// The wrong steps, and which of them are shown one by one.
    pub steps: &'a WrongSteps,
    /// Whether certificates were audited, so that the counts of root searches are worth showing.
    pub audit: bool,
    /// Whether the text holds all tables, and not only what fits on a screen.
    pub tables: bool,
    /// The kind of file that the trace seems to be, where it begins like something else.
    pub looks_like: Option<&'a str>,
}

impl Check<'_> {
    /// Whether the trace is accepted.
    #[must_use]
    pub fn accepted(&self) -> bool {
        self.outcome.ruling(self.book()) == Ruling::Accepted
    }

    /// The official verdict in words: `accepted`, `wrong answer` or `bad trace`.
    #[must_use]
    pub fn verdict(&self) -> &'static str {
        self.outcome.ruling(self.book()).words()
    }

    /// Whether the file is no trace at all, which is all that there is to say of it.
    pub(crate) fn is_no_trace(&self) -> bool {
        self.looks_like.is_some() && !self.accepted()
    }

    /// Where the two rule books differ: which of them accepts the trace.
    #[must_use]
    pub fn difference(&self) -> Option<&'static str> {
        cause(self.outcome).map(fair::sides)
    }

    /// The official book.
    const fn book(&self) -> Book {
        self.rules.official()
    }

    /// The report for people.
    #[must_use]
    pub fn text(&self, style: Style) -> String {
        text::render(self, style)
    }

    /// Annotations for GitHub Actions: the verdict with the likely mistakes, if it is not accepted, and where the rule
    /// books differ.
    #[must_use]
    pub fn github(&self) -> String {
        let mut text = String::new();
        let title = format!("{}: {}", self.trace, self.verdict());
        if !self.accepted() {
            let place = self.outcome.stop.as_ref().map(|stop| stopped(stop, self.outcome));
            let first = first::first(self).map(|first| first.to_string());
            let likely = explain::sentence(self.explanations).filter(|_| !first::is_other_scene(self));
            let words: Vec<String> = [Some(text::headline(self)), place, first, likely].into_iter().flatten().collect();
            text += &annotation("error", &title, &words.join("; "));
        }
        if let Some(cause) = cause(self.outcome) {
            text += &annotation("warning", &title, &format!("the rule books differ: {cause}"));
        }
        text
    }

    /// The report for programs: one JSON object, indented, with a line feed at its end.
    #[must_use]
    pub fn json(&self) -> String {
        let outcome = self.outcome;
        let (book, account) = (self.book(), outcome.findings_by(self.book()));
        document(&CheckView {
            schema: CHECK_SCHEMA,
            scene: self.scene,
            trace: self.trace,
            rules: self.rules,
            official: book,
            verdict: self.verdict(),
            summary: text::headline(self),
            parity: Parity {
                overall: outcome.parity.overall,
                residuals: outcome.parity.residuals,
                collisions_passed: outcome.parity.collisions_passed,
                messages: messages(outcome),
            },
            fair: outcome.fair.as_deref().map(FairView::from),
            difference: cause(outcome).map(cause_view),
            first_divergence: account.first_divergence.as_ref().map(|first| FindingView::by(book, first)),
            findings: CountedView::all(book, &account.examples, |kind| account.counts.get(kind)),
            advice: advice::lines(self),
            commands: closer::commands(self),
            notes: text::notes(self),
            explanations: self.explanations.iter().map(ExplanationView::from).collect(),
            steps: outcome.steps,
            steps_judged: outcome.steps_judged,
            wrong_steps: account.wrong_steps,
            wrong_step_numbers: steps::numbers(self),
            shown_steps: steps::views(self),
            problem: outcome.stop.as_ref().map(StopView::from),
            damage: outcome.damage.as_ref().map(DamageView::from),
            trailing_bytes: outcome.trailing_bytes,
            root_searches: self.audit.then_some(outcome.searches),
        })
    }
}

/// How often the original prints each of its messages, in the words that graders of its output look for.
fn messages(outcome: &Outcome) -> BTreeMap<&'static str, u64> {
    let mut messages: BTreeMap<_, _> = FindingKind::ALL
        .into_iter()
        .filter_map(|kind| Some((kind.original_message()?, outcome.parity.findings.counts.get(kind))))
        .filter(|&(_, count)| count > 0)
        .collect();
    if outcome.parity.overall == Overall::None {
        messages.insert("Simulation did not run to completion", 1);
    }
    match outcome.stop {
        Some(Stop::Trace { cause: Unreadable::State, .. }) => {
            messages.insert("Failed to load timestep", 1);
        }
        Some(Stop::Trace { cause: Unreadable::Impulses, .. }) => {
            messages.insert("Error while trying to deserialize", 1);
        }
        _ => {}
    }
    messages
}

#[derive(Serialize)]
struct CheckView<'a> {
    schema: u32,
    scene: &'a str,
    trace: &'a str,
    rules: Rules,
    official: Book,
    verdict: &'static str,
    summary: String,
    parity: Parity,
    fair: Option<FairView<'a>>,
    difference: Option<serde_json::Value>,
    first_divergence: Option<FindingView>,
    findings: Vec<CountedView>,
    advice: Vec<&'static str>,
    commands: Vec<String>,
    notes: Vec<String>,
    explanations: Vec<ExplanationView>,
    steps: u32,
    steps_judged: u32,
    wrong_steps: u64,
    wrong_step_numbers: Vec<u32>,
    shown_steps: Option<Vec<WrongStepView>>,
    problem: Option<StopView>,
    damage: Option<DamageView>,
    trailing_bytes: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    root_searches: Option<SearchCounts>,
}

#[derive(Serialize)]
struct Parity {
    overall: Overall,
    #[serde(flatten)]
    residuals: Residuals,
    collisions_passed: Option<bool>,
    messages: BTreeMap<&'static str, u64>,
}

/// Why judging stopped early.
#[derive(Serialize)]
struct StopView {
    kind: &'static str,
    #[serde(flatten)]
    place: DamageView,
}

#[derive(Serialize)]
struct DamageView {
    step: u32,
    frame: Option<u64>,
    offset: Option<u64>,
    message: String,
}

impl From<&Damage> for DamageView {
    fn from(damage: &Damage) -> Self {
        let Damage { frame, step, offset, ref what } = *damage;
        Self { step, frame: Some(frame), offset: Some(offset), message: what.to_string() }
    }
}

impl From<&Stop> for StopView {
    fn from(stop: &Stop) -> Self {
        match stop {
            Stop::Trace { frame, step, cause, offset, what } => {
                let kind = match cause {
                    Unreadable::State => "state_unreadable",
                    Unreadable::Impulses => "impulses_unreadable",
                    Unreadable::Memory => "impossible_count",
                    Unreadable::Limit => "beyond_limit",
                    Unreadable::Io => "read_error",
                };
                let (frame, offset, message) = (Some(*frame), Some(*offset), what.to_string());
                Self { kind, place: DamageView { step: *step, frame, offset, message } }
            }
            Stop::Step(error) => {
                let (step, message) = step_error(error);
                Self { kind: "step_without_result", place: DamageView { step, frame: None, offset: None, message } }
            }
        }
    }
}
