//! `explain`: what is likely wrong with the program that left a trace, or with a program at hand.
use super::{grade::backend, pages};
use crate::{
    assignments::{Assignment, Definition},
    cli::{
        arguments::{Explain, ExplainFormat},
        console, exit, input,
        interrupt::cancelled_by_signals,
        output::Output,
    },
    diagnose::{self, Explanation},
    evidence::{KeptPart, examine},
    files::Place,
    judge::{Rules, fair::FairVerdict, kept::LONGEST, replay::Options},
    report::{
        check::stopped,
        diagnosis::{Case, Diagnosis},
        foreign::{one_line, printed},
        number::counted,
        page::{Card, ExplainedPage},
        style::Style,
    },
    sandbox::Ended,
    scene::{self, Scene},
    suite::{
        Folders, Runner, SceneTask,
        cards::Judged,
        config::{Hints, RunLimits},
        located::{ContentIndex, Contents, Failing, LocatedFailure, TriedScene, locate},
        milestone,
        plan::{self, Plan},
    },
    together::told::cut,
};
use anyhow::{Context, Result, bail};
use std::{
    io::{self, Read},
    path::{Path, PathBuf},
    time::Duration,
};

/// The time on the processor and on the clock for a program on scenes of which a right one needs some milliseconds.
const PATIENT: [Duration; 2] = [Duration::from_secs(4), Duration::from_secs(10)];

/// The time after a run that has ended at a limit. What the program has recorded until then is read all the same.
const IMPATIENT: [Duration; 2] = [Duration::from_millis(500), Duration::from_secs(2)];

/// The number of runs that may end at a limit at all: the other scenes would say the same.
const MOST_STOPPED: usize = 4;

pub(super) fn run(arguments: &Explain) -> Result<u8> {
    let target = arguments.output.as_deref().map(|name| Output::create(name, &[])).transpose()?;
    let (diagnosis, cards) = match (&arguments.program, &arguments.inputs[..]) {
        (Some(program), scenes) => match program_on_probes(program, scenes, arguments)? {
            Some(explained) => explained,
            None => return Ok(exit::INTERRUPTED),
        },
        (None, [scene, trace]) => {
            let (case, card) = trace_on_scene(scene, trace, arguments)?;
            (Diagnosis { cases: vec![case], common: Vec::new(), located: None }, vec![card])
        }
        (None, _) => bail!("explain takes a scene and a trace, or --program PROGRAM and any number of scenes"),
    };
    let style = if target.is_some() { Style::Plain } else { console::style() };
    let text = match arguments.format {
        ExplainFormat::Text => diagnosis.text(style),
        ExplainFormat::Json => diagnosis.json(),
        ExplainFormat::Html => ExplainedPage { diagnosis: &diagnosis, cards: &cards }.html(),
    };
    match target {
        Some(target) => target.finish_and_tell(text.as_bytes(), arguments.format == ExplainFormat::Html)?,
        None if arguments.format == ExplainFormat::Text => console::report(&text)?,
        None => console::print(&text)?,
    }
    Ok(if diagnosis.accepted() { exit::ACCEPTED } else { exit::NOT_ACCEPTED })
}

fn trace_on_scene(scene: &Path, trace: &Path, arguments: &Explain) -> Result<(Case, Option<Card>)> {
    let scene = input::scene(scene)?;
    let mut trace = input::trace(trace)?;
    if let Some(kind) = trace.looks_like {
        bail!("{} is not a trace: it {kind}", trace.name);
    }
    let (case, card, _) =
        case((scene.name, trace.name.clone()), true, &scene.scene, &mut trace.reader, None, arguments);
    // Bytes behind the last step are of interest only where they can't be read.
    let _ = io::copy(&mut (&mut trace.reader).take(LONGEST as u64), &mut io::sink());
    trace.not_failed()?;
    Ok((case, card))
}

/// Judges a trace by the fair rules, and explains it if they reject it; for a page it is drawn as well.
fn case(
    (name, trace): (String, String),
    has_trace: bool,
    scene: &Scene,
    bytes: impl Read + Send,
    note: Option<String>,
    arguments: &Explain,
) -> (Case, Option<Card>, u32) {
    let hints: Hints = arguments.hints;
    let options = Options { fair: true, ..Options::default() };
    let examined = examine(scene, bytes, KeptPart::All, &options, &mut ());
    let outcome = &examined.outcome;
    // How the program ended tells more than how its trace did.
    let note = note.or_else(|| outcome.stop.as_ref().map(|stop| stopped(stop, outcome)));
    let fair = outcome.fair.clone().unwrap_or_default();
    let accepted = fair.verdict == FairVerdict::Accepted && note.is_none();
    // Of what breaks off and is right so far there is nothing to explain.
    let is_wrong = outcome.stop.is_none() || fair.findings.first_divergence.is_some();
    let is_explained = fair.verdict != FairVerdict::Accepted && is_wrong && hints.explains();
    let explanations = if is_explained { examined.explain() } else { Vec::new() };
    let first = fair.findings.first_divergence.as_ref().and_then(|first| hints.finding(first));
    let explanations = cut(hints, explanations);
    let draws = arguments.format == ExplainFormat::Html && !accepted;
    let card = draws.then(|| {
        let judged = Judged {
            scene,
            name: &name,
            explanations: &explanations,
            outcome,
            rulings: &examined.rulings,
            trace: examined.trace.bytes(),
            is_cut: !examined.trace.is_whole() || examined.trace.bytes().len() >= LONGEST,
            rules: Rules::Fair,
            hints,
        };
        pages::card(&judged, has_trace.then_some(trace.as_str()), 2)
    });
    (Case { scene: name, trace, accepted, note, first, explanations }, card.flatten(), outcome.steps_judged)
}

/// Returns a program's path from the root, without `..`, which means another folder in a sandbox. Its own name stays,
/// also that of a link: programs may go by the name that they are called.
fn placed(program: &Path) -> PathBuf {
    let folder = program.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    match (folder.canonicalize(), program.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => program.to_owned(),
    }
}

/// Runs a program on scenes that make every term of every formula visible, and on those that are named. Nothing when it
/// was interrupted.
fn program_on_probes(
    program: &Path,
    scenes: &[PathBuf],
    arguments: &Explain,
) -> Result<Option<(Diagnosis, Vec<Option<Card>>)>> {
    let program = placed(program);
    let cancellation = cancelled_by_signals();
    let backend = backend(arguments.unsafe_no_sandbox)?;
    let (folders, nowhere, usual) = (Folders::default(), Place::new("", ""), plan::find(Assignment::DEFAULT.key())?);
    let runner = Runner {
        folders: &folders,
        backend: &backend,
        run: &usual.run,
        limits: &usual.limits,
        rules: Rules::Fair,
        hints: Hints::Full,
        student_hints: Hints::Full,
        recorded: false,
        cancellation: &cancellation,
        faults: &nowhere,
        trace: None,
        cards: None,
        timings: None,
    };
    let assignment = arguments.suite.map_or_else(|| own_milestone(&runner, &program), Ok)?;
    let plan = plan::find(assignment.key())?;
    let mut tasks = tasks(assignment, &plan, scenes)?;
    let [long, short] = [PATIENT, IMPATIENT].map(|[cpu, wall]| RunLimits {
        cpu: plan.limits.cpu.min(cpu),
        wall: plan.limits.wall.min(wall),
        ..plan.limits
    });
    let runner = |limits| Runner { run: &plan.run, limits, ..runner };
    let (mut cases, mut cards, mut ends, mut stopped, mut traceless) = (Vec::new(), Vec::new(), Vec::new(), 0, 0);
    let bar = console::Bar::of_runs(tasks.len() as u64);
    for task in &tasks {
        if stopped >= MOST_STOPPED {
            break;
        }
        bar.next_run(&task.name);
        let limits = if stopped == 0 { &long } else { &short };
        let (trace, outcome) = runner(limits).collect(&program, task, LONGEST).map_err(anyhow::Error::msg)?;
        if cancellation.is_cancelled() {
            return Ok(None);
        }
        if let Ended::CouldNotStart(problem) = &outcome.ended {
            bail!("{}: {problem}", program.display());
        }
        let failing = Failing::from_end(&outcome.ended);
        stopped += usize::from(matches!(failing, Some(Failing::Time | Failing::Memory | Failing::Output)));
        let note = note(&outcome.ended, trace.is_empty(), &outcome.stderr.bytes);
        traceless += usize::from(trace.is_empty());
        let shown = program.display().to_string();
        let (case, card, steps) = case((task.name.clone(), shown), false, &task.scene, &trace[..], note, arguments);
        cases.push(case);
        cards.push(card);
        ends.push((failing, steps));
    }
    drop(bar);
    let left_out = tasks.len() - cases.len();
    tasks.truncate(cases.len());
    if left_out > 0 {
        let scenes = counted(left_out as u64, "scene");
        console::remark(format!(
            "the program ran into its limits on {stopped} scenes, so it was not run on {scenes} more: look for the \
             loop that does not end\n"
        ));
    }
    if traceless == tasks.len() && arguments.suite.is_some() {
        console::remark("if this program is of another milestone: without --suite that is found out\n");
    }
    let (common, refuted) = likely(assignment, &cases, &tasks);
    for case in &mut cases {
        case.explanations = diagnose::settled(&case.explanations, &common, &refuted).explanations;
    }
    Ok(Some((Diagnosis { cases, common, located: located(&tasks, &ends) }, cards)))
}

/// Returns the remark on how a program ended, unless it ended well.
fn note(ended: &Ended, is_traceless: bool, stderr: &[u8]) -> Option<String> {
    match (ended, is_traceless) {
        (Ended::Exited(0), false) => None,
        (ended, false) => Some(format!("the program {ended}")),
        (ended, true) => Some(format!("the program {ended} and wrote no trace{}", said(stderr))),
    }
}

/// Finds out of which milestone a program is, and says so where that is not the default.
fn own_milestone(runner: &Runner<'_>, program: &Path) -> Result<Assignment> {
    let found = milestone::looks_like(runner, program).map_err(anyhow::Error::msg)?.unwrap_or(Assignment::DEFAULT);
    if found != Assignment::DEFAULT {
        let Definition { title, key, .. } = found.definition();
        console::remark(format!("it looks like a program of {title} (--suite {key})\n"));
    }
    Ok(found)
}

/// Returns the last line of a program's error output, where it wrote one.
fn said(stderr: &[u8]) -> String {
    let text = printed(&String::from_utf8_lossy(stderr));
    let last = text.lines().rev().map(str::trim).find(|line| !line.is_empty());
    last.map(|line| format!("; its standard error ends with: {}", one_line(line))).unwrap_or_default()
}

/// Returns the properties that the failing scenes have in common, by the end of the program in each and the number of
/// complete steps.
fn located(tasks: &[SceneTask], ends: &[(Option<Failing>, u32)]) -> Option<LocatedFailure> {
    if ends.iter().all(|(failing, _)| failing.is_none()) {
        return None;
    }
    let contents: Vec<Contents> = tasks.iter().map(|task| ContentIndex::for_scene(&task.scene)).collect();
    let tried = tasks.iter().zip(&contents).zip(ends);
    let tried =
        tried.map(|((task, contents), &(failing, steps))| TriedScene { scene: &task.name, failing, steps, contents });
    locate(&tried.collect::<Vec<_>>())
}

/// Returns the likely mistakes of the wrong traces together, and the keys of those that are ruled out.
fn likely(whose: Assignment, cases: &[Case], tasks: &[SceneTask]) -> (Vec<Explanation>, Vec<String>) {
    let (right, wrong): (Vec<_>, Vec<_>) = cases.iter().zip(tasks).partition(|(case, _)| case.accepted);
    let wrong: Vec<(&Scene, &[Explanation])> =
        wrong.into_iter().map(|(case, task)| (&task.scene, case.explanations.as_slice())).collect();
    let right: Vec<&Scene> = right.into_iter().map(|(_, task)| &task.scene).collect();
    let refuted = diagnose::refuted(Some(whose), &wrong, &right);
    (diagnose::several(wrong.into_iter().map(|(_, explanations)| explanations), &refuted), refuted)
}

/// Returns the scenes to run: the probe scenes of the milestone, its suite's where these show what the probe scenes do
/// not, and those that are named.
fn tasks(assignment: Assignment, plan: &Plan, scenes: &[PathBuf]) -> Result<Vec<SceneTask>> {
    let mut tasks = Vec::new();
    for (name, scene) in diagnose::probe_scenes(assignment) {
        let xml = scene::write(&scene).into_bytes();
        tasks.push(SceneTask { name: format!("probe {name}"), xml, scene, recording: None });
    }
    // The default milestone's probe scenes show every term of every formula.
    let of_suite = plan.scenes().filter(|_| assignment != Assignment::DEFAULT);
    tasks.extend(of_suite.cloned());
    for path in scenes {
        let scene = input::scene(path)?;
        let xml = scene::write(&scene.scene).into_bytes();
        tasks.push(SceneTask { name: scene.name, xml, scene: scene.scene, recording: None });
    }
    if tasks.is_empty() { Err(anyhow::anyhow!("no scene to run")).context("explain --program") } else { Ok(tasks) }
}
