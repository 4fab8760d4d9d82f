//! The report on one trace. It contains the verdict, the residuals, the fair rules' judgment, the findings and the
//! first difference.
//!
//! [`render_text`](Check::render_text) renders the report as text, and [`json`](Check::json) renders it as JSON
//! (`schemas/check.schema.json`). Both have the same content, which depends only on the outcome.

pub(crate) mod advice;
pub(crate) mod books;
pub(crate) mod consequences;
pub(crate) mod divergence;
mod fair;
mod fair_view;
mod file_signature;
pub(crate) mod first_finding;
pub(crate) mod further_commands;
mod steps;
mod text;
mod verdict_gaps;

pub use file_signature::{SNIFFED_BYTES, detect_file_kind};
pub use steps::{MAX_LISTED, StepChoice, WrongSteps};
pub use text::describe_stop;
pub(crate) use text::{describe_problem, list_notes, render_headline};
pub use verdict_gaps::{describe_no_verdict, describe_unread, needs_explanation};

use super::{
    annotation::render_annotation,
    explain::{self, ExplanationView},
    style::Style,
    view::{CHECK_SCHEMA, FindingView, to_document, view},
};
pub(crate) use fair_view::CauseView;
use fair_view::{CountedView, FairView};
use fosssim_findings::{Book, BookFindings, Damage, FindingKind, Outcome, Overall, Residuals, Rules, Ruling, Stop};
use fosssim_judge::{MissingResult, ReadFailure, fair::find_cause};
use fosssim_mistakes::diagnose::Explanation;
use serde::Serialize;
use std::collections::BTreeMap;
use steps::WrongStepView;

/// A judged trace, with everything that the report shows about it.
#[derive(Debug, Clone, Copy)]
pub struct Check<'a> {
    /// The name of the scene, as the user typed it.
    pub scene: &'a str,
    /// The name of the trace, as the user typed it.
    pub trace: &'a str,
    /// The outcome of judging the trace.
    pub outcome: &'a Outcome,
    /// Likely mistakes, the likeliest first; empty if the trace is right, or if they were not requested.
    pub explanations: &'a [Explanation],
    /// The rule books by which the trace was judged.
    pub rules: Rules,
    /// The wrong steps, and which of them the report shows one by one.
    pub steps: &'a WrongSteps,
    /// The kind of file that the trace probably is, if it begins like another kind.
    pub other_file_kind: Option<&'a str>,
}

impl Check<'_> {
    /// Returns whether the official rule book accepts the trace.
    pub fn is_accepted(&self) -> bool {
        self.outcome.ruling(self.book()) == Ruling::Accepted
    }

    /// Returns the official verdict as text, such as `wrong answer`.
    pub fn verdict(&self) -> &'static str {
        self.outcome.ruling(self.book()).name()
    }

    /// Returns whether the file is not a trace at all. In that case, the report says only that.
    pub(crate) fn is_not_a_trace(&self) -> bool {
        self.other_file_kind.is_some() && !self.is_accepted()
    }

    /// Returns a sentence about which book accepts the trace; `None` if the rule books agree.
    pub fn difference(&self) -> Option<&'static str> {
        find_cause(self.outcome).map(fair::describe_acceptance)
    }

    /// Returns the rule book that gives the verdict.
    const fn book(&self) -> Book {
        self.rules.official()
    }

    /// Returns the findings by the official rule book.
    fn findings(&self) -> &BookFindings {
        self.outcome.findings_by(self.book())
    }

    /// Renders the report as text.
    pub fn render_text(&self, style: Style) -> String {
        text::render(self, style)
    }

    /// Renders the requested steps, with expected and actual values. Returns `None` if no step was requested, or if all
    /// wrong steps were requested and there are none.
    pub fn steps_text(&self, style: Style) -> Option<String> {
        steps::render(self, style)
    }

    /// Returns annotations for GitHub Actions: one for the verdict with the likely mistakes, if the trace is not
    /// accepted, and one if the rule books differ.
    pub fn github(&self) -> String {
        let mut text = String::new();
        let title = format!("{}: {}", self.trace, self.verdict());
        if !self.is_accepted() {
            let stop = self.outcome.stop_by(self.book()).map(|stop| describe_stop(&stop, self.outcome));
            let first = first_finding::find_first(self).map(|first| first.to_string());
            let likely = explain::render_sentence(self.explanations).filter(|_| !first_finding::is_other_scene(self));
            let parts: Vec<String> =
                [Some(text::render_headline(self)), stop, first, likely].into_iter().flatten().collect();
            text += &render_annotation("error", &title, &parts.join("; "));
        }
        if let Some(cause) = find_cause(self.outcome) {
            text += &render_annotation("warning", &title, &format!("the rule books differ: {cause}"));
        }
        text
    }

    /// Renders the report as one JSON object, indented, with a line feed at its end.
    pub fn json(&self) -> String {
        to_document(&CheckView::from(self))
    }
}

/// Counts how often the original would print each of its messages. The keys are the strings that graders search for in
/// its output.
fn count_messages(outcome: &Outcome) -> BTreeMap<&'static str, u64> {
    let mut messages: BTreeMap<_, _> = FindingKind::ALL
        .into_iter()
        .filter_map(|kind| Some((kind.original_message()?, outcome.parity.findings.counts.get(kind))))
        .filter(|&(_, count)| count > 0)
        .collect();
    if outcome.parity.overall == Overall::None {
        messages.insert("Simulation did not run to completion", 1);
    }
    match outcome.stop {
        Some(Stop::Trace { cause: ReadFailure::State, .. }) => {
            messages.insert("Failed to load timestep", 1);
        }
        Some(Stop::Trace { cause: ReadFailure::Impulses, .. }) => {
            messages.insert("Error while trying to deserialize", 1);
        }
        _ => {}
    }
    messages
}

view! {
    /// The report on one trace. Within one version, fields may be added, but the meaning of a field never changes.
    /// Numbers that are not finite are written as the strings nan, -nan, inf and -inf.
    #[schemars(deny_unknown_fields)]
    pub(crate) struct CheckView<'a> from check: Check<'a> {
        /// The version of the schema.
        #[schemars(extend("const" = CHECK_SCHEMA))]
        schema: u32 = CHECK_SCHEMA,
        /// The name of the scene, as the user typed it.
        scene: &'a str = check.scene,
        /// The name of the trace, as the user typed it.
        trace: &'a str = check.trace,
        /// The requested rule books.
        rules: Rules = check.rules,
        /// The rule book that gives the verdict, the first difference, the findings and the wrong steps.
        official: Book = check.book(),
        /// The verdict by the official rule book. Undecided means that no fault was found, but judging stopped early.
        /// Bad trace means that the trace could not be read to the scene's last step. By the fair rules, a bad trace
        /// may also be damaged, or have bytes after its last record.
        #[schemars(extend("enum" = Ruling::ALL.map(Ruling::name)))]
        verdict: &'static str = check.verdict(),
        /// The reason for the verdict, in one line.
        summary: String = text::render_headline(check),
        /// The judgment by the original's rules.
        parity: Parity = Parity::from(check.outcome),
        /// The judgment by the fair rules; null if they were not used.
        fair: Option<FairView<'a>> = check.outcome.fair.as_deref().map(FairView::from),
        /// The reason why the two rule books differ; null if they agree.
        difference: Option<CauseView> = find_cause(check.outcome).as_ref().map(CauseView::from),
        /// The first finding by the official rule book; null if there is none.
        first_divergence: Option<FindingView> =
            check.findings().first_divergence.as_ref().map(|first| FindingView::from_finding(check.book(), first)),
        /// For each kind of finding by the official rule book, the number of findings and the first one.
        findings: Vec<CountedView> =
            CountedView::count(check.book(), &check.findings().examples, |kind| check.findings().counts.get(kind)),
        /// Advice that fits the kind of the first finding.
        advice: Vec<&'static str> = advice::list_advice(check),
        /// Commands with which a reader sees more of the first finding.
        commands: Vec<String> = further_commands::list_commands(check),
        /// Further facts about the trace, such as damage, or bytes after its end.
        notes: Vec<String> = text::list_notes(check),
        /// Likely mistakes, the likeliest first. The list is empty if nothing is wrong, and with --no-explain.
        explanations: Vec<ExplanationView> = check.explanations.iter().map(ExplanationView::from).collect(),
        /// The number of steps of the scene.
        steps: u32 = check.outcome.steps,
        /// The number of steps that were judged.
        steps_judged: u32 = check.outcome.steps_judged,
        /// The number of steps with at least one finding by the official rule book.
        wrong_steps: u64 = check.findings().wrong_steps,
        /// The numbers of the wrong steps, from 1. Only the first 1000 are listed.
        #[schemars(length(max = MAX_LISTED), inner(range(min = 1)))]
        wrong_step_numbers: Vec<u32> = steps::list_wrong_steps(check),
        /// With --all, the first 1000 wrong steps; with --step, the requested steps; null without these options. Their
        /// findings are those of the official rule book, or those of the fair rules if the official rule book found
        /// none.
        shown_steps: Option<Vec<WrongStepView>> = steps::step_views(check),
        /// The reason why judging stopped before the scene's last step; null if all steps were judged.
        problem: Option<StopView> = check.outcome.stop_by(check.book()).as_ref().map(StopView::from),
        /// The first damage that the original's reader skips without a message; null if there is none.
        damage: Option<DamageView> = check.outcome.damage.as_ref().map(DamageView::from),
        /// Whether bytes follow the last record.
        trailing_bytes: bool = check.outcome.trailing_bytes,
    }
}

view! {
    /// The judgment by the original's rules.
    #[schemars(deny_unknown_fields)]
    struct Parity from outcome: Outcome {
        /// The original's verdict. It is `none` if judging stopped early.
        overall: Overall = outcome.parity.overall,
        #[serde(flatten)]
        residuals: Residuals = outcome.parity.residuals,
        /// Whether collisions and polynomials are right; null if there is no verdict.
        collisions_passed: Option<bool> = outcome.parity.collisions_passed,
        /// The number of times that the original would print each of its messages. Messages with zero are left out.
        messages: BTreeMap<&'static str, u64> = count_messages(outcome),
    }
}

/// The reason why judging stopped early.
#[derive(Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
struct StopView {
    /// The kind of event that stopped judging.
    kind: StopKind,
    #[serde(flatten)]
    place: DamageView,
}

/// The kind of event that stopped judging early.
#[derive(Serialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
enum StopKind {
    /// The state in a record can't be read to its end.
    StateUnreadable,
    /// The impulses or polynomials of a record can't be read.
    ImpulsesUnreadable,
    /// A list declares more entries than fit into memory.
    ImpossibleCount,
    /// A list declares more entries than the limits allow.
    BeyondLimit,
    /// The operating system could not read more of the file.
    ReadError,
    /// The step that begins with the given values has no result.
    StepWithoutResult,
}

view! {
    /// A damaged part of a trace.
    struct DamageView from damage: Damage {
        /// The number of the damaged step, from 1; 0 is the initial record.
        step: u32 = damage.step,
        /// The index of the damaged record, from 0.
        frame: Option<u64> = Some(damage.frame),
        /// The offset of the damage in the file, in bytes.
        offset: Option<u64> = Some(damage.offset),
        /// The damage as a sentence.
        message: String = damage.what.to_string(),
    }
}

impl From<&Stop> for StopView {
    fn from(stop: &Stop) -> Self {
        match stop {
            Stop::Trace { frame, step, cause, offset, what } => {
                let kind = match cause {
                    ReadFailure::State => StopKind::StateUnreadable,
                    ReadFailure::Impulses => StopKind::ImpulsesUnreadable,
                    ReadFailure::Memory => StopKind::ImpossibleCount,
                    ReadFailure::Limit => StopKind::BeyondLimit,
                    ReadFailure::Io => StopKind::ReadError,
                };
                let (frame, offset, message) = (Some(*frame), Some(*offset), what.to_string());
                Self { kind, place: DamageView { step: *step, frame, offset, message } }
            }
            Stop::Step(error) => {
                let (step, message) = (error.step(), MissingResult(*error).to_string());
                Self {
                    kind: StopKind::StepWithoutResult,
                    place: DamageView { step, frame: None, offset: None, message },
                }
            }
        }
    }
}
