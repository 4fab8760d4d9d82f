//! `shrink`: the smallest scene on which a program is still wrong for the same reason.
use super::probes::{Drawing, ExaminedProgram, ProgramUnderTest, case, named_tasks};
use crate::{
    cli::{
        arguments::{ExplainFormat, ShrinkArguments},
        console, exit,
        output::Output,
    },
    diagnose::Explanation,
    evidence::{InspectedPair, inspect},
    judge::{Rules, overlap::OverlapStudy, replay},
    report::{
        case::Case,
        check::{Check, StepChoice, WrongSteps},
        detect::{Detect, Overlap, Place},
        diagnosis::Diagnosis,
        page::ExplainedPage,
        smallest::SmallestReport,
        style::Style,
    },
    scene::Scene,
    shrink::WrongReason,
    sim::{Pair, State, pairs},
    suite::{
        config::Hints,
        located::FailureKind,
        smallest::{ShrinkLimits, Shrinker, SmallestScene, WrongScene, causes},
    },
    together::told::cut,
    trace::{Frame, Layout, Reader},
};
use anyhow::Result;
use std::{path::Path, time::Duration};

/// The limits where the smallest scenes are only the end of a report.
pub(super) const QUICK: ShrinkLimits = ShrinkLimits { runs: 300, time: Duration::from_secs(2), jobs: JOBS };

/// Runs at one time.
const JOBS: usize = 2;

pub(super) fn run(arguments: &ShrinkArguments) -> Result<u8> {
    let program = ProgramUnderTest::new(&arguments.program, arguments.suite.as_deref(), arguments.unsafe_no_sandbox)?;
    let tasks = match (&arguments.scene, &arguments.suite) {
        (Some(scene), _) => named_tasks(std::slice::from_ref(scene))?,
        (None, Some(_)) => program.suite_tasks(),
        (None, None) => program.tasks(&[])?,
    };
    let drawing = Drawing { hints: Hints::Full, has_pictures: false };
    let Some(mut examined) = program.examine(tasks, drawing)? else { return Ok(exit::INTERRUPTED) };
    if examined.diagnosis.accepted() {
        console::report("Nothing is wrong by the fair rules on these scenes.\n")?;
        return Ok(exit::ACCEPTED);
    }
    let (runs, time) = (arguments.runs, Duration::from_secs(arguments.seconds.into()));
    let drawing = Drawing { has_pictures: arguments.format == ExplainFormat::Html, ..drawing };
    let limits = ShrinkLimits { runs, time, jobs: JOBS };
    add_smallest(&program, &mut examined, limits, arguments.step, drawing)?;
    for (number, small) in examined.diagnosis.smallest.iter_mut().enumerate() {
        let Some(name) = arguments.output.as_deref().map(|name| numbered(name, number)) else { break };
        Output::create(&name, &[])?.finish_with(small.xml().as_bytes())?;
        small.file = Some(name.display().to_string());
    }
    let Diagnosis { smallest, .. } = &examined.diagnosis;
    match arguments.format {
        ExplainFormat::Text if smallest.is_empty() => {
            console::report("No smaller scene shows again what is wrong.\n")?;
        }
        ExplainFormat::Text => {
            let texts: Vec<String> = smallest.iter().map(|one| one.text(console::style())).collect();
            console::report(&texts.join("\n"))?;
        }
        ExplainFormat::Json => console::print(examined.diagnosis.json())?,
        ExplainFormat::Html => {
            let cards = &examined.cards[examined.diagnosis.cases.len()..];
            let diagnosis = Diagnosis { smallest: smallest.clone(), ..Diagnosis::default() };
            console::print(ExplainedPage { diagnosis: &diagnosis, cards }.html())?;
        }
    }
    Ok(exit::NOT_ACCEPTED)
}

/// Returns the name of the file for a further scene: `small-2.xml` behind `small.xml`.
fn numbered(name: &Path, number: usize) -> std::path::PathBuf {
    let Some(stem) = name.file_stem().filter(|_| number > 0) else { return name.to_owned() };
    let extension = name.extension().map(|end| format!(".{}", end.to_string_lossy())).unwrap_or_default();
    name.with_file_name(format!("{}-{}{extension}", stem.to_string_lossy(), number + 1))
}

/// Adds the smallest scene for each cause, and its card, to what is said of a program.
pub(super) fn add_smallest(
    program: &ProgramUnderTest,
    examined: &mut ExaminedProgram,
    limits: ShrinkLimits,
    step: Option<u32>,
    drawing: Drawing,
) -> Result<()> {
    let ExaminedProgram { diagnosis, cards, tasks, ends } = examined;
    let runs = diagnosis.cases.iter().zip(&*tasks).zip(&*ends).filter(|((case, _), _)| !case.accepted);
    let wrong: Vec<WrongScene<'_>> =
        runs.map(|((case, task), (ended, _))| WrongScene { task, explanations: &case.explanations, ended }).collect();
    let run_limits = program.limits(false);
    let shrinker = Shrinker {
        runner: program.runner(&run_limits),
        program: &program.program,
        assignment: program.assignment,
        limits,
    };
    let causes = causes(&diagnosis.common, &wrong);
    let bar = console::Bar::for_runs(causes.len() as u64);
    let mut found: Vec<SmallestReport> = Vec::new();
    for mut cause in causes {
        bar.next_run("making scenes smaller");
        cause.step = step;
        let small = shrinker.smallest(&cause, &mut |_| {}).map_err(anyhow::Error::msg)?;
        let Some(small) = small.filter(|small| found.iter().all(|one| one.scene != small.small.scene)) else {
            continue;
        };
        let name = program.program.display().to_string();
        let failing = FailureKind::from_end(&small.seen.ended);
        let note = failing.map(|_| format!("the program {}", small.seen.ended));
        let names = (small.origin.clone(), name);
        let (mut case, card, _) = case(names, false, &small.small.scene, &small.seen.trace[..], note, drawing);
        if let WrongReason::Mistake(cause) = &small.reason {
            lead_with(cause, drawing.hints, &mut case);
        }
        let style = if drawing.has_pictures { Style::Plain } else { console::style() };
        let (differs, pair) = differences(&small, style);
        let is_told = drawing.hints == Hints::Full;
        let by_hand = pair.and_then(|pair| Some((pair, by_hand(&small, pair, style)?)));
        let (runs, is_minimal) = (small.small.runs, small.small.is_minimal);
        found.push(SmallestReport {
            case,
            runs,
            is_minimal,
            differs: differs.filter(|_| is_told),
            by_hand: by_hand.filter(|_| is_told),
            file: None,
            scene: small.small.scene,
        });
        cards.push(card);
    }
    diagnosis.smallest = found;
    Ok(())
}

/// Puts the cause before what else would explain the run; its example is that of the run.
fn lead_with(cause: &Explanation, hints: Hints, case: &mut Case) {
    let example = case.explanations.first().and_then(|one| one.example.clone());
    let cause = Explanation { example, reproduced: 0, samples: 0, same_as: Vec::new(), ..cause.clone() };
    case.explanations.retain(|one| one.said() != cause.said());
    case.explanations.splice(0..0, cut(hints, vec![cause]));
}

/// Returns the values that differ, and the pair that tells most: that of the first finding, else one that collides,
/// else the first.
fn differences(small: &SmallestScene, style: Style) -> (Option<String>, Option<Pair>) {
    let scene = &small.small.scene;
    let mut steps = WrongSteps::new(StepChoice::All);
    let options = replay::Options { threads: 1, fair: true, ..replay::Options::default() };
    let outcome = &replay::judge(scene, &small.seen.trace[..], &options, &mut steps);
    let (explanations, rules, steps) = (&[][..], Rules::Fair, &steps);
    let names = ("small.xml", "small.bin");
    let (scene_name, trace) = names;
    let check = Check {
        scene: scene_name,
        trace,
        outcome,
        explanations,
        rules,
        steps,
        audit: false,
        tables: false,
        looks_like: None,
    };
    let findings = outcome.fair.as_ref().map(|fair| &fair.findings);
    let first = findings.and_then(|findings| findings.first_divergence).and_then(|first| first.detail.pair());
    (check.steps_text(style), first.or_else(|| pairs(scene).iter().next()))
}

/// Returns what the reference computes for a pair in a scene of one step, beside what the trace has of it.
fn by_hand(small: &SmallestScene, pair: Pair, style: Style) -> Option<String> {
    let scene: &Scene = &small.small.scene;
    let layout = Layout::for_scene(scene);
    let (before, frames) = (State::for_scene(scene), frames(&small.seen.trace, layout));
    let [.., mid, end] = &frames[..] else { return None };
    if scene.steps() != 1 {
        return None;
    }
    let (name, trace) = ("small.xml", Some("small.bin"));
    if !layout.polynomials {
        let study = &OverlapStudy::for_pair(scene, 1, &before, pair).ok()??;
        let logged = Some(end.impulses.iter().any(|logged| logged.pair() == Some(pair)));
        return Some(Overlap { study, scene: name, trace, step: 1, pair, logged }.text(style));
    }
    let InspectedPair { step, .. } = inspect(scene, 1, &before, Some((&mid.state, &end.polynomials)), pair);
    let (call, passes) = (step.calls.first()?, step.calls.len());
    let place = Place { scene: name, trace, step: 1, pair, pass: Some(call.pass), passes, logged: &call.logged };
    Some(Detect { study: call.study.as_ref().ok()?, place: Some(place) }.text(style))
}

/// Returns the records of a trace, as far as they can be read.
fn frames(trace: &[u8], layout: Layout) -> Vec<Frame> {
    let mut reader = Reader::from_slice(trace, layout);
    let mut frames = Vec::new();
    let mut frame = Frame::default();
    while frames.len() < 4 && matches!(reader.next(&mut frame), Ok(true)) {
        frames.push(std::mem::take(&mut frame));
    }
    frames
}
