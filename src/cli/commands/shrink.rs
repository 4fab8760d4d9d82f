//! The command `shrink`, which finds the smallest scene on which a program is still wrong for the same reason.
use super::{
    pages::Pages,
    probes::{Drawing, ExaminedProgram, ProgramUnderTest, case, named_tasks, note},
};
use crate::{
    cli::{
        arguments::{ExplainFormat, ShrinkArguments},
        console, exit,
        output::Output,
    },
    diagnose::{About, Explanation, is_named_in},
    judge::{Finding, Rules, replay},
    report::{
        by_hand::first_step,
        case::Case,
        check::{Check, StepChoice, WrongSteps},
        describe::pair_key,
        diagnosis::Diagnosis,
        foreign::quote,
        page::{Card, ExplainedPage},
        smallest,
        style::Style,
    },
    scene,
    shrink::{SmallScene, WrongReason, beginnings},
    suite::{
        config::Hints,
        located::FailureKind,
        smallest::{MAX_BODIES, ShrinkLimits, Shrinker, ShrunkScene, SmallestScene, WrongScene, causes, impatient},
    },
    together::told::cut,
};
use anyhow::{Result, bail};
use std::{path::Path, time::Duration};

pub(super) fn run(arguments: &ShrinkArguments) -> Result<u8> {
    let program = ProgramUnderTest::new(&arguments.program, arguments.suite.as_deref(), arguments.unsafe_no_sandbox)?;
    let mut known = [program.tasks(&[])?, program.suite_tasks()];
    if arguments.suite.is_some() {
        known.reverse();
    }
    // A named scene is tried together with related ones, for the likely mistakes; a file is tried alone.
    let is_chosen = |name: &str| arguments.scene.as_deref().is_none_or(|scene| Path::new(name) == scene);
    let named = known.into_iter().find(|tasks| tasks.iter().any(|task| is_chosen(&task.name)));
    let mut tasks = match (named, &arguments.scene) {
        (None, Some(scene)) => named_tasks(std::slice::from_ref(scene))?,
        (named, _) => named.unwrap_or_default(),
    };
    tasks.retain(|task| task.scene.particles.len() <= MAX_BODIES);
    if tasks.is_empty() {
        bail!("`shrink` needs a scene with at most {MAX_BODIES} bodies");
    }
    let drawing = Drawing { hints: Hints::Full, has_pictures: false };
    let Some(mut examined) = program.examine(tasks, drawing)? else { return Ok(exit::INTERRUPTED) };
    if examined.diagnosis.cases.iter().all(|case| case.accepted || !is_chosen(&case.scene)) {
        console::report("Nothing is wrong by the fair rules on these scenes.\n")?;
        return Ok(exit::ACCEPTED);
    }
    let (runs, time) = (arguments.runs, Duration::from_secs(arguments.seconds.into()));
    let drawing = Drawing { has_pictures: arguments.format == ExplainFormat::Html, ..drawing };
    let limits = ShrinkLimits { runs, time };
    add_smallest(&program, &mut examined, limits, &is_chosen, arguments.step, drawing)?;
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
            console::report("No smaller scene reproduces the fault.\n")?;
        }
        ExplainFormat::Text => console::report(&texts.join("\n"))?,
        ExplainFormat::Json => console::print(examined.diagnosis.json())?,
        ExplainFormat::Html => {
            let cards = &examined.cards[examined.diagnosis.cases.len()..];
            let diagnosis = Diagnosis { smallest: smallest.clone(), ..Diagnosis::default() };
            console::print(ExplainedPage { diagnosis: &diagnosis, cards }.html())?;
        }
    }
    // After an interruption, the best scene so far was reported.
    Ok(if program.cancellation.is_cancelled() { exit::INTERRUPTED } else { exit::NOT_ACCEPTED })
}

/// Returns the file name for a further scene, such as `small-2.xml` after `small.xml`.
fn number_file(name: &Path, number: usize) -> std::path::PathBuf {
    let Some(stem) = name.file_stem().filter(|_| number > 0) else { return name.to_owned() };
    let extension = name.extension().map(|end| format!(".{}", end.to_string_lossy())).unwrap_or_default();
    name.with_file_name(format!("{}-{}{extension}", stem.to_string_lossy(), number + 1))
}

/// Adds the smallest scene for each cause and its card to a program's report; only the chosen scenes are reduced.
pub(super) fn add_smallest(
    program: &ProgramUnderTest,
    examined: &mut ExaminedProgram,
    limits: ShrinkLimits,
    is_chosen: &dyn Fn(&str) -> bool,
    step: Option<u32>,
    drawing: Drawing,
) -> Result<()> {
    let ExaminedProgram { diagnosis, cards, tasks, ends } = examined;
    let runs = diagnosis
        .cases
        .iter()
        .zip(&*tasks)
        .zip(&*ends)
        .filter(|((case, _), _)| !case.accepted && is_chosen(&case.scene));
    let wrong: Vec<WrongScene<'_>> =
        runs.map(|((case, task), (ended, _))| WrongScene { task, explanations: &case.explanations, ended }).collect();
    let run_limits = impatient(&program.limits());
    let shrinker = Shrinker {
        runner: program.runner(&run_limits),
        program: &program.program,
        assignment: program.assignment,
        limits,
        step,
    };
    let name = program.program.display().to_string();
    let causes = causes(&diagnosis.common, &wrong);
    let bar = console::Bar::for_runs(causes.len() as u64);
    let mut found: Vec<SmallestScene> = Vec::new();
    for cause in causes {
        bar.next_run("making scenes smaller");
        let small = shrinker.smallest(&cause).map_err(anyhow::Error::msg)?;
        let told = small.map(|small| describe(&small, &name, &program.suite, drawing));
        if let Some((small, card)) = told.filter(|(told, _)| told.is_new(&found)) {
            found.push(small);
            cards.push(card);
        }
    }
    diagnosis.smallest = found;
    Ok(())
}

/// Returns the report on a smallest scene in a grade, and stores its cards. The hints are those of staff and of
/// students.
pub(super) fn describe_for_grade(
    small: &ShrunkScene,
    program: &str,
    suite: &str,
    hints: [Hints; 2],
    pages: Option<&Pages>,
) -> SmallestScene {
    let has_pictures = pages.is_some();
    let [(mut for_staff, card), (_, own)] =
        hints.map(|hints| describe(small, program, suite, Drawing { hints, has_pictures }));
    let keep = |card| pages.and_then(|pages| pages.keep(card));
    (for_staff.card, for_staff.card_for_students) = (keep(card), keep(own));
    for_staff
}

/// Returns the report on a smallest scene, with its card.
fn describe(small: &ShrunkScene, program: &str, suite: &str, drawing: Drawing) -> (SmallestScene, Option<Card>) {
    let ShrunkScene { reason, origin, small: SmallScene { scene, step, runs, is_minimal }, seen, .. } = small;
    let note = FailureKind::from_end(&seen.ended).and_then(|_| note(&seen.ended, seen.trace.is_empty(), &[]));
    let note =
        note.map(|note| if scene.particles.is_empty() { format!("{note}, even without any body") } else { note });
    let names = ("small.xml".to_owned(), program.to_owned());
    let (mut case, card, _) = case(names, false, scene, &seen.trace[..], note, drawing);
    // A card would show two equal motions if the program does not end well and its steps are right.
    let card = card.filter(|_| case.note.is_none() || case.first.is_some());
    if let WrongReason::Mistake(cause) = reason {
        lead_with(cause, drawing.hints, &mut case);
    }
    let Case { trace: program, note, first, explanations, .. } = case;
    let names = [program.as_str(), origin, suite].map(quote);
    let again = format!("fosssim-oracle shrink {} {} --step {step} --suite {}", names[0], names[1], names[2]);
    let mut told = SmallestScene {
        origin: origin.clone(),
        program,
        xml: scene::write(scene),
        bodies: scene.particles.len(),
        steps: scene.steps(),
        again,
        runs: *runs,
        is_minimal: *is_minimal,
        note,
        first,
        explanations,
        ..SmallestScene::default()
    };
    if drawing.hints == Hints::Full {
        let (differs, first) = differences(small);
        told.differs = differs;
        if let Some(Finding { step, detail, .. }) = first.filter(|_| told.note.is_none()) {
            let place = detail.pair().map(|pair| (pair, detail.pass()));
            told.detect = place.map(|(pair, pass)| {
                let pass = pass.map_or_else(String::new, |pass| format!(" --pass {}", pass.index + 1));
                format!("--step {step} --pair {}{pass}", pair_key(pair))
            });
            let alone = beginnings(scene, &seen.trace, &[step]).into_iter().find(|(_, scene)| scene.steps() == 1);
            told.by_hand = alone.and_then(|(_, scene)| first_step(&scene, place, step));
        }
    }
    (told, card)
}

/// Moves the cause before other explanations of the run, with the example of the run.
fn lead_with(cause: &Explanation, hints: Hints, case: &mut Case) {
    let own = case.explanations.iter().position(|one| is_named_in(cause, std::slice::from_ref(one)));
    let own = own.map(|place| case.explanations.remove(place)).or_else(|| case.explanations.first().cloned());
    let lead = match own {
        // The run's explanation has the counts of the run.
        Some(own) if matches!(cause.about, About::Pairs(_)) => own,
        own => {
            let example = own.and_then(|own| own.example);
            // The list contains the unwritten stages.
            let same_as = if cause.is_unfinished() { cause.same_as.clone() } else { Vec::new() };
            Explanation { example, reproduced: 0, samples: 0, same_as, ..cause.clone() }
        }
    };
    case.explanations.splice(0..0, cut(hints, vec![lead]));
}

/// Returns the differing values as text, and the first finding.
fn differences(small: &ShrunkScene) -> (Option<String>, Option<Finding>) {
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
    (check.steps_text(Style::Plain), findings.and_then(|findings| findings.first_divergence))
}
