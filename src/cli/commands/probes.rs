//! Runs a program on many small scenes, and finds its faults in each scene and its likely mistakes.
use super::{host::require_backend, pages};
use crate::{
    assignments::{Assignment, Definition},
    cli::{arguments::ExplainFormat, console, input, interrupt::cancellation_by_signals, output::Output},
    diagnose::{self, Explanation},
    evidence::{KeptPart, examine},
    files::FilePlace,
    judge::{Rules, fair::FairVerdict, kept_trace::MAX_KEPT_BYTES, replay::Options},
    report::{
        case::Case,
        check::describe_stop,
        diagnosis::Diagnosis,
        number::format_count,
        page::{Card, ExplainedPage},
        style::Style,
        untrusted_text::{clean_output, to_one_line},
    },
    sandbox::{Backend, RunEnd},
    scene::{self, Scene},
    suite::{
        Cancellation, Folders, Runner, SceneTask,
        cards::JudgedTrace,
        config::{Hints, RunLimits},
        failure_cause::{FailureKind, FeatureIndex, Features, LocatedFailure, TriedScene, locate_failure},
        milestone,
        plan::{self, Plan},
        smallest_scene::shorten_limits,
    },
    together::disclosure::limit_explanations,
};
use anyhow::{Context, Result, bail};
use std::{
    io::Read,
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

/// The limits of processor time and wall time on scenes for which a correct program needs some milliseconds.
const TIME_LIMITS: [Duration; 2] = [Duration::from_secs(4), Duration::from_secs(10)];

/// The maximum number of runs that are killed at a limit. After that many, no further scenes are run.
const MAX_STOPPED: usize = 4;

/// The level of detail on cards, and whether pictures are drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Drawing {
    pub(super) hints: Hints,
    pub(super) has_pictures: bool,
}

/// A program that is to be run, and everything that its runs need.
pub(super) struct ProgramUnderTest {
    pub(super) program: PathBuf,
    pub(super) assignment: Assignment,
    /// The name of the suite in the form that commands accept.
    pub(super) suite: String,
    pub(super) cancellation: Arc<Cancellation>,
    plan: Plan,
    backend: Backend,
    folders: Folders,
    unused_place: FilePlace,
}

/// A program's behavior on the scenes, and the report about it.
pub(super) struct ExaminedProgram {
    pub(super) diagnosis: Diagnosis,
    /// The cards of the cases, in the order of the cases.
    pub(super) cards: Vec<Option<Card>>,
    /// The scenes of the cases, in the order of the cases.
    pub(super) tasks: Vec<SceneTask>,
    /// For each case, the result of the run and the number of complete steps.
    pub(super) ends: Vec<(RunEnd, u32)>,
}

impl ProgramUnderTest {
    /// Prepares a program for runs. If no suite is named, the program's milestone is inferred.
    pub(super) fn new(program: &Path, suite: Option<&str>, unsafe_no_sandbox: bool) -> Result<Self> {
        let mut ready = Self {
            program: make_absolute(program),
            assignment: Assignment::DEFAULT,
            suite: suite.unwrap_or_default().to_owned(),
            cancellation: cancellation_by_signals(),
            plan: plan::find_suite(suite.unwrap_or(Assignment::DEFAULT.key()))?,
            backend: require_backend(unsafe_no_sandbox)?,
            folders: Folders::default(),
            unused_place: FilePlace::new("", ""),
        };
        if suite.is_some() {
            ready.assignment = ready.plan.assignment();
        } else {
            ready.assignment = infer_milestone(&ready.runner(&ready.plan.limits), &ready.program)?;
            ready.suite = ready.assignment.key().to_owned();
            ready.plan = plan::find_suite(&ready.suite)?;
        }
        Ok(ready)
    }

    /// Returns a runner that enforces these limits.
    pub(super) fn runner<'a>(&'a self, limits: &'a RunLimits) -> Runner<'a> {
        Runner {
            folders: &self.folders,
            backend: &self.backend,
            command: &self.plan.command,
            limits,
            rules: Rules::Fair,
            hints: Hints::Full,
            student_hints: Hints::Full,
            uses_recordings: false,
            cancellation: &self.cancellation,
            fault_folder: &self.unused_place,
            trace_location: None,
            cards: None,
            timings: None,
        }
    }

    /// Returns the limits of the suite. Times are shortened, because a correct program needs only some milliseconds for
    /// the scenes.
    pub(super) fn run_limits(&self) -> RunLimits {
        let limits = self.plan.limits;
        RunLimits { cpu: limits.cpu.min(TIME_LIMITS[0]), wall: limits.wall.min(TIME_LIMITS[1]), ..limits }
    }

    /// Returns the scenes on which the program is run: the probe scenes of the milestone, the suite's scenes if they
    /// show more, and the scenes that the user named.
    pub(super) fn list_tasks(&self, scenes: &[PathBuf]) -> Result<Vec<SceneTask>> {
        let mut tasks = Vec::new();
        for (name, scene) in diagnose::probe_scenes(self.assignment) {
            let xml = scene::to_xml(&scene).into_bytes();
            tasks.push(SceneTask { name: format!("probe {name}"), xml, scene, recording: None });
        }
        // The probe scenes of the default milestone show every term of every formula.
        tasks.extend(self.suite_tasks().into_iter().filter(|_| self.assignment != Assignment::DEFAULT));
        tasks.extend(named_tasks(scenes)?);
        if tasks.is_empty() { Err(anyhow::anyhow!("no scene to run")).context("explain --program") } else { Ok(tasks) }
    }

    /// Returns the scenes of the program's suite.
    pub(super) fn suite_tasks(&self) -> Vec<SceneTask> {
        self.plan.scenes().cloned().collect()
    }

    /// Runs the program on scenes; `None` if the user interrupted it.
    pub(super) fn examine(&self, mut tasks: Vec<SceneTask>, drawing: Drawing) -> Result<Option<ExaminedProgram>> {
        let full_limits = self.run_limits();
        // After a run has ended at a limit, these shorter limits apply.
        let short_limits = shorten_limits(&full_limits);
        let (mut cases, mut cards, mut ends, mut stopped) = (Vec::new(), Vec::new(), Vec::new(), 0);
        let bar = console::Bar::for_runs(tasks.len() as u64);
        for task in &tasks {
            if stopped >= MAX_STOPPED {
                break;
            }
            bar.next_run(&task.name);
            let limits = if stopped == 0 { &full_limits } else { &short_limits };
            let run = self.runner(limits).collect_trace(&self.program, task, MAX_KEPT_BYTES);
            let (trace, outcome) = run.map_err(anyhow::Error::msg)?;
            if self.cancellation.is_canceled() {
                return Ok(None);
            }
            if let RunEnd::CouldNotStart(problem) = &outcome.ended {
                bail!("{}: {problem}", self.program.display());
            }
            let failing = FailureKind::from_end(&outcome.ended);
            stopped +=
                usize::from(matches!(failing, Some(FailureKind::Time | FailureKind::Memory | FailureKind::Output)));
            let note = describe_end(&outcome.ended, trace.is_empty(), &outcome.stderr.bytes);
            let names = (task.name.clone(), self.program.display().to_string());
            let (case, card, steps) = judge_case(names, false, &task.scene, &trace[..], note, drawing);
            cases.push(case);
            cards.push(card);
            ends.push((outcome.ended, steps));
        }
        drop(bar);
        let left_out_count = tasks.len() - cases.len();
        tasks.truncate(cases.len());
        if left_out_count > 0 {
            let others = format_count(left_out_count as u64, "other scene");
            console::print_remark(format!(
                "the program exceeded its limits on {stopped} scenes, so it was not run on {others}; look for a loop \
                 that does not end\n"
            ));
        }
        let (common, refuted) = find_likely(self.assignment, &cases, &tasks);
        for case in &mut cases {
            case.explanations = diagnose::correct_trace(&case.explanations, &common, &refuted).explanations;
        }
        let located = locate_failures(&tasks, &ends);
        Ok(Some(ExaminedProgram {
            diagnosis: Diagnosis { cases, common, located, smallest: Vec::new() },
            cards,
            tasks,
            ends,
        }))
    }
}

/// Judges a trace by the fair rules. If they reject it, it is also explained, and drawn if a page was requested.
pub(super) fn judge_case(
    (name, trace): (String, String),
    has_trace: bool,
    scene: &Scene,
    bytes: impl Read + Send,
    note: Option<String>,
    drawing: Drawing,
) -> (Case, Option<Card>, u32) {
    let Drawing { hints, has_pictures } = drawing;
    let options = Options { uses_fair_rules: true, ..Options::default() };
    let examined = examine(scene, bytes, KeptPart::All, &options, &mut ());
    let outcome = &examined.outcome;
    // If the program did not end normally, the result of its run explains more than the end of its trace.
    let note = note.or_else(|| outcome.stop.as_ref().map(|stop| describe_stop(stop, outcome)));
    let fair = outcome.fair.clone().unwrap_or_default();
    let accepted = fair.verdict == FairVerdict::Accepted && note.is_none();
    // If a run stops early but is right so far, no explanation is needed.
    let is_wrong = outcome.stop.is_none() || fair.findings.first_divergence.is_some();
    let is_explained = fair.verdict != FairVerdict::Accepted && is_wrong && hints.explains();
    let explanations = if is_explained { examined.explain() } else { Vec::new() };
    let first = fair.findings.first_divergence.as_ref().and_then(|first| hints.disclose_finding(first));
    let explanations = limit_explanations(hints, explanations);
    let has_card = has_pictures && !accepted;
    let card = has_card.then(|| {
        let judged_trace = JudgedTrace {
            scene,
            name: &name,
            explanations: &explanations,
            outcome,
            rulings: &examined.rulings,
            trace: examined.trace.bytes(),
            is_cut: !examined.trace.is_whole() || examined.trace.bytes().len() >= MAX_KEPT_BYTES,
            rules: Rules::Fair,
            hints,
        };
        pages::card(&judged_trace, has_trace.then_some(trace.as_str()), 2)
    });
    (Case { scene: name, trace, accepted, note, first, explanations }, card.flatten(), outcome.steps_judged)
}

/// Writes a report to standard output, or to a file.
pub(super) fn report(
    diagnosis: &Diagnosis,
    cards: &[Option<Card>],
    format: ExplainFormat,
    target: Option<Output>,
) -> Result<()> {
    let style = if target.is_some() { Style::Plain } else { console::style() };
    let text = match format {
        ExplainFormat::Text => diagnosis.render_text(style),
        ExplainFormat::Json => diagnosis.json(),
        ExplainFormat::Html => ExplainedPage { diagnosis, cards }.html(),
    };
    match target {
        Some(target) => target.finish_and_print(text.as_bytes(), format == ExplainFormat::Html),
        None if format == ExplainFormat::Text => console::report(&text),
        None => console::print(&text),
    }
}

/// Reads the scenes that the user named.
pub(super) fn named_tasks(scenes: &[PathBuf]) -> Result<Vec<SceneTask>> {
    let read = |path: &PathBuf| {
        let scene = input::read_scene(path)?;
        let xml = scene::to_xml(&scene.scene).into_bytes();
        Ok(SceneTask { name: scene.name, xml, scene: scene.scene, recording: None })
    };
    scenes.iter().map(read).collect()
}

/// Returns the absolute path of a program. It does not contain `..`, which may lead to another folder in a sandbox. The
/// last name in the path is kept even if it is a link, because programs may depend on their names.
fn make_absolute(program: &Path) -> PathBuf {
    let folder = program.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    match (folder.canonicalize(), program.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => program.to_owned(),
    }
}

/// Describes how a program ended; `None` if it ended normally.
pub(super) fn describe_end(end: &RunEnd, is_traceless: bool, stderr: &[u8]) -> Option<String> {
    match (end, is_traceless) {
        (RunEnd::Exited(0), false) => None,
        (end, false) => Some(format!("the program {end}")),
        (end, true) => Some(format!("the program {end} and wrote no trace{}", find_last_line(stderr))),
    }
}

/// Infers the milestone of a program. If it is not the default, the milestone is printed.
fn infer_milestone(runner: &Runner<'_>, program: &Path) -> Result<Assignment> {
    let found = milestone::infer_milestone(runner, program).map_err(anyhow::Error::msg)?.unwrap_or(Assignment::DEFAULT);
    if found != Assignment::DEFAULT {
        let Definition { title, key, .. } = found.definition();
        console::print_remark(format!("it looks like a program of {title} (--suite {key})\n"));
    }
    Ok(found)
}

/// Returns the last line that a program wrote to standard error; empty if it wrote nothing.
fn find_last_line(stderr: &[u8]) -> String {
    let text = clean_output(&String::from_utf8_lossy(stderr));
    let last = text.lines().rev().map(str::trim).find(|line| !line.is_empty());
    last.map(|line| format!("; its standard error ends with: {}", to_one_line(line))).unwrap_or_default()
}

/// Finds what the failing scenes have in common, if scenes fail. `ends` has for each scene how the program ended, and
/// the number of complete steps.
fn locate_failures(tasks: &[SceneTask], ends: &[(RunEnd, u32)]) -> Option<LocatedFailure> {
    let ends: Vec<_> = ends.iter().map(|(ended, steps)| (FailureKind::from_end(ended), *steps)).collect();
    if ends.iter().all(|(failing, _)| failing.is_none()) {
        return None;
    }
    let contents: Vec<Features> = tasks.iter().map(|task| FeatureIndex::for_scene(&task.scene)).collect();
    let scenes = tasks.iter().zip(&contents).zip(&ends);
    let scenes = scenes.map(|((task, contents), &(failing, steps))| TriedScene {
        scene: &task.name,
        failure: failing,
        steps,
        features: contents,
    });
    locate_failure(&scenes.collect::<Vec<_>>())
}

/// Returns the likely mistakes that explain all wrong traces together, and the keys of the mistakes that correct traces
/// refute.
fn find_likely(whose: Assignment, cases: &[Case], tasks: &[SceneTask]) -> (Vec<Explanation>, Vec<String>) {
    let (right, wrong): (Vec<_>, Vec<_>) = cases.iter().zip(tasks).partition(|(case, _)| case.accepted);
    let wrong: Vec<(&Scene, &[Explanation])> =
        wrong.into_iter().map(|(case, task)| (&task.scene, case.explanations.as_slice())).collect();
    let right: Vec<&Scene> = right.into_iter().map(|(_, task)| &task.scene).collect();
    let refuted = diagnose::refuted_keys(Some(whose), &wrong, &right);
    (diagnose::explain_together(wrong.into_iter().map(|(_, explanations)| explanations), &refuted), refuted)
}
