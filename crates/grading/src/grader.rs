//! Grades one submission: the unit of which everything that grades consists.
//!
//! A single submission, a class and an autograder all go through a `SubmissionGrading`, scene by scene: a caller with
//! several jobs shares the scenes out among them ([`batch`](super::batch)). A result is kept before it is reported; a
//! scene with a result is not run again. A panic in the work on one scene is a judge error of that scene.
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
    /// The program or archive, or the folder of sources when the plan builds.
    pub path: PathBuf,
    /// The name of the program or archive in the folder `path`, whose contents are not ours. Links are not followed.
    pub program: Option<String>,
    /// The identity of the program's file when submissions were searched.
    pub file: Option<OneFile>,
}

impl Submission {
    /// Returns the name of its program's file.
    fn program_name(&self) -> String {
        program_name(&self.program.as_ref().map_or_else(|| self.path.clone(), |program| self.path.join(program)))
    }
}

/// The options of a grading.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Runs at one time.
    pub jobs: usize,
    /// Whether the first scene of a submission that is not accepted ends its grading.
    pub fail_fast: bool,
    /// Whether traces are judged against the recordings instead of the reference simulator.
    pub recorded: bool,
}

/// The place for the trace of a submission's scene.
pub type TraceFile<'a> = dyn Fn(&Submission, &SceneTask) -> Place + Sync + 'a;

/// The parts that the submissions of one grading share.
#[derive(Clone, Copy)]
pub struct Grader<'a> {
    /// The plan: scenes, limits and rules.
    pub plan: &'a Plan,
    /// The sandbox in which programs run.
    pub backend: &'a Backend,
    /// The program's name in archives.
    pub program: &'a str,
    /// How.
    pub options: Options,
    /// The folder for traces on which the grader itself failed; made when it is needed.
    pub faults: &'a Place,
    /// The place for the trace of a scene that is not accepted, on request.
    pub traces: Option<&'a TraceFile<'a>>,
    /// Draws and keeps cards of traces that are not simply right, on request.
    pub cards: Option<Cards<'a>>,
    /// Describes the smallest scenes, on request.
    pub smallest: Option<&'a DescribeSmallest<'a>>,
    /// Completes a grade, on the job that has made it.
    pub finish: Option<&'a (dyn Fn(&Grade) + Sync + 'a)>,
    /// Adds up the processor time of all runs, for `--timings`.
    pub timings: Option<&'a Timings>,
    /// The program whose speed is the measure: the original, or a program that plays it under its name. Without one no
    /// speed is measured.
    pub reference: Option<&'a Path>,
}

impl Grader<'_> {
    /// Returns the rules that count. Against recordings these are the original's: the fair ones follow the submission.
    pub(super) const fn effective_rules(&self) -> Rules {
        if self.options.recorded { Rules::Parity } else { self.plan.rules }
    }

    /// Returns everything besides program and scene that a result depends on.
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

/// The values that the submissions of one grading share.
pub(super) struct SharedGrading<'a> {
    cancellation: &'a Cancellation,
    results: Option<&'a dyn Results>,
    folders: Folders,
    /// The parts of keys besides program and scene.
    words: Vec<String>,
    /// The results that this very grading has kept.
    kept: Mutex<BTreeSet<Key>>,
    /// The results at which jobs are at work. Equal programs of two submissions are run once: a job waits for the
    /// other's result.
    claimed: Mutex<BTreeSet<Key>>,
    /// Rings when a job has given a claim back.
    released: Condvar,
    /// The reason why results can't be kept any more.
    pub(super) full: OnceLock<KeepError>,
    /// The contents of the plan's scenes, once they are needed.
    contents: OnceLock<Vec<Contents>>,
    /// The copy of the reference program, once something is timed.
    reference: OnceLock<Arc<Result<StagedProgram, String>>>,
}

impl<'a> SharedGrading<'a> {
    pub(super) fn new(grader: &Grader<'_>, results: Option<&'a dyn Results>, cancellation: &'a Cancellation) -> Self {
        let (folders, words, kept, claimed) =
            (Folders::default(), grader.conditions(), Mutex::default(), Mutex::default());
        let (full, contents, reference, released) = (OnceLock::new(), OnceLock::new(), OnceLock::new(), Condvar::new());
        Self { cancellation, results, folders, words, kept, claimed, released, full, contents, reference }
    }

    /// Returns the contents of the reference's run of each scene. A scene without an end has none.
    pub(super) fn contents(&self, plan: &Plan) -> &[Contents] {
        self.contents.get_or_init(|| plan.scenes().map(|task| ContentIndex::for_scene(&task.scene)).collect())
    }

    /// Returns the copy of the reference program.
    pub(super) fn reference(&self, program: &Path) -> Arc<Result<StagedProgram, String>> {
        self.reference.get_or_init(|| Arc::new(staging::reference(program))).clone()
    }

    pub(super) fn key(&self, digest: &blake3::Hash, scene: &SceneTask, called: &str, students: Hints) -> Key {
        // A program may depend on its own name, so the name belongs to what is graded.
        let own = [scene.name.as_str(), called, students.describe().0];
        let words: Vec<&str> = self.words.iter().map(String::as_str).chain(own).collect();
        Key::from_program(digest, &scene.xml, &words)
    }

    /// Finds an earlier result, or that of an equal program in this grading. If traces or cards are wanted, a result
    /// without them does not count.
    fn find(&self, key: &Key, trace: Option<&Place>, cards: Option<Cards<'_>>, students: Hints) -> Option<FoundResult> {
        let result = self.results?.find(key)?;
        let lacks_trace = trace.is_some_and(|trace| !result.verdict.is_accepted() && !trace.is_file());
        let lacks_card = cards.is_some_and(|cards| cards.lack(&result, students));
        let cached = !lock(&self.kept).contains(key);
        (!lacks_trace && !lacks_card).then_some(FinishedScene { result, cached, claim: None })
    }

    /// Claims the key of a result, once no other job is at work on it; the result, if there is one then.
    fn claim<'s>(
        &'s self,
        key: Key,
        find: impl Fn(&Key) -> Option<FoundResult>,
    ) -> Result<KeyClaim<'s>, Box<FoundResult>> {
        let mut claimed = lock(&self.claimed);
        // If nothing is kept there is no result to wait for.
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

    /// Keeps a result. When that fails, grading is stopped: what can't be kept would be done in vain. Faults of ours
    /// and scenes that were not run are tried again instead.
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

/// The right of one job to make the result of a key. Others that need it wait until this is dropped.
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

/// A scene that has its result.
struct FinishedScene<'s> {
    result: SceneResult,
    /// Taken from an earlier run.
    cached: bool,
    /// The claim under which the result is kept; a result that was found needs none.
    claim: Option<KeyClaim<'s>>,
}

/// A result that was found, which needs no claim.
type FoundResult = FinishedScene<'static>;

impl FinishedScene<'_> {
    fn unkept(result: SceneResult) -> Self {
        Self { result, cached: false, claim: None }
    }
}

/// The news of a scene.
pub(super) enum SceneNews {
    /// The scene begins.
    Begins,
    /// Steps have been judged up to this one; not every step is reported.
    Step(u32),
    /// The scene has its result, and whether that was taken from an earlier run.
    Done(bool),
    /// The submission has its grade, with its last scene.
    Graded(Box<Grade>),
}

/// One submission at work. Any number of jobs may take its scenes: it is staged once, by the first job that has to run
/// it, and its copy stays until the grade is drawn.
pub(super) struct SubmissionGrading<'a> {
    pub(super) grader: &'a Grader<'a>,
    pub(super) shared: &'a SharedGrading<'a>,
    pub(super) submission: &'a Submission,
    /// The digest of the program in its place; `None` if it has to be built or copied first.
    digest: OnceLock<Option<blake3::Hash>>,
    pub(super) staged: Mutex<Option<Arc<Result<StagedProgram, String>>>>,
    known: Mutex<SubmissionProgress>,
}

/// The results of a submission's scenes so far.
struct SubmissionProgress {
    /// Verdict of every scene that is done, and how long its run and judging it took.
    done: Vec<Option<(Verdict, Duration)>>,
    /// The first scene that is not run any more, and why.
    end: Option<(usize, NotRunReason)>,
    /// The reported results, each with whether it was found.
    told: Vec<Option<(SceneResult, bool)>>,
    /// The number of results that are still missing there.
    missing: usize,
}

impl<'a> SubmissionGrading<'a> {
    /// Creates a submission of which nothing is known yet.
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

    /// Finds or makes the result of a scene, by its number in the plan, keeps it, and reports it; after the last one,
    /// also the grade.
    pub(super) fn grade_scene(&self, number: usize, scene: &SceneTask, tell: &mut dyn FnMut(SceneNews)) {
        let done = catch_panic(|| self.find_or_run(number, scene, tell)).unwrap_or_else(|fault| {
            FinishedScene::unkept(scene.failure_result(Failure::Panic {
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
        let without_run = |verdict, why| FinishedScene::unkept(scene.without_run(verdict, why));
        if let Some(why) = self.left_out(number) {
            return FinishedScene::unkept(patience::left_out(scene, why));
        }
        tell(SceneNews::Begins);
        let (grader, shared, submission) = (self.grader, self.shared, self.submission);
        let trace = grader.traces.map(|path| path(submission, scene));
        let students = grader.plan.student_hints(&scene.name);
        let find = |key: &Key| shared.find(key, trace.as_ref(), grader.cards, students);
        // Found or claimed before anything is copied, if the program is known in its place.
        let known = self.digest().map(|digest| shared.key(&digest, scene, &submission.program_name(), students));
        let known = match known.map(|key| shared.claim(key, find)).transpose() {
            Ok(claim) => claim,
            Err(done) => return *done,
        };
        match &*self.staged_program() {
            Err(message) => FinishedScene::unkept(scene.failure_result(Failure::Machine(message.clone()))),
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
            // A display can't show more, and a channel should not hold more.
            if told.elapsed() > Duration::from_millis(100) {
                told = Instant::now();
                tell(SceneNews::Step(step));
            }
        };
        self.runner(scene, trace).grade(staged, scene, &mut on_step)
    }

    /// Returns a runner of programs on a scene, which stores a trace that is not accepted in `trace`.
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

    /// Returns why this scene is not to be run.
    fn left_out(&self, scene: usize) -> Option<NotRunReason> {
        lock(&self.known).end.filter(|&(end, _)| scene >= end).map(|(_, why)| why)
    }

    /// Notes a result, and whether it is the end.
    fn note(&self, scene: usize, result: &SceneResult) {
        let mut known = lock(&self.known);
        known.done[scene] = Some((result.verdict, result.measured.wall + result.measured.judging));
        if known.end.is_none_or(|(end, _)| scene < end) {
            let end = patience::end(&self.grader.plan.patience, self.grader.options.fail_fast, &known.done);
            known.end = end.or(known.end);
        }
    }

    /// Returns the digest of a program that needs no build and no copy to be known.
    pub(super) fn digest(&self) -> Option<blake3::Hash> {
        *self.digest.get_or_init(|| match &self.submission.program {
            _ if self.builds() => None,
            Some(program) => staging::digest_in(&self.submission.path, program, self.submission.file.as_ref()),
            None => staging::digest(&self.submission.path),
        })
    }

    /// Returns whether it is a folder of sources.
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
            None if self.builds() => recipe.folder(path),
            None => recipe.file(path),
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
