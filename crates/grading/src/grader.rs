//! Grades one submission; every kind of grading uses this module.
//!
//! A single submission, a class and an autograder all go through a `SubmissionGrading`, scene by scene. A caller with
//! several jobs distributes the scenes among them ([`batch`](super::batch)). A result is stored before it is reported;
//! a scene with a result is not run again. A panic in the work on one scene is a judge error of that scene.
use super::{
    cancellation::Cancellation,
    cards::Cards,
    config::Hints,
    execute::Runner,
    grade::Grade,
    guard::catch_panic,
    key::Key,
    located::{ContentIndex, Contents},
    one_file::OneFile,
    patience,
    plan::Plan,
    recipe::Recipe,
    result::{Failure, NotRunReason, Reason, SceneResult},
    results::{KeepError, Results},
    smallest::DescribeSmallest,
    staging::{self, StagedProgram},
    task::SceneTask,
    temporary::Folders,
    timings::Timings,
    verdict::Verdict,
};
use fosssim_files::Place;
use fosssim_judge::Rules;
use fosssim_sandbox::Backend;
use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
    sync::{Arc, Condvar, Mutex, MutexGuard, OnceLock, PoisonError},
    time::{Duration, Instant},
};

/// A submission to grade.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Submission {
    /// The submission's name in reports.
    pub name: String,
    /// The path of the program or archive, or of the folder of sources if the plan builds.
    pub path: PathBuf,
    /// The name of the program or archive in the folder `path`, if the folder's contents are not trusted. Links are not
    /// followed.
    pub program: Option<String>,
    /// The identity of the program's file at the time of the search for submissions.
    pub file: Option<OneFile>,
}

impl Submission {
    /// Returns the name of the program's file.
    fn program_name(&self) -> String {
        program_name(&self.program.as_ref().map_or_else(|| self.path.clone(), |program| self.path.join(program)))
    }
}

/// The options of a grading.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// The maximum number of parallel runs.
    pub jobs: usize,
    /// Whether the first scene that is not accepted ends the grading of a submission.
    pub fail_fast: bool,
    /// Whether traces are judged against the recordings instead of the reference simulator.
    pub recorded: bool,
}

/// A function that returns the file to which the trace of a submission's scene is saved.
pub type TraceFile<'a> = dyn Fn(&Submission, &SceneTask) -> Place + Sync + 'a;

/// The parts that all submissions of a grading share.
#[derive(Clone, Copy)]
pub struct Grader<'a> {
    /// The plan: scenes, limits and rules.
    pub plan: &'a Plan,
    /// The sandbox in which programs run.
    pub backend: &'a Backend,
    /// The program's name in archives.
    pub program: &'a str,
    /// The options of the grading.
    pub options: Options,
    /// The folder for traces on which the grader failed; created when it is needed.
    pub faults: &'a Place,
    /// The function that names the files for traces that are not accepted, if requested.
    pub traces: Option<&'a TraceFile<'a>>,
    /// The storage of cards, which are drawn for all traces with findings, if requested.
    pub cards: Option<Cards<'a>>,
    /// The function that describes the smallest scenes, if requested.
    pub smallest: Option<&'a DescribeSmallest<'a>>,
    /// A function that the job with a submission's last result calls with the grade.
    pub finish: Option<&'a (dyn Fn(&Grade) + Sync + 'a)>,
    /// The sums of all runs' processor times, for `--timings`.
    pub timings: Option<&'a Timings>,
    /// The program with which speed is compared: the original, or a program in its role. Without it, speed is not
    /// measured.
    pub reference: Option<&'a Path>,
}

impl Grader<'_> {
    /// Returns the rules that are used. With recordings these are the original's, because the fair rules need a
    /// simulation from the submission's states.
    pub(super) const fn effective_rules(&self) -> Rules {
        if self.options.recorded { Rules::Parity } else { self.plan.rules }
    }

    /// Returns everything that a result depends on, except for program and scene.
    fn conditions(&self) -> Vec<String> {
        let walls = self.backend.layers().iter().filter(|report| report.active);
        vec![
            walls.map(|report| report.layer.name()).collect::<Vec<_>>().join(","),
            self.effective_rules().name().to_owned(),
            self.plan.run.join("\u{1f}"),
            format!("{:?}", self.plan.limits),
            format!("{:?}", self.plan.staff_hints),
            format!("recorded={}", self.options.recorded),
        ]
    }
}

/// The data that all submissions of a grading share.
pub(super) struct SharedGrading<'a> {
    cancellation: &'a Cancellation,
    results: Option<&'a dyn Results>,
    folders: Folders,
    /// The parts of keys that do not depend on program and scene.
    words: Vec<String>,
    /// The results that this grading has stored.
    kept: Mutex<BTreeSet<Key>>,
    /// The results that jobs are making. Equal programs of two submissions are run once: a job waits for the other's
    /// result.
    claimed: Mutex<BTreeSet<Key>>,
    /// The signal that a job has released a claim.
    released: Condvar,
    /// The reason why results can no longer be stored.
    pub(super) full: OnceLock<KeepError>,
    /// The contents of the plan's scenes, computed when they are needed.
    contents: OnceLock<Vec<Contents>>,
    /// The copy of the reference program, made for the first timing.
    reference: OnceLock<Arc<Result<StagedProgram, String>>>,
}

impl<'a> SharedGrading<'a> {
    pub(super) fn new(grader: &Grader<'_>, results: Option<&'a dyn Results>, cancellation: &'a Cancellation) -> Self {
        let (folders, words, kept, claimed) =
            (Folders::default(), grader.conditions(), Mutex::default(), Mutex::default());
        let (full, contents, reference, released) = (OnceLock::new(), OnceLock::new(), OnceLock::new(), Condvar::new());
        Self { cancellation, results, folders, words, kept, claimed, released, full, contents, reference }
    }

    /// Returns the contents of the reference's run of each scene; empty for a scene that cannot be simulated to its
    /// end.
    pub(super) fn contents(&self, plan: &Plan) -> &[Contents] {
        self.contents.get_or_init(|| plan.scenes().map(|task| ContentIndex::for_scene(&task.scene)).collect())
    }

    /// Returns the copy of the reference program.
    pub(super) fn reference(&self, program: &Path) -> Arc<Result<StagedProgram, String>> {
        self.reference.get_or_init(|| Arc::new(staging::reference(program))).clone()
    }

    pub(super) fn key(&self, digest: &blake3::Hash, scene: &SceneTask, called: &str, students: Hints) -> Key {
        // A program may depend on its own name, so the name is part of the key.
        let own = [scene.name.as_str(), called, students.describe().0];
        let words: Vec<&str> = self.words.iter().map(String::as_str).chain(own).collect();
        Key::from_program(digest, &scene.xml, &words)
    }

    /// Finds a stored result, or the result of an identical program in this grading. A result without requested traces
    /// or cards does not count.
    fn find(&self, key: &Key, trace: Option<&Place>, cards: Option<Cards<'_>>, students: Hints) -> Option<FoundResult> {
        let result = self.results?.find(key)?;
        let lacks_trace = trace.is_some_and(|trace| !result.verdict.is_accepted() && !trace.is_file());
        let lacks_card = cards.is_some_and(|cards| cards.lacks_card(&result, students));
        let cached = !lock(&self.kept).contains(key);
        (!lacks_trace && !lacks_card).then_some(FinishedScene { result, cached, claim: None })
    }

    /// Waits until no other job works on a key. Then returns its result, if there is one, or claims the key.
    fn claim<'s>(
        &'s self,
        key: Key,
        find: impl Fn(&Key) -> Option<FoundResult>,
    ) -> Result<KeyClaim<'s>, Box<FoundResult>> {
        let mut claimed = lock(&self.claimed);
        // If results are not stored, there is no result to wait for.
        while self.results.is_some() && claimed.contains(&key) {
            claimed = self.released.wait(claimed).unwrap_or_else(PoisonError::into_inner);
        }
        match find(&key) {
            Some(done) => Err(Box::new(done)),
            None => {
                claimed.insert(key.clone());
                Ok(KeyClaim { shared: self, key })
            }
        }
    }

    /// Stores a result. If that fails, grading is stopped, because further work would be lost. Errors of the grader and
    /// scenes that were not run are not stored, so they are tried again.
    pub(super) fn keep(&self, key: &Key, submission: &Submission, result: &SceneResult) {
        let Some(results) = self.results else { return };
        if self.full.get().is_some() || matches!(result.verdict, Verdict::JudgeError | Verdict::NotRun) {
            return;
        }
        lock(&self.kept).insert(key.clone());
        let kept = catch_panic(|| results.keep(key, &submission.name, result));
        if let Err(error) = kept.unwrap_or_else(|fault| Err(KeepError(fault.to_string()))) {
            let _ = self.full.set(error);
            self.cancellation.cancel();
        }
    }
}

/// The exclusive right of a job to make the result of a key. Other jobs that need the result wait until the claim is
/// dropped.
struct KeyClaim<'s> {
    shared: &'s SharedGrading<'s>,
    key: Key,
}

impl Drop for KeyClaim<'_> {
    fn drop(&mut self) {
        lock(&self.shared.claimed).remove(&self.key);
        self.shared.released.notify_all();
    }
}

/// A scene with its result.
struct FinishedScene<'s> {
    result: SceneResult,
    /// Whether the result was reused from an earlier run.
    cached: bool,
    /// The claim for storing the result; `None` for a result that was found, not made.
    claim: Option<KeyClaim<'s>>,
}

/// A result that was found, without a claim.
type FoundResult = FinishedScene<'static>;

impl FinishedScene<'_> {
    fn without_claim(result: SceneResult) -> Self {
        Self { result, cached: false, claim: None }
    }
}

/// A progress message about a scene.
pub(super) enum SceneNews {
    /// The run of the scene begins.
    Begins,
    /// Judging has reached a step; not every step is reported.
    Step(u32),
    /// The scene has its result. The value tells whether the result was reused from an earlier run.
    Done(bool),
    /// The submission has its grade, after its last scene.
    Graded(Box<Grade>),
}

/// A submission while it is graded. Any number of jobs may process its scenes. The first job that needs the program
/// stages it; the copy is removed when the grade is complete.
pub(super) struct SubmissionGrading<'a> {
    pub(super) grader: &'a Grader<'a>,
    pub(super) shared: &'a SharedGrading<'a>,
    pub(super) submission: &'a Submission,
    /// The digest of the program at its original path; `None` if it has to be built or copied first.
    digest: OnceLock<Option<blake3::Hash>>,
    pub(super) staged: Mutex<Option<Arc<Result<StagedProgram, String>>>>,
    known: Mutex<SubmissionProgress>,
}

/// The results of a submission's scenes so far.
struct SubmissionProgress {
    /// The verdict of every finished scene, with the time of its run and its judging.
    done: Vec<Option<(Verdict, Duration)>>,
    /// The first scene that is skipped, with the reason.
    end: Option<(usize, NotRunReason)>,
    /// The reported results, each with whether it was reused.
    told: Vec<Option<(SceneResult, bool)>>,
    /// The number of results that are still missing in `told`.
    missing: usize,
}

impl<'a> SubmissionGrading<'a> {
    /// Creates a submission without results.
    pub(super) fn new(grader: &'a Grader<'a>, shared: &'a SharedGrading<'a>, submission: &'a Submission) -> Self {
        let missing = grader.plan.scenes().count();
        let (done, told) = (vec![None; missing], vec![None; missing]);
        Self {
            grader,
            shared,
            submission,
            digest: OnceLock::new(),
            staged: Mutex::default(),
            known: Mutex::new(SubmissionProgress { done, end: None, told, missing }),
        }
    }

    /// Finds or makes the result of a scene, by its number in the plan, stores it, and reports it. After the last
    /// scene, it also reports the grade.
    pub(super) fn grade_scene(&self, number: usize, scene: &SceneTask, tell: &mut dyn FnMut(SceneNews)) {
        let done = catch_panic(|| self.find_or_run(number, scene, tell)).unwrap_or_else(|fault| {
            FinishedScene::without_claim(scene.failure_result(Failure::Panic {
                stage: None,
                fault: fault.to_string(),
                trace: None,
            }))
        });
        let FinishedScene { result, cached, claim } = done;
        self.note(number, &result);
        if let Some(claim) = claim {
            self.shared.keep(&claim.key, self.submission, &result);
        }
        tell(SceneNews::Done(cached));
        let mut known = lock(&self.known);
        known.told[number] = Some((result, cached));
        known.missing -= 1;
        if known.missing == 0 {
            let results = std::mem::take(&mut known.told).into_iter().flatten().collect();
            drop(known);
            let grade = Box::new(self.grade(results));
            if let Some(finish) = self.grader.finish {
                finish(&grade);
            }
            tell(SceneNews::Graded(grade));
        }
    }

    fn find_or_run(&self, number: usize, scene: &SceneTask, tell: &mut dyn FnMut(SceneNews)) -> FinishedScene<'a> {
        let without_run = |verdict, why| FinishedScene::without_claim(scene.without_run(verdict, why));
        if let Some(why) = self.left_out(number) {
            return FinishedScene::without_claim(patience::left_out(scene, why));
        }
        tell(SceneNews::Begins);
        let (grader, shared, submission) = (self.grader, self.shared, self.submission);
        let trace = grader.traces.map(|path| path(submission, scene));
        let students = grader.plan.student_hints(&scene.name);
        let find = |key: &Key| shared.find(key, trace.as_ref(), grader.cards, students);
        // If the digest is known without a copy, the result is found or claimed before anything is copied.
        let known = self.digest().map(|digest| shared.key(&digest, scene, &submission.program_name(), students));
        let known = match known.map(|key| shared.claim(key, find)).transpose() {
            Ok(claim) => claim,
            Err(done) => return *done,
        };
        match &*self.staged_program() {
            Err(message) => FinishedScene::without_claim(scene.failure_result(Failure::Machine(message.clone()))),
            Ok(StagedProgram { refused: Some(why), .. }) => {
                without_run(Verdict::Unusable, Reason::Unusable(why.clone()))
            }
            Ok(staged) if staged.build.as_ref().is_some_and(|build| !build.end.is_success()) => {
                match shared.cancellation.is_cancelled() {
                    true => without_run(Verdict::NotRun, Reason::Stopped),
                    false => without_run(Verdict::CompileError, Reason::DoesNotBuild),
                }
            }
            Ok(staged) => {
                let key = shared.key(&staged.digest, scene, &program_name(&staged.program), students);
                match known.filter(|claim| claim.key == key).map_or_else(|| shared.claim(key, find), Ok) {
                    Err(done) => *done,
                    Ok(claim) => {
                        let result = self.run(staged, scene, trace.as_ref(), tell);
                        FinishedScene { result, cached: false, claim: Some(claim) }
                    }
                }
            }
        }
    }

    fn run(
        &self,
        staged: &StagedProgram,
        scene: &SceneTask,
        trace: Option<&Place>,
        tell: &mut dyn FnMut(SceneNews),
    ) -> SceneResult {
        let mut told = Instant::now();
        let mut on_step = |step| {
            // Report at most ten steps per second: more would only fill the channel.
            if told.elapsed() > Duration::from_millis(100) {
                told = Instant::now();
                tell(SceneNews::Step(step));
            }
        };
        self.runner(scene, trace).grade(staged, scene, &mut on_step)
    }

    /// Returns a runner for a scene, which saves a trace that is not accepted to `trace`.
    pub(super) fn runner<'b>(&'b self, scene: &SceneTask, trace: Option<&'b Place>) -> Runner<'b> {
        let grader = self.grader;
        Runner {
            backend: grader.backend,
            run: &grader.plan.run,
            limits: &grader.plan.limits,
            rules: grader.effective_rules(),
            hints: grader.plan.staff_hints,
            student_hints: grader.plan.student_hints(&scene.name),
            recorded: grader.options.recorded,
            folders: &self.shared.folders,
            cancellation: self.shared.cancellation,
            faults: grader.faults,
            trace,
            cards: grader.cards,
            timings: grader.timings,
        }
    }

    /// Returns the reason why a scene is skipped; `None` if it is run.
    fn left_out(&self, scene: usize) -> Option<NotRunReason> {
        lock(&self.known).end.filter(|&(end, _)| scene >= end).map(|(_, why)| why)
    }

    /// Records a result, and whether it ends the grading.
    fn note(&self, scene: usize, result: &SceneResult) {
        let mut known = lock(&self.known);
        known.done[scene] = Some((result.verdict, result.measured.wall + result.measured.judging));
        if known.end.is_none_or(|(end, _)| scene < end) {
            let end = patience::find_end(&self.grader.plan.patience, self.grader.options.fail_fast, &known.done);
            known.end = end.or(known.end);
        }
    }

    /// Returns the digest of a program, if it is known without a build or a copy.
    pub(super) fn digest(&self) -> Option<blake3::Hash> {
        *self.digest.get_or_init(|| match &self.submission.program {
            _ if self.builds() => None,
            Some(program) => staging::digest_in(&self.submission.path, program, self.submission.file.as_ref()),
            None => staging::digest(&self.submission.path),
        })
    }

    /// Returns whether the submission is a folder of sources that must be built.
    fn builds(&self) -> bool {
        let Submission { path, program, .. } = self.submission;
        self.grader.plan.build.is_some() && program.is_none() && path.is_dir()
    }

    /// Returns the staged submission; the first job stages it, the others wait.
    pub(super) fn staged_program(&self) -> Arc<Result<StagedProgram, String>> {
        lock(&self.staged).get_or_insert_with(|| Arc::new(self.stage())).clone()
    }

    fn stage(&self) -> Result<StagedProgram, String> {
        let Submission { path, program, file, .. } = self.submission;
        let Grader { program: name, backend, .. } = *self.grader;
        let build = self.grader.plan.build.as_ref();
        let recipe = Recipe { program: name, build, backend, cancellation: self.shared.cancellation };
        match program {
            Some(program) => recipe.file_in(path, program, file.as_ref()),
            None if self.builds() => recipe.stage_folder(path),
            None => recipe.stage_file(path),
        }
    }
}

pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the name of a program's file.
pub(super) fn program_name(program: &Path) -> String {
    program.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests;
