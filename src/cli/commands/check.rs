//! The command `check`, which judges a trace.
use crate::{
    cli::{
        arguments::{CheckArguments, CheckFormat},
        console, exit,
        input::{self, SceneInput, TraceInput},
        output::Output,
    },
    evidence::{self, Evidence, ExaminedTrace, KeptPart, examine},
    judge::{
        Outcome, Stop,
        replay::{self, ObserverPair},
    },
    report::{
        self,
        check::{StepChoice, WrongSteps, describe_no_verdict, describe_unread, needs_explanation},
        number::format_count,
        page,
        style::Style,
        words,
    },
    trace::Layout,
};
use anyhow::{Result, bail};
use std::{io::Read, path::Path};

pub(super) fn run(arguments: &CheckArguments) -> Result<u8> {
    let name = &arguments.trace;
    let scene = input::read_scene(&arguments.scene)?;
    let mut trace = input::open_trace(name)?;
    let inputs: Vec<_> = scene.identity.into_iter().chain(trace.identity).collect();
    // The output is opened first. If it cannot be written, this is reported before the work begins.
    let target = arguments.output.as_deref().map(|name| Output::create(name, &inputs)).transpose()?;
    let (shown, lasts) = (ShownParts::from_arguments(arguments), is_rereadable(name));
    let mut wrong = collect_wrong_steps(arguments, &scene)?;
    let mut bar = console::Bar::new(scene.scene.step_count());
    let (options, heard) = (replay_options(arguments), &mut ObserverPair(&mut bar, &mut wrong));
    let examined = examine(&scene.scene, &mut trace.reader, shown.part_to_keep(lasts), &options, heard);
    drop(bar);
    let outcome = &examined.outcome;
    reject_unreadable(outcome, &scene, &trace)?;
    let explanations = if shown.is_explained && needs_explanation(outcome) { examined.explain() } else { Vec::new() };
    let check = report::check::Check {
        scene: &scene.name,
        trace: &trace.name,
        outcome,
        explanations: &explanations,
        rules: arguments.rules,
        steps: &wrong,
        other_file_kind: trace.probable_kind,
    };
    let accepted = check.is_accepted();
    let is_states_only = |data: std::fs::Metadata| Layout::for_scene(&scene.scene).is_states_only(data.len());
    if lasts && !accepted && std::fs::metadata(name).is_ok_and(is_states_only) {
        console::print_remark(format!("{}\n", words::STATES_ONLY));
    }
    let evidence = || gather_evidence(&examined, name, lasts);
    write_report(target, arguments.format, check, &examined, &evidence)?;
    Ok(if accepted { exit::ACCEPTED } else { exit::NOT_ACCEPTED })
}

/// Writes the report in the requested format.
fn write_report(
    target: Option<Output>,
    format: CheckFormat,
    check: report::check::Check<'_>,
    examined: &ExaminedTrace<'_>,
    evidence: &dyn Fn() -> Evidence,
) -> Result<()> {
    let style = if target.is_some() { Style::Plain } else { console::style() };
    if let (Some(Output::File(_)), CheckFormat::Html) = (&target, format) {
        let text = check.render_text(Style::Plain);
        console::print_remark(text.lines().take(1).map(|verdict| format!("{verdict}\n")).collect::<String>());
    }
    let text = match format {
        CheckFormat::Text => check.render_text(style),
        CheckFormat::Json => check.json(),
        CheckFormat::Github => check.github(),
        CheckFormat::Html => page::examined_page(check, examined, &evidence()),
    };
    match (target, format) {
        (Some(target), format) => target.finish_and_print(text.as_bytes(), format == CheckFormat::Html),
        (None, CheckFormat::Text) => console::report(&text),
        (None, _) => console::print(&text),
    }
}

/// The parts that follow the verdict in a report. They decide which data of a trace must be kept.
struct ShownParts {
    is_explained: bool,
    is_drawn: bool,
}

impl ShownParts {
    fn from_arguments(arguments: &CheckArguments) -> Self {
        // With `--step`, the values in these steps are shown instead of an explanation.
        let is_explained = arguments.step.is_empty() && !arguments.no_explain;
        Self { is_explained, is_drawn: arguments.format == CheckFormat::Html }
    }

    fn part_to_keep(&self, lasts: bool) -> KeptPart {
        match (self.is_explained || self.is_drawn, lasts) {
            (false, _) => KeptPart::Nothing,
            (true, false) => KeptPart::Read,
            (true, true) => KeptPart::All,
        }
    }
}

fn replay_options(arguments: &CheckArguments) -> replay::Options {
    replay::Options {
        threads: arguments.threads.map_or(0, |threads| threads.get().min(8)),
        uses_fair_rules: arguments.rules.includes_fair(),
        ..replay::Options::default()
    }
}

/// Returns the collector of the wrong steps that the report shows. Fails if the scene lacks a requested step.
fn collect_wrong_steps(arguments: &CheckArguments, scene: &SceneInput) -> Result<WrongSteps> {
    let steps = scene.scene.step_count();
    if let Some(step) = arguments.step.iter().find(|step| **step > steps) {
        bail!("the scene {} has {}; there is no step {step}", scene.name, format_count(steps.into(), "step"));
    }
    Ok(WrongSteps::new(if arguments.all {
        StepChoice::All
    } else if arguments.step.is_empty() {
        StepChoice::None
    } else {
        StepChoice::Selected(arguments.step.clone())
    }))
}

/// Returns an error if no trace of the scene can have a verdict, or if the trace could not be read to its end.
fn reject_unreadable(outcome: &Outcome, scene: &SceneInput, trace: &TraceInput) -> Result<()> {
    if let Some(message) = describe_no_verdict(outcome, &scene.name) {
        bail!(message);
    }
    match (&outcome.stop, trace.failure()) {
        // It is unknown whether later steps were read, so their faults are not used.
        (Some(Stop::Step(_)), _) | (_, None) => Ok(()),
        // If bytes are missing within polynomials, the original does not stop. However, they may be missing only in
        // this copy of the trace.
        (_, Some(message)) => bail!(describe_unread(outcome, &trace.name, &message)),
    }
}

/// Collects the evidence for the report. If only a part of the trace was kept and the file can be read again, the whole
/// trace is used.
fn gather_evidence(examined: &ExaminedTrace<'_>, name: &Path, lasts: bool) -> Evidence {
    let mut reopened = if lasts && !examined.trace.is_whole() { input::open_trace(name).ok() } else { None };
    examined.gather_evidence(reopened.as_mut().map(|trace| &mut trace.reader as &mut dyn Read), evidence::MAX_NUMBERS)
}

/// Returns whether a trace can be read a second time. It then need not be kept while it is judged.
fn is_rereadable(name: &Path) -> bool {
    name != Path::new("-") && !std::fs::metadata(name).is_ok_and(|data| !data.is_file())
}
