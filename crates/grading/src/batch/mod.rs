//! Grades submissions on a plan: scenes are shared out among jobs, results are told and kept as they come.
//!
//! Events are the interface to reports and progress displays. They arrive on the caller's thread, one after the other;
//! a result has been written to the journal before its event is sent. What is found in the journal is not run again. A
//! panic in the work on one scene is a judge error of that scene, and the batch goes on.
use super::{
    cards::Cards,
    config::Visibility,
    execute::{Cancellation, Runner, SceneTask},
    grade::{Build, Grade, GroupGrade, SceneResult},
    guard::{Fault, guarded},
    journal::{Journal, JournalError, Key},
    patience,
    plan::Plan,
    score,
    staging::Staged,
    temporary,
    verdict::Verdict,
};
use fosssim_judge::Rules;
use fosssim_mistakes::diagnose::{self, Explanation};
use fosssim_model::scene::Scene;
use fosssim_sandbox::Backend;
use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::{
        atomic::{AtomicUsize, Ordering},
        mpsc::{self, Sender},
    },
    time::{Duration, Instant},
};
use work::{Work, called};

mod work;

/// So many accepted scenes are asked whether they speak against a likely mistake.
const WITNESSES: usize = 12;

/// What is graded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Submission {
    /// Its name in reports.
    pub name: String,
    /// The program, or the folder of sources when the plan builds.
    pub path: PathBuf,
    /// The program's name in the folder `path`, which somebody else filled. Links are not followed, and nothing is built.
    pub program: Option<String>,
}

/// How to go about it.
#[derive(Debug, Clone, Copy)]
pub struct BatchOptions {
    /// Runs at one time.
    pub jobs: usize,
    /// Whether a submission's first scene that is not accepted is the last one that is run.
    pub fail_fast: bool,
    /// Whether traces are judged against the recordings instead of the reference simulator.
    pub recorded: bool,
}

/// Where to put the trace of a submission's scene.
pub type TraceFile<'a> = dyn Fn(&Submission, &SceneTask) -> PathBuf + Sync + 'a;

/// Everything that the submissions of one grading have in common.
#[derive(Clone, Copy)]
pub struct Batch<'a> {
    /// What to run.
    pub plan: &'a Plan,
    /// Where to run it.
    pub backend: &'a Backend,
    /// How.
    pub options: BatchOptions,
    /// Stops everything from outside.
    pub cancellation: &'a Cancellation,
    /// The folder for traces on which the grader itself failed; made when it is needed.
    pub faults: &'a Path,
    /// Where the trace of a scene that is not accepted is put, when somebody wants to have it.
    pub traces: Option<&'a TraceFile<'a>>,
    /// Draws and keeps cards of traces that are not simply right, when somebody wants to look at them.
    pub cards: Option<Cards<'a>>,
    /// Shows a result in the forms in which it will be reported, for nobody to see ([`Runner::rehearse`]).
    pub rehearse: &'a (dyn Fn(&SceneResult) + Sync),
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
        result: &'a SceneResult,
        /// Whether it was taken from an earlier run.
        cached: bool,
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
    /// What went wrong besides.
    pub fault: Option<BatchFault>,
}

/// What can go wrong beside the scenes' own results; always ours or the machine's.
#[derive(Debug, thiserror::Error)]
pub enum BatchFault {
    /// Results could no longer be kept, for example because the disk is full: grading was stopped then.
    #[error(transparent)]
    Journal(#[from] JournalError),
    /// An event was not borne; grading went on.
    #[error("telling how grading goes failed: {0}; please report this")]
    Telling(Fault),
}

enum Message {
    Begins(usize, usize),
    Step(usize, usize, u32),
    Done(usize, usize, Box<Done>),
}

/// A scene that has its result.
struct Done {
    result: SceneResult,
    /// Taken from an earlier run.
    cached: bool,
    /// Under what it is to be kept; found in the journal, it needs no keeping.
    key: Option<Key>,
}

impl Done {
    fn unkept(result: SceneResult) -> Self {
        Self { result, cached: false, key: None }
    }
}

/// What jobs look up besides the plan.
struct Known {
    /// What the journal held at the start; new results are kept by the main thread.
    found: BTreeMap<Key, SceneResult>,
    /// What keys hold besides program and scene.
    words: Vec<String>,
}

impl Known {
    fn key(&self, digest: &blake3::Hash, scene: &SceneTask, called: &str) -> Key {
        // A program may behave as it is called, so its name belongs to what is graded.
        let own = [scene.name.as_str(), called];
        let words: Vec<&str> = self.words.iter().map(String::as_str).chain(own).collect();
        Key::of(digest, &scene.xml, &words)
    }

    /// An earlier result. Where traces or cards are wanted, it is none without them.
    fn find(&self, key: &Key, trace: Option<&Path>, cards: Option<Cards<'_>>) -> Option<Done> {
        let found = self.found.get(key)?;
        let lacks_trace = trace.is_some_and(|trace| !found.verdict.is_accepted() && !trace.exists());
        let lacks_card = cards.is_some_and(|cards| cards.lack(found));
        (!lacks_trace && !lacks_card).then(|| Done { result: found.clone(), cached: true, key: None })
    }
}

impl Batch<'_> {
    /// Grades all submissions; the grades come back in the same order. After a cancellation the scenes that were not run
    /// say so.
    pub fn run(
        &self,
        submissions: &[Submission],
        mut journal: Option<&mut Journal>,
        on_event: &mut dyn FnMut(Event<'_>),
    ) -> Graded {
        temporary::sweep();
        let scenes: Vec<&SceneTask> = self.plan.scenes().collect();
        let works: Vec<Work> = submissions.iter().map(|_| Work::new(scenes.len())).collect();
        let tasks = submissions.len() * scenes.len();
        let next = AtomicUsize::new(0);
        let known = Known { found: journal.as_deref().map(Journal::snapshot).unwrap_or_default(), words: self.words() };
        let (sender, receiver) = mpsc::channel();
        let mut results: Vec<Vec<Option<(SceneResult, bool)>>> =
            submissions.iter().map(|_| vec![None; scenes.len()]).collect();
        let mut grades: Vec<Option<Grade>> = submissions.iter().map(|_| None).collect();
        let mut fault = None;
        std::thread::scope(|scope| {
            for _ in 0..self.options.jobs.clamp(1, tasks.max(1)) {
                let (sender, works, next, scenes, known) = (sender.clone(), &works, &next, &scenes, &known);
                scope.spawn(move || {
                    loop {
                        let task = next.fetch_add(1, Ordering::Relaxed);
                        if task >= tasks {
                            return;
                        }
                        let place @ (submission, number) = (task / scenes.len(), task % scenes.len());
                        let (work, scene) = (&works[submission], scenes[number]);
                        let done = guarded(|| self.scene(&submissions[submission], work, scene, place, known, &sender));
                        let done = done.unwrap_or_else(|fault| {
                            let why = format!("the grader failed: {fault}; please report this");
                            let steps = scene.scene.steps();
                            Done::unkept(SceneResult::without_run(&scene.name, steps, Verdict::JudgeError, why))
                        });
                        work.note(self, number, &done.result);
                        let _ = sender.send(Message::Done(submission, number, Box::new(done)));
                    }
                });
            }
            drop(sender);
            let mut tell = |event: Event<'_>, fault: &mut Option<BatchFault>| {
                if let Err(panic) = guarded(|| on_event(event)) {
                    fault.get_or_insert(BatchFault::Telling(panic));
                }
            };
            for message in receiver {
                match message {
                    Message::Begins(submission, scene) => tell(Event::SceneBegins { submission, scene }, &mut fault),
                    Message::Step(submission, scene, step) => {
                        tell(Event::Step { submission, scene, step }, &mut fault);
                    }
                    Message::Done(submission, scene, done) => {
                        let Done { result, cached, key } = *done;
                        if let (Some(journal), Some(key)) = (journal.as_deref_mut(), key)
                            && !matches!(fault, Some(BatchFault::Journal(_)))
                            && let Err(error) = journal.keep(&key, &submissions[submission].name, &result)
                        {
                            fault = Some(error.into());
                            self.cancellation.cancel();
                        }
                        tell(Event::SceneDone { submission, scene, result: &result, cached }, &mut fault);
                        let results = &mut results[submission];
                        results[scene] = Some((result, cached));
                        if results.iter().all(Option::is_some) {
                            let results = std::mem::take(results).into_iter().flatten().collect();
                            // The copy goes away now, not when the whole batch ends.
                            let build = match works[submission].release().as_deref() {
                                Some(Ok(staged)) => staged.build.clone(),
                                _ => None,
                            };
                            let grade = self.assemble(&submissions[submission], results, build);
                            tell(Event::Graded { submission, grade: &grade }, &mut fault);
                            grades[submission] = Some(grade);
                        }
                    }
                }
            }
        });
        // Once more: what killed graders had begun may have needed a moment to end.
        temporary::sweep();
        Graded { grades: grades.into_iter().flatten().collect(), fault }
    }

    /// The result of one scene of one submission, found or made.
    fn scene(
        &self,
        submission: &Submission,
        work: &Work,
        scene: &SceneTask,
        place: (usize, usize),
        known: &Known,
        sender: &Sender<Message>,
    ) -> Done {
        let without_run =
            |verdict, why: &str| Done::unkept(SceneResult::without_run(&scene.name, scene.scene.steps(), verdict, why));
        if let Some(reason) = work.given_up(place.1) {
            return Done::unkept(reason.result(scene));
        }
        let _ = sender.send(Message::Begins(place.0, place.1));
        let trace = self.traces.map(|path| path(submission, scene));
        let trace = trace.as_deref();
        let found = work.digest(self, submission);
        let found =
            found.and_then(|digest| known.find(&known.key(&digest, scene, &submission.called()), trace, self.cards));
        if let Some(done) = found {
            return done;
        }
        match &*work.staged(self, submission) {
            Err(message) => without_run(Verdict::JudgeError, message),
            Ok(Staged { refused: Some(why), .. }) => without_run(Verdict::Unusable, why),
            Ok(staged) if staged.build.as_ref().is_some_and(|build| !build.succeeded) => {
                match self.cancellation.is_cancelled() {
                    true => without_run(Verdict::NotRun, "grading was stopped"),
                    false => without_run(Verdict::CompileError, "the sources do not build"),
                }
            }
            Ok(staged) => {
                let key = known.key(&staged.digest, scene, &called(&staged.program));
                known.find(&key, trace, self.cards).unwrap_or_else(|| {
                    let mut told = Instant::now();
                    let mut on_step = |step| {
                        // A display can't show more, and a channel should not hold more.
                        if told.elapsed() > Duration::from_millis(100) {
                            told = Instant::now();
                            let _ = sender.send(Message::Step(place.0, place.1, step));
                        }
                    };
                    let to = |scene: &SceneTask| self.traces.map(|path| path(submission, scene)).unwrap_or_default();
                    let traces: Option<&(dyn Fn(&SceneTask) -> PathBuf + Sync)> =
                        if trace.is_some() { Some(&to) } else { None };
                    let result = Runner { traces, ..self.runner() }.grade(staged, scene, &mut on_step);
                    Done { result, cached: false, key: Some(key) }
                })
            }
        }
    }

    fn runner(&self) -> Runner<'_> {
        Runner {
            backend: self.backend,
            run: &self.plan.run,
            limits: &self.plan.limits,
            rules: self.effective_rules(),
            hints: self.plan.hints,
            recorded: self.options.recorded,
            cancellation: self.cancellation,
            faults: self.faults,
            traces: None,
            cards: self.cards,
            rehearse: self.rehearse,
        }
    }

    /// Everything besides program and scene that a result depends on.
    fn words(&self) -> Vec<String> {
        let walls = self.backend.layers().iter().filter(|report| report.active);
        vec![
            walls.map(|report| report.layer.name()).collect::<Vec<_>>().join(","),
            self.effective_rules().name().to_owned(),
            self.plan.run.join("\u{1f}"),
            format!("{:?}", self.plan.limits),
            format!("{:?}", self.plan.hints),
            format!("recorded={}", self.options.recorded),
        ]
    }

    /// Against recordings there is nothing but the original's rules: the fair ones follow the submission.
    const fn effective_rules(&self) -> Rules {
        if self.options.recorded { Rules::Parity } else { self.plan.rules }
    }

    fn assemble(&self, submission: &Submission, mut results: Vec<(SceneResult, bool)>, build: Option<Build>) -> Grade {
        // What ran beside the scene that was the end does not count, or the number of jobs would.
        let known: Vec<_> = results.iter().map(|(result, _)| Some((result.verdict, result.wall))).collect();
        if let Some((end, reason)) = patience::end(&self.plan.patience, self.options.fail_fast, &known) {
            for (result, scene) in results.iter_mut().zip(self.plan.scenes()).skip(end) {
                *result = (reason.result(scene), false);
            }
        }
        let wall = results.iter().map(|(result, _)| result.wall).sum();
        let mut results = results.into_iter();
        let groups: Vec<_> = self
            .plan
            .groups
            .iter()
            .map(|group| score::group(&group.name, group.stakes, results.by_ref().take(group.scenes.len()).collect()))
            .collect();
        let refuted = self.refuted(&groups);
        let active = self.backend.layers().iter().filter(|report| report.active);
        Grade {
            submission: submission.name.clone(),
            suite: self.plan.name.clone(),
            rules: self.effective_rules(),
            verdict: groups.iter().map(|group| group.verdict).max().unwrap_or(Verdict::NotRun),
            points: groups.iter().map(|group| group.points).sum(),
            max_points: self.plan.max_points(),
            shows_output: self.plan.show_output || groups.iter().all(|group| group.visibility == Visibility::Visible),
            groups,
            build,
            warnings: self.backend.weaknesses(),
            layers: active.map(|report| report.layer.name().to_owned()).collect(),
            wall,
            refuted,
        }
    }

    /// Likely mistakes that accepted scenes speak against; the smallest of these are asked.
    fn refuted(&self, groups: &[GroupGrade]) -> Vec<String> {
        let graded = || groups.iter().flat_map(|group| &group.scenes).zip(self.plan.scenes());
        let wrong: Vec<&[Explanation]> = graded()
            .map(|(graded, _)| graded.explanations.as_slice())
            .filter(|explanations| !explanations.is_empty())
            .collect();
        if wrong.len() < 2 {
            return Vec::new();
        }
        let mut right: Vec<&Scene> = graded()
            .filter(|(graded, _)| graded.verdict == Verdict::Accepted && graded.differs.is_none())
            .map(|(_, task)| &task.scene)
            .collect();
        right.sort_by_key(|scene| u64::from(scene.steps()) * (scene.particles.len() * scene.particles.len()) as u64);
        right.truncate(WITNESSES);
        diagnose::refuted(&wrong, &right)
    }
}

#[cfg(test)]
mod tests;
