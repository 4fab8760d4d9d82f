//! `shrink`: the smallest scene on which a program is still wrong for the same reason.
use super::{
    pages::Pages,
    probes::{Drawing, ExaminedProgram, ProgramUnderTest, case, named_tasks},
};
use crate::{
    cli::{
        arguments::{ExplainFormat, ShrinkArguments},
        console, exit,
        output::Output,
    },
    diagnose::{About, Explanation, is_named_in},
    evidence::{InspectedPair, inspect},
    judge::{Rules, overlap::OverlapStudy, replay},
    report::{
        by_hand::first_step,
        case::Case,
        check::{Check, StepChoice, WrongSteps},
        describe::pair_key,
        detect::{Detect, Overlap, Place},
        diagnosis::Diagnosis,
        page::{Card, ExplainedPage},
        smallest,
        style::Style,
    },
    scene::{self, Scene},
    shrink::{SmallScene, WrongReason},
    sim::{Pair, State, pairs},
    suite::{
        config::Hints,
        located::FailureKind,
        smallest::{
            HandComputation, MOST_BODIES, QUICK, ShrinkLimits, Shrinker, ShrunkScene, SmallestScene, WrongScene,
            causes, impatient,
        },
    },
    together::told::cut,
    trace::{Frame, Layout, Reader},
};
use anyhow::{Result, bail};
use std::{path::Path, time::Duration};

/// Runs at one time.
const JOBS: usize = 2;

/// The limits where the smallest scenes are only the end of a report.
pub(super) const AT_THE_END: ShrinkLimits = ShrinkLimits { jobs: JOBS, ..QUICK };

pub(super) fn run(arguments: &ShrinkArguments) -> Result<u8> {
    let program = ProgramUnderTest::new(&arguments.program, arguments.suite.as_deref(), arguments.unsafe_no_sandbox)?;
    let mut tasks = match (&arguments.scene, &arguments.suite) {
        (Some(scene), _) => named_tasks(std::slice::from_ref(scene))?,
        (None, Some(_)) => program.suite_tasks(),
        (None, None) => program.tasks(&[])?,
    };
    tasks.retain(|task| task.scene.particles.len() <= MOST_BODIES);
    if tasks.is_empty() {
        bail!("`shrink` needs a scene with at most {MOST_BODIES} bodies");
    }
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
    let Diagnosis { smallest, .. } = &examined.diagnosis;
    let mut texts = Vec::new();
    for (number, small) in smallest.iter().enumerate() {
        let file = arguments.output.as_deref().map(|name| number_file(name, number));
        if let Some(name) = &file {
            Output::create(name, &[])?.finish_with(small.xml.as_bytes())?;
        }
        let file = file.map(|name| name.display().to_string());
        texts.push(smallest::text(small, file.as_deref(), console::style()));
    }
    match arguments.format {
        ExplainFormat::Text if smallest.is_empty() => {
            console::report("No smaller scene shows again what is wrong.\n")?;
        }
        ExplainFormat::Text => console::report(&texts.join("\n"))?,
        ExplainFormat::Json => console::print(examined.diagnosis.json())?,
        ExplainFormat::Html => {
            let cards = &examined.cards[examined.diagnosis.cases.len()..];
            let diagnosis = Diagnosis { smallest: smallest.clone(), ..Diagnosis::default() };
            console::print(ExplainedPage { diagnosis: &diagnosis, cards }.html())?;
        }
    }
    // After an interruption the best scene so far was reported.
    Ok(if program.cancellation.is_cancelled() { exit::INTERRUPTED } else { exit::NOT_ACCEPTED })
}

/// Returns the name of the file for a further scene: `small-2.xml` behind `small.xml`.
fn number_file(name: &Path, number: usize) -> std::path::PathBuf {
    let Some(stem) = name.file_stem().filter(|_| number > 0) else { return name.to_owned() };
    let extension = name.extension().map(|end| format!(".{}", end.to_string_lossy())).unwrap_or_default();
    name.with_file_name(format!("{}-{}{extension}", stem.to_string_lossy(), number + 1))
}

/// Adds the smallest scene for each cause, and its card, to a program's report.
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
    let run_limits = impatient(&program.limits());
    let shrinker = Shrinker {
        runner: program.runner(&run_limits),
        program: &program.program,
        assignment: program.assignment,
        limits,
    };
    let name = program.program.display().to_string();
    let causes = causes(&diagnosis.common, &wrong);
    let bar = console::Bar::for_runs(causes.len() as u64);
    let mut found: Vec<SmallestScene> = Vec::new();
    for mut cause in causes {
        bar.next_run("making scenes smaller");
        cause.step = step;
        let small = shrinker.smallest(&cause, &mut |_| {}).map_err(anyhow::Error::msg)?;
        let told = small.map(|small| describe(&small, &name, drawing));
        if let Some((small, card)) = told.filter(|(told, _)| found.iter().all(|one| one.xml != told.xml)) {
            found.push(small);
            cards.push(card);
        }
    }
    diagnosis.smallest = found;
    Ok(())
}

/// Returns the report on a smallest scene in a grade, with its cards among the pages'. The hints are those of staff and
/// students.
pub(super) fn describe_for_grade(
    small: &ShrunkScene,
    program: &str,
    hints: [Hints; 2],
    pages: Option<&Pages>,
) -> SmallestScene {
    let has_pictures = pages.is_some();
    let [(mut for_staff, card), (_, own)] =
        hints.map(|hints| describe(small, program, Drawing { hints, has_pictures }));
    let keep = |card| pages.and_then(|pages| pages.keep(card));
    (for_staff.card, for_staff.card_for_students) = (keep(card), keep(own));
    for_staff
}

/// Returns the report on a smallest scene, and its card.
fn describe(small: &ShrunkScene, program: &str, drawing: Drawing) -> (SmallestScene, Option<Card>) {
    let ShrunkScene { reason, origin, small: SmallScene { scene, runs, is_minimal }, seen, .. } = small;
    let note = FailureKind::from_end(&seen.ended).map(|_| format!("the program {}", seen.ended));
    let names = ("small.xml".to_owned(), program.to_owned());
    let (mut case, card, _) = case(names, false, scene, &seen.trace[..], note, drawing);
    if let WrongReason::Mistake(cause) = reason {
        lead_with(cause, drawing.hints, &mut case);
    }
    let Case { trace: program, note, first, explanations, .. } = case;
    let mut told = SmallestScene {
        origin: origin.clone(),
        program,
        xml: scene::write(scene),
        bodies: scene.particles.len(),
        steps: scene.steps(),
        runs: *runs,
        is_minimal: *is_minimal,
        note,
        first,
        explanations,
        differs: None,
        by_hand: None,
        card: None,
        card_for_students: None,
    };
    if drawing.hints == Hints::Full {
        let (differs, pair) = differences(small);
        told.differs = differs;
        let of_pair = |pair| Some(HandComputation { pair: Some(pair_key(pair)), text: by_hand(small, pair)? });
        let forces = || Some(HandComputation { pair: None, text: first_step(scene, "small.xml")? });
        let first_pair = || of_pair(pairs(scene).iter().next()?);
        told.by_hand = match pair {
            Some(pair) => of_pair(pair),
            None if scene.steps() > 1 => None,
            // Where a pair is detected, students write more than forces.
            None => first_pair().or_else(forces),
        };
    }
    (told, card)
}

/// Puts the cause before other explanations of the run; its example is the run's.
fn lead_with(cause: &Explanation, hints: Hints, case: &mut Case) {
    let own = case.explanations.iter().position(|one| is_named_in(cause, std::slice::from_ref(one)));
    let own = own.map(|place| case.explanations.remove(place)).or_else(|| case.explanations.first().cloned());
    let lead = match own {
        // Its counts are the run's.
        Some(own) if matches!(cause.about, About::Pairs(_)) => own,
        own => {
            let example = own.and_then(|own| own.example);
            Explanation { example, reproduced: 0, samples: 0, same_as: Vec::new(), ..cause.clone() }
        }
    };
    case.explanations.splice(0..0, cut(hints, vec![lead]));
}

/// Returns the values that differ, and the pair of the first finding.
fn differences(small: &ShrunkScene) -> (Option<String>, Option<Pair>) {
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
    (check.steps_text(Style::Plain), first)
}

/// Returns the reference's computation for a pair in a scene of one step, next to the trace's numbers.
fn by_hand(small: &ShrunkScene, pair: Pair) -> Option<String> {
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
        return Some(Overlap { study, scene: name, trace, step: 1, pair, logged }.text(Style::Plain));
    }
    let InspectedPair { step, .. } = inspect(scene, 1, &before, Some((&mid.state, &end.polynomials)), pair);
    let (call, passes) = (step.calls.first()?, step.calls.len());
    let place = Place { scene: name, trace, step: 1, pair, pass: Some(call.pass), passes, logged: &call.logged };
    Some(Detect { study: call.study.as_ref().ok()?, place: Some(place) }.text(Style::Plain))
}

/// Returns the readable records of a trace.
fn frames(trace: &[u8], layout: Layout) -> Vec<Frame> {
    let mut reader = Reader::from_slice(trace, layout);
    let mut frames = Vec::new();
    let mut frame = Frame::default();
    while frames.len() < 4 && matches!(reader.next(&mut frame), Ok(true)) {
        frames.push(std::mem::take(&mut frame));
    }
    frames
}
