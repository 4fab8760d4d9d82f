//! Renders the check report as text: first the verdict, then the reasons.
use super::{
    super::{
        explain,
        number::{format_count, group_digits},
        step_share,
        style::{Style, TextStyle},
        words,
    },
    Check, StepChoice, advice, books, divergence, fair,
    first_finding::{find_first, is_other_scene},
    further_commands, steps,
};
use fosssim_judge::{Book, MissingResult, Outcome, Overall, ReadFailure, Ruling, Stop};
use fosssim_mistakes::diagnose::Explanation;
use fosssim_model::sim::StepError;
use std::{fmt::Display, iter};

/// The advice for a trace that reaches a limit of this program.
const LIMIT_ADVICE: &str = "only this program has this limit, not the original; the trace is not at fault";

/// The advice for a step in which the reference's computation has no result.
const NO_RESULT: &str = "the trace's own positions and velocities lead here; look for values that are not finite or \
                      absurdly large in the steps before";

/// The maximum number of explanations that are shown.
const MAX_EXPLANATIONS: usize = 2;

pub(super) fn render(check: &Check<'_>, style: Style) -> String {
    let outcome = check.outcome;
    let mut parts = vec![render_head(check, style)];
    if check.is_not_a_trace() {
        return parts.concat();
    }
    parts.extend(outcome.stop_by(check.book()).map(|stop| {
        let (place, message, advice) = describe_problem(&stop, outcome);
        let lines: String = iter::once(&*message).chain(advice).map(|line| format!("  {line}\n")).collect();
        format!("{} {place}\n{lines}", style.paint(TextStyle::Strong, "Stopped at"))
    }));
    if matches!(check.steps.shown_steps, StepChoice::Selected(_)) {
        parts.extend(steps::render(check, style));
        return parts.join("\n");
    }
    // The cause is shown before its first occurrence.
    let shows_mistakes = !is_other_scene(check);
    parts.extend(render_mistakes(check, style).filter(|_| shows_mistakes));
    // If all steps are shown, the first finding is one of them.
    let first = find_first(check).filter(|_| check.steps.shown_steps != StepChoice::All);
    parts.extend(first.map(|first| divergence::render(first, outcome.steps, style)));
    parts.extend(render_section("Where to look", "  - ", &advice::list_advice(check), style));
    parts.extend(steps::render(check, style).filter(|_| shows_mistakes));
    parts.extend(books::render(check, style));
    parts.extend(render_section("Notes", "  - ", &list_notes(check), style));
    parts.extend(render_section("Next", "  $ ", &further_commands::list_commands(check), style));
    parts.extend(render_section("Next", "  - ", further_commands::suggest_next(check).as_slice(), style));
    parts.join("\n")
}

/// Renders lines below a heading; `None` if there are no lines.
fn render_section(heading: &str, mark: &str, lines: &[impl Display], style: Style) -> Option<String> {
    let heading = style.paint(TextStyle::Strong, heading) + "\n";
    let lines: String = lines.iter().map(|line| format!("{mark}{line}\n")).collect();
    (!lines.is_empty()).then(|| heading + &lines)
}

/// Renders the likeliest mistakes of the program, up to [`MAX_EXPLANATIONS`], and the number of the others. Returns
/// `None` if there are none.
fn render_mistakes(check: &Check<'_>, style: Style) -> Option<String> {
    let (shown, more) = check.explanations.split_at(check.explanations.len().min(MAX_EXPLANATIONS));
    // If the first difference is shown below, it is an example, so the explanations' own examples are left out.
    let has_example = find_first(check).is_none();
    let without = |explanation: &Explanation| Explanation { example: None, ..explanation.clone() };
    let shown = if has_example { shown.to_vec() } else { shown.iter().map(without).collect() };
    let mut lines = explain::explanation_texts(&shown, style);
    if !more.is_empty() {
        lines.push(format!("and {}", format_count(more.len() as u64, "less likely explanation")));
    }
    render_section("Likely cause", "  ", &lines, style)
}

fn render_head(check: &Check<'_>, style: Style) -> String {
    let look = if check.is_accepted() { TextStyle::Right } else { TextStyle::Wrong };
    let verdict = style.paint(look, &check.verdict().to_uppercase());
    if check.is_not_a_trace() {
        return format!("{verdict}: {} {}\n", check.trace, render_headline(check));
    }
    format!("{verdict}: {}\n  scene {}\n  trace {}\n", render_headline(check), check.scene, check.trace)
}

/// Returns the verdict and the reason for it, in one line.
pub(crate) fn render_headline(check: &Check<'_>) -> String {
    let outcome = check.outcome;
    if let (Some(kind), true) = (check.other_file_kind, check.is_not_a_trace()) {
        return format!("is not a trace: it {kind}; a program writes one with -s scene.xml -d 0 -o trace.bin");
    }
    if let Some(question) = check.explanations.iter().find(|explanation| explanation.is_other_scene()) {
        return words::explanation::describe(question);
    }
    let steps = group_digits(u64::from(outcome.steps));
    let parity = match outcome.parity.overall {
        Overall::Passed if outcome.steps == 0 => "the scene has no steps, so no step can be wrong".to_owned(),
        Overall::Passed => {
            format!("{} by the original's rules", step_share::describe_right_steps(outcome.steps, group_digits))
        }
        Overall::Failed if outcome.damaged_steps > 0 => describe_damage(outcome),
        Overall::Failed if outcome.parity.findings.wrong_steps == 0 => {
            format!("no single step of {steps} is wrong, but a residual is above its tolerance")
        }
        Overall::Failed => {
            let first = outcome.parity.findings.first_divergence.map_or(0, |finding| finding.step);
            let first = if outcome.steps == 1 { String::new() } else { format!(", the first is step {first}") };
            step_share::describe_wrong(outcome.parity.findings.wrong_steps, outcome.steps, group_digits) + &first
        }
        Overall::None => {
            let judged_steps = group_digits(u64::from(outcome.steps_judged_by(Book::Parity)));
            let end = match &outcome.stop_by(Book::Parity) {
                Some(stop) if is_limit(stop) => "a limit of this program ended judging",
                Some(Stop::Step(_)) => "the original would not terminate",
                _ => "the trace could not be read further",
            };
            format!("judged {judged_steps} of {}, then {end}", format_count(outcome.steps.into(), "step"))
        }
    };
    match (check.book(), &outcome.fair, outcome.ruling(Book::Fair)) {
        (Book::Parity, ..) | (_, None, _) => parity,
        (Book::Fair, Some(fair), Ruling::Accepted) if outcome.steps > 0 => {
            format!("{} by the fair rules", fair::summarize(fair, outcome))
        }
        (Book::Fair, Some(fair), _) => fair::summarize(fair, outcome),
    }
}

/// Describes the damage of a trace that could be read to its end, and the verdict on the steps before the damage.
fn describe_damage(outcome: &Outcome) -> String {
    let place = match &outcome.damage {
        Some(damage) if damage.step > 0 => format!("the trace is damaged in step {} of {}", damage.step, outcome.steps),
        _ => "the trace is damaged".to_owned(),
    };
    let before = u64::from(outcome.steps_judged - outcome.damaged_steps);
    match (before, outcome.parity.findings.wrong_steps, &outcome.parity.findings.first_divergence) {
        (0, ..) => place,
        (_, wrong, Some(first)) if wrong > 0 => {
            let verb = if wrong == 1 { "is" } else { "are" };
            format!(
                "{place}; {} of the {} steps before it {verb} wrong, the first is step {}",
                group_digits(wrong),
                group_digits(before),
                first.step
            )
        }
        (1, ..) => format!("{place}; the step before it is right"),
        _ => format!("{place}; the {} steps before it are right", group_digits(before)),
    }
}

/// Describes where and why judging stopped, in one line.
pub fn describe_stop(stop: &Stop, outcome: &Outcome) -> String {
    let (place, message, _) = describe_problem(stop, outcome);
    let what = match stop {
        Stop::Trace { .. } => "the trace can't be read any further at",
        Stop::Step(_) => "judging ended at",
    };
    format!("{what} {place}: {message}")
}

/// Returns whether judging ended at a limit of this program. Such a limit is not a fault of the trace.
const fn is_limit(stop: &Stop) -> bool {
    matches!(stop, Stop::Trace { cause: ReadFailure::Limit, .. } | Stop::Step(StepError::Work { .. }))
}

/// Describes where and why judging stopped. The second part is advice about what to check, if there is any.
pub(crate) fn describe_problem(stop: &Stop, outcome: &Outcome) -> (String, String, Option<&'static str>) {
    let (place, message, advice) = match stop {
        Stop::Trace { frame, step, cause, offset, what } => {
            let advice = match cause {
                ReadFailure::Io => "reading the file failed; check the disk, and for other programs that write to it",
                ReadFailure::Limit => LIMIT_ADVICE,
                ReadFailure::Memory => {
                    "the trace is damaged, or was made for another scene: compare the scene's number of particles \
                     and its collision type with those of the run"
                }
                ReadFailure::State | ReadFailure::Impulses if outcome.steps_judged == 0 => {
                    "was the trace made for this scene, and did the program that wrote it run at all?"
                }
                ReadFailure::State | ReadFailure::Impulses => {
                    "did the program that wrote the trace crash, or was it stopped, before its last step?"
                }
            };
            let place = if *step == 0 {
                format!("the initial record, byte {offset}")
            } else {
                format!("step {step} of {}, frame {frame}, byte {offset}", outcome.steps)
            };
            (place, what.to_string(), advice)
        }
        Stop::Step(error) => {
            let (step, message) = (error.step(), MissingResult(*error).to_string());
            let advice = if is_limit(stop) { LIMIT_ADVICE } else { NO_RESULT };
            (format!("step {step} of {}", outcome.steps), message, advice)
        }
    };
    let is_question = message.ends_with('?');
    (place, message, (!is_question).then_some(advice))
}

/// Returns further remarks about the trace.
pub(crate) fn list_notes(check: &Check<'_>) -> Vec<String> {
    let outcome = check.outcome;
    let mut notes = Vec::new();
    if let Some(damage) = &outcome.damage {
        notes.push(format!(
            "frame {} (step {}), byte {}: {}; the original skips this silently",
            damage.frame, damage.step, damage.offset, damage.what
        ));
        if outcome.damaged_steps > 0 && outcome.parity.findings.counts.total() > 0 {
            notes.push("the original counts the rest of a damaged record; the fair rules ignore it".to_owned());
        }
    }
    if outcome.trailing_bytes {
        notes.push("bytes follow the last record; the original never reads them".to_owned());
    }
    notes
}
