//! The check report for people: the verdict first, then what leads to it.
use super::{
    super::{
        describe::step_error,
        explain,
        number::{count, counted, general},
        style::{Look, Style},
        table::{Align, Cell, Table},
        words,
    },
    Check, closer, divergence, fair,
    first::{first, is_other_scene},
    steps,
};
use fosssim_judge::{Book, BookFindings, Finding, FindingDetail, Outcome, Overall, Ruling, Stop, Unreadable, share};

pub(super) fn render(check: &Check<'_>, style: Style) -> String {
    let outcome = check.outcome;
    let mut parts = vec![head(check, style)];
    if steps::only_these(check) {
        parts.extend(outcome.stop.as_ref().map(|stop| problem(stop, outcome, style)));
        parts.extend(steps::render(check, style));
        return parts.join("\n");
    }
    parts.extend(outcome.stop.as_ref().map(|stop| problem(stop, outcome, style)));
    parts.push(residuals(outcome, style));
    parts.extend(fair::render(outcome, style));
    let account = outcome.findings_by(check.book());
    // The fair section holds its own findings.
    if !account.examples.is_empty() && check.book() == Book::Parity {
        parts.push(findings(account, style));
    }
    if let Some(first) = first(check) {
        // It comes again where all are shown.
        if !steps::all(check) {
            parts.push(divergence::render(first, outcome.steps, style));
        }
        let lines: String = advice(first).iter().map(|line| format!("  - {line}\n")).collect();
        parts.push(format!("{}\n{lines}", style.paint(Look::Strong, "What to look at")));
    }
    if !is_other_scene(check) {
        parts.extend(explanations(check, style));
        parts.extend(steps::render(check, style));
    }
    parts.extend(noted(check, style));
    let commands: String = closer::commands(check).iter().map(|command| format!("  $ {command}\n")).collect();
    if !commands.is_empty() {
        parts.push(format!("{}\n{commands}", style.paint(Look::Strong, "Look closer")));
    }
    parts.join("\n")
}

/// What the program is likely to get wrong, before general advice is of use.
fn explanations(check: &Check<'_>, style: Style) -> Option<String> {
    let lines: String = explain::lines(check.explanations).iter().map(|line| format!("  {line}\n")).collect();
    (!lines.is_empty()).then(|| format!("{}\n{lines}", style.paint(Look::Strong, "What explains it")))
}

fn head(check: &Check<'_>, style: Style) -> String {
    let look = if check.accepted() { Look::Good } else { Look::Bad };
    let verdict = style.paint(look, &check.verdict().to_uppercase());
    format!("{verdict}: {}\n  scene {}\n  trace {}\n", headline(check), check.scene, check.trace)
}

/// What stands behind the verdict, in one line.
pub(crate) fn headline(check: &Check<'_>) -> String {
    let outcome = check.outcome;
    if let Some(question) = check.explanations.iter().find(|one| one.is_other_scene()) {
        return words::explanation::what(question);
    }
    let steps = count(u64::from(outcome.steps));
    let parity = match outcome.parity.overall {
        Overall::Passed if outcome.steps == 0 => "the scene has no step; there is nothing to get wrong".to_owned(),
        Overall::Passed => format!("{} by the original's rules", share::right(outcome.steps, count)),
        Overall::Failed if outcome.damaged_steps > 0 => damaged(outcome),
        Overall::Failed if outcome.parity.findings.wrong_steps == 0 => {
            format!("no single step of {steps} is wrong, but a residual is above its tolerance")
        }
        Overall::Failed => {
            let first = outcome.parity.findings.first_divergence.map_or(0, |finding| finding.step);
            let first = if outcome.steps == 1 { String::new() } else { format!(", the first is step {first}") };
            share::wrong(outcome.parity.findings.wrong_steps, outcome.steps, count) + &first
        }
        Overall::None => {
            let judged = count(u64::from(outcome.steps_judged));
            format!(
                "judged {judged} of {}, then the trace could not be followed",
                counted(outcome.steps.into(), "step")
            )
        }
    };
    match (check.book(), &outcome.fair, outcome.ruling(Book::Fair)) {
        (Book::Parity, ..) | (_, None, _) => parity,
        (Book::Fair, Some(fair), Ruling::Accepted) if outcome.steps > 0 => {
            format!("{} by the fair rules", fair::summary(fair, outcome))
        }
        (Book::Fair, Some(fair), _) => fair::summary(fair, outcome),
    }
}

/// Of a trace that is read to its end, but with damage: where that is, and what its steps before are.
fn damaged(outcome: &Outcome) -> String {
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
                count(wrong),
                count(before),
                first.step
            )
        }
        (1, ..) => format!("{place}; the step before it is right"),
        _ => format!("{place}; the {} steps before it are right", count(before)),
    }
}

/// Where a trace can't be followed any further, and why: one line.
#[must_use]
pub fn stopped(stop: &Stop, outcome: &Outcome) -> String {
    let (place, message, _) = parts(stop, outcome);
    format!("the trace can't be followed any further at {place}: {message}")
}

fn problem(stop: &Stop, outcome: &Outcome, style: Style) -> String {
    let (place, message, advice) = parts(stop, outcome);
    format!("{} {place}\n  {message}\n  {advice}\n", style.paint(Look::Strong, "Stopped at"))
}

/// Where it is, what is the matter, and what to look at.
fn parts(stop: &Stop, outcome: &Outcome) -> (String, String, &'static str) {
    match stop {
        Stop::Trace { frame, step, cause, offset, message } => {
            let advice = match cause {
                Unreadable::Io => "the file could not be read on; check the disk, or who else writes to it",
                Unreadable::Limit => {
                    "this is a limit of this program, which the original does not have: it says nothing about the trace"
                }
                Unreadable::Memory => {
                    "the trace is damaged, or was made for another scene: compare the scene's number of particles \
                     and its collision type with those of the run"
                }
                Unreadable::State | Unreadable::Impulses if outcome.steps_judged == 0 => {
                    "was the trace made for this scene, and did the program that wrote it run at all?"
                }
                Unreadable::State | Unreadable::Impulses => {
                    "did the program that wrote the trace crash, or was it stopped, before its last step?"
                }
            };
            let place = if *step == 0 {
                format!("the initial record, byte {offset}")
            } else {
                format!("step {step} of {}, frame {frame}, byte {offset}", outcome.steps)
            };
            (place, message.clone(), advice)
        }
        Stop::Step(error) => {
            let (step, message) = step_error(error);
            let advice = "the trace's own positions and velocities lead here; look for values that are not finite or \
                          absurdly large in the steps before";
            (format!("step {step} of {}", outcome.steps), message, advice)
        }
    }
}

fn residuals(outcome: &Outcome, style: Style) -> String {
    let names = ["accumulated position", "accumulated velocity", "maximum position", "maximum velocity"];
    let judged = outcome.parity.overall != Overall::None;
    let mut table = Table::new([Align::Left, Align::Right, Align::Right, Align::Right, Align::Left]);
    table.heading(["residual", "value", "tolerance", "used", ""]);
    for (name, (value, bound)) in names.into_iter().zip(outcome.parity.residuals.with_bounds()) {
        let verdict = if judged { passed(value < bound) } else { "".into() };
        table.row([name.into(), general(value).into(), general(bound).into(), used(value, bound).into(), verdict]);
    }
    let collisions = outcome.parity.collisions_passed.map_or_else(|| "".into(), passed);
    let wrong = count(outcome.parity.findings.counts.collisions());
    table.row(["collisions, polynomials".into(), wrong.into(), "0".into(), "".into(), collisions]);
    format!("{}\n{}", style.paint(Look::Strong, "Rules of the original (parity)"), table.render(style))
}

fn passed(yes: bool) -> Cell {
    if yes { Cell::looking(Look::Good, "passed") } else { Cell::looking(Look::Bad, "failed") }
}

/// Which share of its tolerance a residual uses.
fn used(value: f64, bound: f64) -> String {
    let share = value / bound;
    if share.is_nan() {
        "-".to_owned()
    } else if value == 0.0 {
        "0 %".to_owned()
    } else if share < 0.0001 {
        "< 0.01 %".to_owned()
    } else if share < 1.0 {
        format!("{:.2} %", 100.0 * share)
    } else if share < 1000.0 {
        format!("{share:.2} times")
    } else {
        format!("{share:.2e} times")
    }
}

fn findings(account: &BookFindings, style: Style) -> String {
    let mut table = Table::new([Align::Left, Align::Right, Align::Left]);
    table.heading(["kind", "count", "first example"]);
    for example in &account.examples {
        let kind = example.kind();
        table.row([kind.to_string().into(), count(account.counts.get(kind)).into(), example.to_string().into()]);
    }
    let plural = if account.wrong_steps == 1 { "step" } else { "steps" };
    let heading = format!("Findings: {} in {} {plural}", count(account.counts.total()), count(account.wrong_steps));
    format!("{}\n{}", style.paint(Look::Strong, &heading), table.render(style))
}

/// What to look at, by the kind of the first finding: what comes later often follows from it.
pub(super) fn advice(finding: &Finding) -> &'static [&'static str] {
    match finding.detail {
        _ if finding.step == 0 => &["the first record: the scene's own positions and velocities, before any step"],
        FindingDetail::MissedCollision { .. } => &[
            "the detection of this pair: the trace's own state at the start of the step leads to this impact",
            "do its polynomials agree? then the choice of the time of impact, or the test of the normal, is wrong",
        ],
        FindingDetail::SuperfluousCollision { .. } => &[
            "the detection of this pair: from the trace's own state at the start of the step it does not collide",
            "are the objects approaching, and is the time of impact inside the step?",
        ],
        FindingDetail::WrongNormal { .. } => &[
            "the contact normal: from the first object to the second, at the time of impact, not normalised",
            "is it taken from the positions at that time, and not from those at the end of the step?",
        ],
        FindingDetail::PolynomialCount { actual: 0, .. } => &[
            "the detection: in this step it asks the course's root finder about no pair; is it written yet?",
            "it is to ask about every pair in every pass, also about pairs that are far apart",
        ],
        FindingDetail::PolynomialCount { expected, actual, .. } | FindingDetail::PassCount { expected, actual, .. }
            if actual > expected =>
        {
            &[
                "the loop over detection passes: it runs too often, or looks at pairs that the reference leaves out",
                "an earlier response of this step that differs also makes the loop go on",
            ]
        }
        FindingDetail::PolynomialCount { .. } | FindingDetail::PassCount { .. } => &[
            "the loop over detection passes: it ends too early, or leaves out pairs",
            "an earlier response of this step that differs also makes the loop end",
        ],
        FindingDetail::PolynomialDegree { .. } => &[
            "the leading coefficients of this polynomial: those below 1e-12 in size are dropped, others are kept",
            "a factor on all coefficients moves them across that bound",
        ],
        FindingDetail::VanishingPolynomial { .. } => {
            &["the inputs of this polynomial: for the reference the two objects do not move relative to each other"]
        }
        FindingDetail::Coefficient { .. } => &[
            "the formula of this coefficient; any positive factor of the whole polynomial is right",
            "in a later detection pass of the step, a wrong response before it changes the coefficients, too",
        ],
        FindingDetail::Position { .. } | FindingDetail::Velocity { .. } => {
            &["the integrator, the forces, or the response: the step starts from the trace's own state, so errors of \
             earlier steps are not to blame"]
        }
        FindingDetail::ContactTime { .. } => &[
            "the time of impact that is stored with the contact: the fraction of the step at which the objects touch",
            "is it the time that the root finder returned, and not the step's number or the simulation's time?",
        ],
        FindingDetail::RepeatedCollision { .. } => {
            &["each pair is looked at once in a step: is it added to the list twice?"]
        }
        FindingDetail::PassPositions { .. } => &[
            "the response (or the rigid failsafe) before this detection pass: what it does to the end positions",
            "which positions the pass is given: those after the responses of the round before",
        ],
        FindingDetail::RecordsDiffer { .. } => {
            &["what is written after the step: the course's code writes both records itself"]
        }
        FindingDetail::ImpossibleLog => &["the trace was not written by the course's library as it was handed out"],
        FindingDetail::BeyondReach { .. } => {
            &["the step that leads to this state: something divides by zero, or grows from step to step"]
        }
        FindingDetail::TrimmedDecision { .. } | FindingDetail::TrimmedTime { .. } => &[
            "the factor of your polynomials: the course's library drops leading coefficients below 1e-12",
            "polynomials in the units of the assignment's formulas are not affected",
        ],
        FindingDetail::MixedForms { .. } => {
            &["the approach polynomial: one of its two accepted forms is to be used throughout"]
        }
    }
}

fn noted(check: &Check<'_>, style: Style) -> Option<String> {
    let notes = notes(check);
    let lines: String = notes.iter().map(|note| format!("  - {note}\n")).collect();
    (!notes.is_empty()).then(|| format!("{}\n{lines}", style.paint(Look::Strong, "Notes")))
}

/// What else is worth knowing.
pub(super) fn notes(check: &Check<'_>) -> Vec<String> {
    let outcome = check.outcome;
    let mut notes = Vec::new();
    if let Some(damage) = &outcome.damage {
        // Before a step without result it is what leads there.
        let silence = match outcome.stop {
            Some(Stop::Step(_)) => "",
            _ => "; the original reads over this in silence",
        };
        notes.push(format!(
            "frame {} (step {}), byte {}: {}{silence}",
            damage.frame, damage.step, damage.offset, damage.message
        ));
        if outcome.damaged_steps > 0 && outcome.parity.findings.counts.total() > 0 {
            notes.push("what is left of a damaged record is counted, but nobody is to blame for it".to_owned());
        }
    }
    if outcome.trailing_bytes {
        notes.push("bytes follow the last record; the original never looks at them".to_owned());
    }
    if check.audit {
        let searches = outcome.searches;
        let (calls, searched) = (count(searches.calls), count(searches.searched));
        let (excluded, disagreements) = (count(searches.excluded), count(searches.disagreements));
        notes.push(format!(
            "audit: {calls} detection calls, {searched} root searches, {excluded} excluded by a certificate, \
             {disagreements} disagreements"
        ));
    }
    notes
}
