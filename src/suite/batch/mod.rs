//! Grades submissions on a plan: scenes are shared out among jobs, results are told and kept as they come.
//!
//! Events are the interface to reports and progress displays. They arrive on the caller's thread, one after the other;
//! a result has been written to the journal before its event is sent. What is found in the journal is not run again.
use super::{
    execute::{Cancellation, Runner, not_run},
    grade::{Build, Grade, SceneGrade},
    journal::{Journal, JournalError, Key},
    plan::Plan,
    score,
    staging::{self, Staged, StagingError},
    verdict::Verdict,
};
use crate::{judge::Rules, sandbox::Backend};
use std::{
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex, MutexGuard, OnceLock, PoisonError,
        atomic::{AtomicUsize, Ordering},
        mpsc,
    },
    time::{Duration, Instant},
};

/// What is graded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Submission {
    /// Its name in reports.
    pub name: String,
    /// The program, or the folder of sources when the plan builds.
    pub path: PathBuf,
    /// The program's name in the folder `path`, when the submission is a folder that somebody else filled. Links that
    /// leave the folder are not followed.
    pub program: Option<String>,
}

/// How to go about it.
#[derive(Debug, Clone, Copy)]
pub struct BatchOptions {
    /// Runs at one time.
    pub jobs: usize,
    /// Whether a run is cut short at its first wrong step.
    pub fail_fast: bool,
    /// Whether traces are judged against the recordings instead of the reference simulator.
    pub recorded: bool,
}

/// What happens during a grading.
#[derive(Debug)]
pub enum Event<'a> {
    /// A scene begins to run.
    SceneBegins {
        /// The submission's number.
        submission: usize,
        /// The scene's number in the plan.
        scene: usize,
    },
    /// Steps of a running scene have been judged up to this one; not every step is told.
    Step {
        /// The submission's number.
        submission: usize,
        /// The scene's number in the plan.
        scene: usize,
        /// The step.
        step: u32,
    },
    /// A scene has its verdict.
    SceneDone {
        /// The submission's number.
        submission: usize,
        /// The scene's number in the plan.
        scene: usize,
        /// The result.
        grade: &'a SceneGrade,
    },
    /// A submission has its grade.
    Graded {
        /// The submission's number.
        submission: usize,
        /// The grade.
        grade: &'a Grade,
    },
}

/// What a grading ended with.
#[derive(Debug)]
pub struct Graded {
    /// The grades, in the order of the submissions.
    pub grades: Vec<Grade>,
    /// Why results could no longer be kept, for example a full disk: grading was stopped then.
    pub fault: Option<JournalError>,
}

enum Message {
    Begins(usize, usize),
    Step(usize, usize, u32),
    /// Found in the journal is told as well; it needs no keeping.
    Done(usize, usize, Box<SceneGrade>, Option<Key>),
}

/// One submission at work: staged once, by the first job that has to run it, and until its last scene is done.
struct Work {
    /// The digest of the program as it lies there; none for what has to be built first.
    digest: OnceLock<Option<blake3::Hash>>,
    staged: Mutex<Option<Arc<Result<Staged, String>>>>,
    begun: OnceLock<Instant>,
    left: AtomicUsize,
}

/// Grades all submissions; the grades come back in the same order. After a cancellation the scenes that were not run
/// say so.
pub fn run(
    plan: &Plan,
    submissions: &[Submission],
    backend: &Backend,
    mut journal: Option<&mut Journal>,
    options: BatchOptions,
    cancellation: &Cancellation,
    on_event: &mut dyn FnMut(Event<'_>),
) -> Graded {
    staging::sweep();
    let scenes: Vec<_> = plan.scenes().collect();
    let works: Vec<Work> = submissions
        .iter()
        .map(|_| Work {
            digest: OnceLock::new(),
            staged: Mutex::default(),
            begun: OnceLock::new(),
            left: AtomicUsize::new(scenes.len()),
        })
        .collect();
    let tasks = submissions.len() * scenes.len();
    let next = AtomicUsize::new(0);
    let known: Option<&Journal> = journal.as_deref();
    // Jobs look results up in what the journal held at the start; new ones are kept by the main thread.
    let found = known.map(Journal::snapshot).unwrap_or_default();
    let words = plan_words(plan, options, backend);
    let (sender, receiver) = mpsc::channel();
    let mut results: Vec<Vec<Option<SceneGrade>>> = submissions.iter().map(|_| vec![None; scenes.len()]).collect();
    let mut grades: Vec<Option<Grade>> = submissions.iter().map(|_| None).collect();
    let mut failed = None;
    std::thread::scope(|scope| {
        for _ in 0..options.jobs.clamp(1, tasks.max(1)) {
            let (sender, works, next, scenes, found, words) = (sender.clone(), &works, &next, &scenes, &found, &words);
            scope.spawn(move || {
                let runner = Runner {
                    backend,
                    run: &plan.run,
                    limits: &plan.limits,
                    rules: effective_rules(plan, options),
                    hints: plan.hints,
                    fail_fast: options.fail_fast,
                    recorded: options.recorded,
                    cancellation,
                };
                loop {
                    let task = next.fetch_add(1, Ordering::Relaxed);
                    if task >= tasks {
                        return;
                    }
                    let (submission, number) = (task / scenes.len(), task % scenes.len());
                    let (work, scene) = (&works[submission], scenes[number]);
                    let steps = scene.scene.steps();
                    work.begun.get_or_init(Instant::now);
                    let _ = sender.send(Message::Begins(submission, number));
                    let key_of = |digest: &blake3::Hash, called: &str| {
                        // A program may behave as it is called, so its name belongs to what is graded.
                        let own = [scene.name.as_str(), called];
                        let words: Vec<&str> = words.iter().map(String::as_str).chain(own).collect();
                        Key::of(digest, &scene.xml, &words)
                    };
                    let known = work.digest.get_or_init(|| digest(&submissions[submission], plan)).and_then(|digest| {
                        let called = submissions[submission].called();
                        found.get(&key_of(&digest, &called))
                    });
                    if let Some(grade) = known {
                        let grade = SceneGrade { cached: true, ..grade.clone() };
                        let _ = sender.send(Message::Done(submission, number, Box::new(grade), None));
                        continue;
                    }
                    let staged = work.staged(|| stage(&submissions[submission], plan, backend, cancellation));
                    let (grade, key) = match &*staged {
                        Err(message) => (not_run(&scene.name, steps, Verdict::JudgeError, message.clone()), None),
                        Ok(Staged { refused: Some(why), .. }) => {
                            (not_run(&scene.name, steps, Verdict::RuntimeError, why.clone()), None)
                        }
                        Ok(staged) if staged.build.as_ref().is_some_and(|build| !build.succeeded) => {
                            let verdict =
                                if cancellation.is_cancelled() { Verdict::NotRun } else { Verdict::CompileError };
                            (not_run(&scene.name, steps, verdict, "the sources do not build".to_owned()), None)
                        }
                        Ok(staged) => {
                            let key = key_of(&staged.digest, &called(&staged.program));
                            match found.get(&key) {
                                Some(grade) => (SceneGrade { cached: true, ..grade.clone() }, None),
                                None => {
                                    let mut told = Instant::now();
                                    let mut on_step = |step| {
                                        // A display can't show more, and a channel should not hold more.
                                        if told.elapsed() > Duration::from_millis(100) {
                                            told = Instant::now();
                                            let _ = sender.send(Message::Step(submission, number, step));
                                        }
                                    };
                                    (runner.grade(&staged.program, scene, &mut on_step), Some(key))
                                }
                            }
                        }
                    };
                    let _ = sender.send(Message::Done(submission, number, Box::new(grade), key));
                }
            });
        }
        drop(sender);
        for message in receiver {
            match message {
                Message::Begins(submission, scene) => on_event(Event::SceneBegins { submission, scene }),
                Message::Step(submission, scene, step) => on_event(Event::Step { submission, scene, step }),
                Message::Done(submission, scene, grade, key) => {
                    if let (Some(journal), Some(key)) = (journal.as_deref_mut(), key)
                        && failed.is_none()
                        && let Err(error) = journal.keep(&key, &submissions[submission].name, &grade)
                    {
                        failed = Some(error);
                        cancellation.cancel();
                    }
                    on_event(Event::SceneDone { submission, scene, grade: &grade });
                    results[submission][scene] = Some(*grade);
                    let work = &works[submission];
                    if work.left.fetch_sub(1, Ordering::Relaxed) == 1 {
                        let scenes = results[submission].iter_mut().filter_map(Option::take).collect();
                        let wall = work.begun.get().map_or(Duration::ZERO, Instant::elapsed);
                        // The copy goes away now, not when the whole batch ends.
                        let build = match work.lock().take().as_deref() {
                            Some(Ok(staged)) => staged.build.clone(),
                            _ => None,
                        };
                        let rules = effective_rules(plan, options);
                        let grade = assemble(plan, &submissions[submission], rules, backend, scenes, build, wall);
                        on_event(Event::Graded { submission, grade: &grade });
                        grades[submission] = Some(grade);
                    }
                }
            }
        }
    });
    Graded { grades: grades.into_iter().flatten().collect(), fault: failed }
}

impl Work {
    fn lock(&self) -> MutexGuard<'_, Option<Arc<Result<Staged, String>>>> {
        self.staged.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The staged submission; whoever comes first stages it, the others wait.
    fn staged(&self, stage: impl FnOnce() -> Result<Staged, StagingError>) -> Arc<Result<Staged, String>> {
        let mut staged = self.lock();
        staged.get_or_insert_with(|| Arc::new(stage().map_err(|error| error.to_string()))).clone()
    }
}

impl Submission {
    /// The name of its program's file.
    fn called(&self) -> String {
        called(&self.program.as_ref().map_or_else(|| self.path.clone(), |program| self.path.join(program)))
    }
}

fn called(program: &Path) -> String {
    program.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// The digest of a program that needs no build and no copy to be known.
fn digest(submission: &Submission, plan: &Plan) -> Option<blake3::Hash> {
    let builds = plan.build.is_some() && submission.path.is_dir();
    let own = !builds && submission.program.is_none();
    own.then(|| staging::digest(&submission.path)).flatten()
}

/// Everything besides program and scene that a result depends on.
fn plan_words(plan: &Plan, options: BatchOptions, backend: &Backend) -> Vec<String> {
    let walls: Vec<&str> =
        backend.layers().iter().filter(|report| report.active).map(|report| report.layer.name()).collect();
    vec![
        walls.join(","),
        effective_rules(plan, options).name().to_owned(),
        plan.run.join("\u{1f}"),
        format!("{:?}", plan.limits),
        format!("{:?}", plan.hints),
        format!("fail_fast={} recorded={}", options.fail_fast, options.recorded),
    ]
}

/// Against recordings there is nothing but the original's rules: the fair ones follow the submission.
const fn effective_rules(plan: &Plan, options: BatchOptions) -> Rules {
    if options.recorded { Rules::Parity } else { plan.rules }
}

fn stage(
    submission: &Submission,
    plan: &Plan,
    backend: &Backend,
    cancellation: &Cancellation,
) -> Result<Staged, StagingError> {
    match &plan.build {
        Some(step) if submission.path.is_dir() => staging::build(&submission.path, step, backend, cancellation),
        _ => match &submission.program {
            Some(program) => staging::program_in(&submission.path, program),
            None => staging::program(&submission.path),
        },
    }
}

fn assemble(
    plan: &Plan,
    submission: &Submission,
    rules: Rules,
    backend: &Backend,
    scenes: Vec<SceneGrade>,
    build: Option<Build>,
    wall: Duration,
) -> Grade {
    let mut scenes = scenes.into_iter();
    let groups: Vec<_> = plan
        .groups
        .iter()
        .map(|group| score::group(&group.name, group.stakes, scenes.by_ref().take(group.scenes.len()).collect()))
        .collect();
    let verdict = groups.iter().map(|group| group.verdict).max().unwrap_or(Verdict::NotRun);
    let active = backend.layers().iter().filter(|report| report.active);
    Grade {
        submission: submission.name.clone(),
        suite: plan.name.clone(),
        rules,
        verdict,
        points: (verdict != Verdict::JudgeError).then(|| groups.iter().map(|group| group.points).sum()),
        max_points: plan.max_points(),
        groups,
        build,
        warnings: backend.weaknesses(),
        layers: active.map(|report| report.layer.name().to_owned()).collect(),
        wall,
    }
}

#[cfg(test)]
mod tests;
