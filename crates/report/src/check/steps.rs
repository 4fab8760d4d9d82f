//! The wrong steps of a trace, one by one. They are collected while the trace is judged, and shown with expected and
//! actual values.
use super::super::{
    number::{format_count, group_digits},
    style::{Style, TextStyle},
};
use super::{Check, divergence, fair_view::CountedView};
use fosssim_judge::{
    Book, BookFindings, Finding, FindingCounts,
    replay::{Progress, StepFindings, WrongStep},
};
use serde::Serialize;

/// The maximum number of wrong steps whose findings or numbers are kept.
pub const MAX_LISTED: usize = 1000;

/// The choice of steps that a report shows one by one.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum StepChoice {
    /// Show no steps; only the numbers of the wrong steps are kept.
    #[default]
    None,
    /// Show all wrong steps, up to [`MAX_LISTED`].
    All,
    /// Show these steps, whether they are wrong or right; 0 is the first record.
    Selected(Vec<u32>),
}

/// The findings by one rule book in one step.
#[derive(Debug, Clone)]
struct Step {
    number: u32,
    /// The first finding of each kind.
    first_findings: Vec<Finding>,
    /// The number of findings of each kind after the first.
    further_counts: FindingCounts,
}

/// The wrong steps by one rule book, in order, up to [`MAX_LISTED`].
#[derive(Debug, Clone, Default)]
struct Steps {
    numbers: Vec<u32>,
    kept_steps: Vec<Step>,
}

/// Collects the wrong steps while a trace is judged.
#[derive(Debug, Clone, Default)]
pub struct WrongSteps {
    pub(super) shown_steps: StepChoice,
    parity: Steps,
    fair: Steps,
}

impl WrongSteps {
    /// Creates an empty collection that keeps the steps selected by `choice`.
    pub fn new(choice: StepChoice) -> Self {
        Self { shown_steps: choice, ..Self::default() }
    }

    /// Returns the wrong steps by a rule book, including findings that can be made only at the end of the trace.
    fn steps_of_book(&self, book: Book, account: &BookFindings) -> Steps {
        let mut steps = match book {
            Book::Parity => self.parity.clone(),
            Book::Fair => self.fair.clone(),
        };
        for finding in account.examples.iter().chain(&account.first_divergence) {
            let findings = StepFindings {
                first_findings: std::slice::from_ref(finding),
                further_counts: FindingCounts::default(),
            };
            steps.add(finding.step, findings, &self.shown_steps);
        }
        steps
    }
}

impl Progress for WrongSteps {
    fn observe_wrong_step(&mut self, wrong: &WrongStep<'_>) {
        self.parity.add(wrong.step, wrong.parity, &self.shown_steps);
        self.fair.add(wrong.step, wrong.fair, &self.shown_steps);
    }
}

impl Steps {
    /// Adds findings of a step. The collection may contain the step already.
    fn add(&mut self, step: u32, findings: StepFindings<'_>, shown: &StepChoice) {
        if findings.first_findings.is_empty() {
            return;
        }
        // Record 0 is the initial state, not a step.
        if let (Err(index), true, true) = (self.numbers.binary_search(&step), step > 0, self.numbers.len() < MAX_LISTED)
        {
            self.numbers.insert(index, step);
        }
        let is_listed = match shown {
            StepChoice::None => false,
            StepChoice::All => true,
            StepChoice::Selected(steps) => steps.contains(&step),
        };
        if !is_listed {
            return;
        }
        let index = match self.kept_steps.binary_search_by_key(&step, |kept_step| kept_step.number) {
            Ok(index) => index,
            Err(_) if self.kept_steps.len() >= MAX_LISTED => return,
            Err(index) => {
                self.kept_steps.insert(
                    index,
                    Step { number: step, first_findings: Vec::new(), further_counts: FindingCounts::default() },
                );
                index
            }
        };
        let kept_step = &mut self.kept_steps[index];
        for first in findings.first_findings {
            if !kept_step.first_findings.iter().any(|known| known.kind() == first.kind()) {
                kept_step.first_findings.push(*first);
            }
        }
        kept_step.further_counts += findings.further_counts;
    }
}

/// Returns the wrong steps by the official rule book, or those by the other one if the official one has none.
fn official_steps(check: &Check<'_>) -> (Book, Steps) {
    let steps_of = |book| (book, check.steps.steps_of_book(book, check.outcome.findings_by(book)));
    let official = steps_of(check.book());
    if official.1.numbers.is_empty() && official.1.kept_steps.is_empty() && check.rules.includes_fair() {
        return steps_of(Book::Fair);
    }
    official
}

/// Returns the numbers of the wrong steps by the official rule book, up to [`MAX_LISTED`].
pub(super) fn list_wrong_steps(check: &Check<'_>) -> Vec<u32> {
    check.steps.steps_of_book(check.book(), check.outcome.findings_by(check.book())).numbers
}

/// Returns the requested steps and the findings in each; `None` if no step was requested.
fn find_requested_steps<'a>(check: &Check<'_>, steps: &'a Steps) -> Option<Vec<(u32, Option<&'a Step>)>> {
    let found = |number: u32| steps.kept_steps.iter().find(|step| step.number == number);
    match &check.steps.shown_steps {
        StepChoice::None => None,
        StepChoice::All => Some(steps.kept_steps.iter().map(|step| (step.number, Some(step))).collect()),
        StepChoice::Selected(numbers) => Some(numbers.iter().map(|&number| (number, found(number))).collect()),
    }
}

/// Renders the section about single steps. Returns `None` if no step was requested, or if all wrong steps were
/// requested and there are none.
pub(super) fn render(check: &Check<'_>, style: Style) -> Option<String> {
    let (book, steps) = official_steps(check);
    let block = |(number, found): (u32, Option<&Step>)| match found {
        Some(step) => render_step(check, step, style),
        None => format!("{}\n", style.paint(TextStyle::Strong, &describe_right_steps(check, number))),
    };
    let mut text = find_requested_steps(check, &steps)?.into_iter().map(block).collect::<Vec<_>>().join("\n");
    let wrong = check.outcome.findings_by(book).wrong_steps;
    let shown = steps.kept_steps.iter().filter(|step| step.number > 0).count() as u64;
    if check.steps.shown_steps == StepChoice::All && shown < wrong {
        text += &format!("\n{} more are wrong; --step N shows any of them\n", format_count(wrong - shown, "step"));
    }
    (!text.is_empty()).then_some(text)
}

fn describe_right_steps(check: &Check<'_>, step: u32) -> String {
    let outcome = check.outcome;
    let sound = outcome.steps_judged - outcome.damaged_steps;
    match step {
        0 if check.rules.includes_fair() => "First record: nothing is wrong".to_owned(),
        0 => "First record: only the fair rules check it".to_owned(),
        _ if step <= sound => format!("Step {step} of {}: nothing is wrong", outcome.steps),
        _ if step <= outcome.steps_judged => {
            format!("Step {step} of {}: not checked, because the trace is damaged in it or before it", outcome.steps)
        }
        _ => format!("Step {step} of {}: not judged, because judging stopped at an earlier step", outcome.steps),
    }
}

fn render_step(check: &Check<'_>, step: &Step, style: Style) -> String {
    let findings = step.first_findings.len() as u64 + step.further_counts.total();
    let frame = step.first_findings.first().map_or(0, |first| first.frame);
    let heading = match step.number {
        0 => format!("First record: {}", format_count(findings, "finding")),
        number => {
            format!("Step {number} of {}, frame {frame}: {}", check.outcome.steps, format_count(findings, "finding"))
        }
    };
    let mut text = style.paint(TextStyle::Strong, &heading) + "\n";
    for finding in &step.first_findings {
        text += &divergence::render_finding(finding, style);
        match step.further_counts.get(finding.kind()) {
            0 => {}
            more => text += &format!("  and {} more of this kind ({})\n", group_digits(more), finding.kind()),
        }
    }
    text
}

/// A step, and the findings in it.
#[derive(Debug, Serialize, schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
pub(super) struct WrongStepView {
    /// The number of the step, from 1; 0 is the first record.
    step: u32,
    /// For each kind of finding in the step, the number of findings and the first one. The list is empty if the step is
    /// right, or if judging stopped before it.
    findings: Vec<CountedView>,
}

/// Returns the requested steps for the report in JSON; `None` if no step was requested.
pub(super) fn step_views(check: &Check<'_>) -> Option<Vec<WrongStepView>> {
    let (book, steps) = official_steps(check);
    let counted =
        |step: &Step| CountedView::count(book, &step.first_findings, |kind| 1 + step.further_counts.get(kind));
    let view =
        |(step, found): (u32, Option<&Step>)| WrongStepView { step, findings: found.map(counted).unwrap_or_default() };
    Some(find_requested_steps(check, &steps)?.into_iter().map(view).collect())
}
