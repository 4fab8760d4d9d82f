//! Grades one submission. Every kind of grading uses this module.
//!
//! A single submission, a class and an autograder all use a `SubmissionGrading`, scene by scene. A caller with several
//! jobs distributes the scenes among them ([`batch`](super::batch)). A result is stored before it is reported. A scene
//! that has a result is not run again. If the work on a scene panics, the verdict on that scene is a judge error.
use super::{
    cancellation::Cancellation,
    cards::Cards,
    config::Hints,
    failure_cause::{FeatureIndex, Features},
    grade::Grade,
    guard::catch_panic,
    key::ResultKey,
    plan::Plan,
    program_file::ProgramFile,
    recipe::Recipe,
    result::{Failure, NotRunReason, Reason, SceneResult},
    results::{Results, StoreError},
    runner::Runner,
    skipped_scenes,
    smallest_scene::DescribeSmallest,
    staging::{self, StagedProgram},
    task::SceneTask,
    temporary_folders::Folders,
    timings::Timings,
    verdict::Verdict,
};
use fosssim_files::FilePlace;
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
    /// The name of the submission in reports.
    pub name: String,
    /// The path of the program or archive. If the plan builds submissions, the path of the folder with the sources.
    pub path: PathBuf,
    /// The name of the program or archive in the folder `path`, if the contents of that folder are not trusted. Links
    /// in it are not followed.
    pub program: Option<String>,
    /// The identity that the program's file had when submissions were searched for.
    pub file: Option<ProgramFile>,
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
    /// The maximum number of runs at the same time.
    pub jobs: usize,
    /// Whether the first scene that is not accepted ends the grading of a submission.
    pub fail_fast: bool,
    /// Whether traces are compared with recordings instead of a simulation of the reference.
    pub uses_recordings: bool,
}

/// A function that returns the file in which the trace of a submission's scene is saved.
pub type TraceFile<'a> = dyn Fn(&Submission, &SceneTask) -> FilePlace + Sync + 'a;

/// The data and settings that all submissions of a grading have in common.
#[derive(Clone, Copy)]
pub struct Grader<'a> {
    /// The plan: the scenes, the limits and the rules.
    pub plan: &'a Plan,
    /// The sandbox in which programs run.
    pub backend: &'a Backend,
    /// The name of the program in archives.
    pub program: &'a str,
    /// The options of the grading.
    pub options: Options,
    /// The folder for traces on which the grader failed. It is created when it is needed.
    pub fault_folder: &'a FilePlace,
    /// The function that names the files for traces that are not accepted; `None` if these are not saved.
    pub trace_file: Option<&'a TraceFile<'a>>,
    /// The storage of cards, if they were requested. Cards are drawn for all traces with findings.
    pub cards: Option<Cards<'a>>,
    /// The function that describes smallest scenes, if they were requested.
    pub smallest: Option<&'a DescribeSmallest<'a>>,
    /// A function that receives the grade. The job that completes a submission calls it.
    pub receive_grade: Option<&'a (dyn Fn(&Grade) + Sync + 'a)>,
    /// The sums of the processor times of all runs, for `--timings`.
    pub timings: Option<&'a Timings>,
    /// The program with whose speed submissions are compared: the original, or a program in its role. With `None`,
    /// speed is not measured.
    pub reference: Option<&'a Path>,
}

impl Grader<'_> {
    /// Returns the rules by which traces are judged. With recordings, only the original's rules can be applied, because
    /// the fair rules need a simulation from the submission's states.
    pub(super) const fn effective_rules(&self) -> Rules {
        if self.options.uses_recordings { Rules::Parity } else { self.plan.rules }
    }

    /// Returns everything that a result depends on, except for the program and the scene, as strings for its key.
    fn conditions(&self) -> Vec<String> {
        let active = self.backend.layers().iter().filter(|report| report.active);
        vec![
            active.map(|report| report.layer.name()).collect::<Vec<_>>().join(","),
            self.effective_rules().name().to_owned(),
            self.plan.command.join("\u{1f}"),
            format!("{:?}", self.plan.limits),
            format!("{:?}", self.plan.staff_hints),
            format!("recorded={}", self.options.uses_recordings),
        ]
    }
}

/// The data that all submissions of a grading share.
pub(super) struct SharedGrading<'a> {
    cancellation: &'a Cancellation,
    results: Option<&'a dyn Results>,
    folders: Folders,
    /// Everything that a result depends on, except for the program and the scene. These strings are parts of keys.
    conditions: Vec<String>,
    /// The keys of the results that this grading has stored.
    stored_keys: Mutex<BTreeSet<ResultKey>>,
    /// The keys of the results that jobs are producing. If two submissions have equal programs, the program is run
    /// once, and the other job waits for the result.
    claimed_keys: Mutex<BTreeSet<ResultKey>>,
    /// The signal that a job no longer produces the result of a key.
    key_released: Condvar,
    /// The reason why results can no longer be stored.
    pub(super) storage_error: OnceLock<StoreError>,
    /// The features of the plan's scenes. They are computed when they are first needed.
    features: OnceLock<Vec<Features>>,
    /// The copy of the reference program. It is made when a speed is first measured.
    reference: OnceLock<Arc<Result<StagedProgram, String>>>,
}

impl<'a> SharedGrading<'a> {
    pub(super) fn new(grader: &Grader<'_>, results: Option<&'a dyn Results>, cancellation: &'a Cancellation) -> Self {
        let (folders, conditions, kept, claimed) =
            (Folders::default(), grader.conditions(), Mutex::default(), Mutex::default());
        let (full, contents, reference, released) = (OnceLock::new(), OnceLock::new(), OnceLock::new(), Condvar::new());
        Self {
            cancellation,
            results,
            folders,
            conditions,
            stored_keys: kept,
            claimed_keys: claimed,
            key_released: released,
            storage_error: full,
            features: contents,
            reference,
        }
    }

    /// Returns the features of each scene, from the reference's run. A scene that cannot be simulated to its end has
    /// none.
    pub(super) fn load_features(&self, plan: &Plan) -> &[Features] {
        self.features.get_or_init(|| plan.scenes().map(|task| FeatureIndex::for_scene(&task.scene)).collect())
    }

    /// Returns the copy of the reference program, or the reason why it cannot be copied.
    pub(super) fn reference(&self, program: &Path) -> Arc<Result<StagedProgram, String>> {
        self.reference.get_or_init(|| Arc::new(staging::stage_reference(program))).clone()
    }

    pub(super) fn key(&self, digest: &blake3::Hash, scene: &SceneTask, called: &str, students: Hints) -> ResultKey {
        // A program may depend on its own name, so the name is part of the key.
        let own = [scene.name.as_str(), called, students.describe().0];
        let parts: Vec<&str> = self.conditions.iter().map(String::as_str).chain(own).collect();
        ResultKey::from_program(digest, &scene.xml, &parts)
    }

    /// Finds a stored result, or the result of an identical program in this grading. A result is not used if a
    /// requested trace or card is missing.
    fn find_result(
        &self,
        key: &ResultKey,
        trace: Option<&FilePlace>,
        cards: Option<Cards<'_>>,
        students: Hints,
    ) -> Option<FoundResult> {
        let result = self.results?.find(key)?;
        let lacks_trace = trace.is_some_and(|trace| !result.verdict.is_accepted() && !trace.is_file());
        let lacks_card = cards.is_some_and(|cards| cards.lacks_card(&result, students));
        let cached = !lock(&self.stored_keys).contains(key);
        (!lacks_trace && !lacks_card).then_some(FinishedScene { result, is_reused: cached, claim: None })
    }

    /// Waits until no other job works on a key. Then returns the result if there is one, and otherwise claims the key.
    fn claim<'s>(
        &'s self,
        key: ResultKey,
        find: impl Fn(&ResultKey) -> Option<FoundResult>,
    ) -> Result<KeyClaim<'s>, Box<FoundResult>> {
        let mut claimed = lock(&self.claimed_keys);
        // If results are not stored, there is no result for which to wait.
        while self.results.is_some() && claimed.contains(&key) {
            claimed = self.key_released.wait(claimed).unwrap_or_else(PoisonError::into_inner);
        }
        match find(&key) {
            Some(done) => Err(Box::new(done)),
            None => {
                claimed.insert(key.clone());
                Ok(KeyClaim { shared: self, key })
            }
        }
    }

    /// Stores a result. If storing fails, the grading is stopped, because further work would be lost. Errors of the
    /// grader, and scenes that were not run, are not stored, so that they are tried again.
    pub(super) fn store_result(&self, key: &ResultKey, submission: &Submission, result: &SceneResult) {
        let Some(results) = self.results else { return };
        if self.storage_error.get().is_some() || matches!(result.verdict, Verdict::JudgeError | Verdict::NotRun) {
            return;
        }
        lock(&self.stored_keys).insert(key.clone());
        let store_outcome = catch_panic(|| results.store(key, &submission.name, result));
        if let Err(error) = store_outcome.unwrap_or_else(|fault| Err(StoreError(fault.to_string()))) {
            let _ = self.storage_error.set(error);
            self.cancellation.cancel();
        }
    }
}

/// The exclusive right of a job to produce the result of a key. Other jobs that need this result wait until the claim
/// is dropped.
struct KeyClaim<'s> {
    shared: &'s SharedGrading<'s>,
    key: ResultKey,
}

impl Drop for KeyClaim<'_> {
    fn drop(&mut self) {
        lock(&self.shared.claimed_keys).remove(&self.key);
        self.shared.key_released.notify_all();
    }
}

/// A scene and its result.
struct FinishedScene<'s> {
    result: SceneResult,
    /// Whether the result was reused from an earlier grading.
    is_reused: bool,
    /// The claim under which the result is stored; `None` if the result was found.
    claim: Option<KeyClaim<'s>>,
}

/// A scene whose result was found, so that there is no claim.
type FoundResult = FinishedScene<'static>;

impl FinishedScene<'_> {
    fn without_claim(result: SceneResult) -> Self {
        Self { result, is_reused: false, claim: None }
    }
}

/// A message about the progress of a scene.
pub(super) enum SceneEvent {
    /// The run of the scene begins.
    Begins,
    /// Judging has reached this step. This is not reported for every step.
    Step(u32),
    /// The scene has its result. The value is true if it was reused from an earlier grading.
    Done(bool),
    /// The last scene is finished, and the submission has this grade.
    Graded(Box<Grade>),
}

/// A submission that is being graded. Any number of jobs may grade its scenes. The first job that needs the program
/// copies it. The copy is removed when the grade is complete.
pub(super) struct SubmissionGrading<'a> {
    pub(super) grader: &'a Grader<'a>,
    pub(super) shared: &'a SharedGrading<'a>,
    pub(super) submission: &'a Submission,
    /// The digest of the program at its original path; `None` if the program has to be built or copied first.
    digest: OnceLock<Option<blake3::Hash>>,
    pub(super) staged: Mutex<Option<Arc<Result<StagedProgram, String>>>>,
    progress: Mutex<SubmissionProgress>,
}

/// The results of a submission's scenes so far.
struct SubmissionProgress {
    /// For each finished scene, its verdict, and the time that its run and its judging took.
    finished: Vec<Option<(Verdict, Duration)>>,
    /// The first scene that is skipped, and the reason; `None` if no scene is skipped so far.
    skip_start: Option<(usize, NotRunReason)>,
    /// For each reported scene, its result, and whether the result was reused.
    reported: Vec<Option<(SceneResult, bool)>>,
    /// The number of scenes whose results are not reported yet.
    missing: usize,
}

impl<'a> SubmissionGrading<'a> {
    /// Creates the grading of a submission that has no results yet.
    pub(super) fn new(grader: &'a Grader<'a>, shared: &'a SharedGrading<'a>, submission: &'a Submission) -> Self {
        let scene_count = grader.plan.scenes().count();
        let (done, reported) = (vec![None; scene_count], vec![None; scene_count]);
        Self {
            grader,
            shared,
            submission,
            digest: OnceLock::new(),
            staged: Mutex::default(),
            progress: Mutex::new(SubmissionProgress {
                finished: done,
                skip_start: None,
                reported,
                missing: scene_count,
            }),
        }
    }

    /// Finds or produces the result of a scene, stores it, and reports it. `number` is the scene's index in the plan.
    /// After the last scene, the grade is reported as well.
    pub(super) fn grade_scene(&self, number: usize, scene: &SceneTask, tell: &mut dyn FnMut(SceneEvent)) {
        let finished_scene = catch_panic(|| self.find_or_run(number, scene, tell)).unwrap_or_else(|fault| {
            FinishedScene::without_claim(scene.failure_result(Failure::Panic {
                stage: None,
                fault: fault.to_string(),
                trace: None,
            }))
        });
        let FinishedScene { result, is_reused: cached, claim } = finished_scene;
        self.record_result(number, &result);
        if let Some(claim) = claim {
            self.shared.store_result(&claim.key, self.submission, &result);
        }
        tell(SceneEvent::Done(cached));
        let mut progress = lock(&self.progress);
        progress.reported[number] = Some((result, cached));
        progress.missing -= 1;
        if progress.missing == 0 {
            let results = std::mem::take(&mut progress.reported).into_iter().flatten().collect();
            drop(progress);
            let grade = Box::new(self.grade(results));
            if let Some(finish) = self.grader.receive_grade {
                finish(&grade);
            }
            tell(SceneEvent::Graded(grade));
        }
    }

    fn find_or_run(&self, number: usize, scene: &SceneTask, tell: &mut dyn FnMut(SceneEvent)) -> FinishedScene<'a> {
        let without_run = |verdict, reason| FinishedScene::without_claim(scene.without_run(verdict, reason));
        if let Some(reason) = self.skip_reason(number) {
            return FinishedScene::without_claim(skipped_scenes::skipped_result(scene, reason));
        }
        tell(SceneEvent::Begins);
        let (grader, shared, submission) = (self.grader, self.shared, self.submission);
        let trace = grader.trace_file.map(|path| path(submission, scene));
        let students = grader.plan.student_hints(&scene.name);
        let find = |key: &ResultKey| shared.find_result(key, trace.as_ref(), grader.cards, students);
        // If the digest is known without a copy, the result is found or claimed before anything is copied.
        let claim = self.digest().map(|digest| shared.key(&digest, scene, &submission.program_name(), students));
        let claim = match claim.map(|key| shared.claim(key, find)).transpose() {
            Ok(claim) => claim,
            Err(done) => return *done,
        };
        match &*self.staged_program() {
            Err(message) => FinishedScene::without_claim(scene.failure_result(Failure::Machine(message.clone()))),
            Ok(StagedProgram { unusable_reason: Some(reason), .. }) => {
                without_run(Verdict::Unusable, Reason::Unusable(reason.clone()))
            }
            Ok(staged) if staged.build.as_ref().is_some_and(|build| !build.end.is_success()) => {
                match shared.cancellation.is_canceled() {
                    true => without_run(Verdict::NotRun, Reason::Stopped),
                    false => without_run(Verdict::CompileError, Reason::DoesNotBuild),
                }
            }
            Ok(staged) => {
                let key = shared.key(&staged.digest, scene, &program_name(&staged.program), students);
                match claim.filter(|claim| claim.key == key).map_or_else(|| shared.claim(key, find), Ok) {
                    Err(done) => *done,
                    Ok(claim) => {
                        let result = self.run_scene(staged, scene, trace.as_ref(), tell);
                        FinishedScene { result, is_reused: false, claim: Some(claim) }
                    }
                }
            }
        }
    }

    fn run_scene(
        &self,
        staged: &StagedProgram,
        scene: &SceneTask,
        trace: Option<&FilePlace>,
        tell: &mut dyn FnMut(SceneEvent),
    ) -> SceneResult {
        let mut last_report = Instant::now();
        let mut on_step = |step| {
            // At most ten steps are reported per second, because more would only fill the channel.
            if last_report.elapsed() > Duration::from_millis(100) {
                last_report = Instant::now();
                tell(SceneEvent::Step(step));
            }
        };
        self.new_runner(scene, trace).grade(staged, scene, &mut on_step)
    }

    /// Returns a runner for a scene. If the trace is not accepted, the runner saves it in `trace`.
    pub(super) fn new_runner<'b>(&'b self, scene: &SceneTask, trace: Option<&'b FilePlace>) -> Runner<'b> {
        let grader = self.grader;
        Runner {
            backend: grader.backend,
            command: &grader.plan.command,
            limits: &grader.plan.limits,
            rules: grader.effective_rules(),
            hints: grader.plan.staff_hints,
            student_hints: grader.plan.student_hints(&scene.name),
            uses_recordings: grader.options.uses_recordings,
            folders: &self.shared.folders,
            cancellation: self.shared.cancellation,
            fault_folder: grader.fault_folder,
            trace_location: trace,
            cards: grader.cards,
            timings: grader.timings,
        }
    }

    /// Returns the reason why a scene is skipped; `None` if it is run.
    fn skip_reason(&self, scene: usize) -> Option<NotRunReason> {
        lock(&self.progress).skip_start.filter(|&(end, _)| scene >= end).map(|(_, reason)| reason)
    }

    /// Records a result, and decides whether further scenes are skipped because of it.
    fn record_result(&self, scene: usize, result: &SceneResult) {
        let mut progress = lock(&self.progress);
        progress.finished[scene] = Some((result.verdict, result.measured.wall + result.measured.judging));
        if progress.skip_start.is_none_or(|(end, _)| scene < end) {
            let end = skipped_scenes::find_first_skipped(
                &self.grader.plan.skip_limits,
                self.grader.options.fail_fast,
                &progress.finished,
            );
            progress.skip_start = end.or(progress.skip_start);
        }
    }

    /// Returns the digest of the program, if it is known without building or copying the program.
    pub(super) fn digest(&self) -> Option<blake3::Hash> {
        *self.digest.get_or_init(|| match &self.submission.program {
            _ if self.is_source_folder() => None,
            Some(program) => staging::digest_in(&self.submission.path, program, self.submission.file.as_ref()),
            None => staging::digest_file(&self.submission.path),
        })
    }

    /// Returns whether the submission consists of sources that must be built.
    fn is_source_folder(&self) -> bool {
        let Submission { path, program, .. } = self.submission;
        self.grader.plan.build.is_some() && program.is_none() && path.is_dir()
    }

    /// Returns the copy of the submission. The first job makes the copy, and other jobs wait.
    pub(super) fn staged_program(&self) -> Arc<Result<StagedProgram, String>> {
        lock(&self.staged).get_or_insert_with(|| Arc::new(self.stage())).clone()
    }

    fn stage(&self) -> Result<StagedProgram, String> {
        let Submission { path, program, file, .. } = self.submission;
        let Grader { program: name, backend, .. } = *self.grader;
        let build = self.grader.plan.build.as_ref();
        let recipe = Recipe { program: name, build, backend, cancellation: self.shared.cancellation };
        match program {
            Some(program) => recipe.stage_file_in(path, program, file.as_ref()),
            None if self.is_source_folder() => recipe.stage_folder(path),
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
