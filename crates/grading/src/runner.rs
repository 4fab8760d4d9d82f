//! Runs a program on a scene in the sandbox, and judges the trace that it writes.
use super::{
    cancellation::Cancellation,
    cards::{Cards, JudgedTrace},
    conclusion::{JudgedRun, ProgramRun, SearchDepth, conclude},
    config::{Hints, RunLimits},
    failed_scene,
    guard::{CaughtPanic, catch_panic},
    result::{Activity, Failure, Reason, SceneResult},
    staging::StagedProgram,
    task::SceneTask,
    temporary_folders::{Folders, TemporaryFolder},
    timings::{RunPart, Stopwatch, Timings},
    verdict::Verdict,
};
use fosssim_evidence::StepRulings;
use fosssim_files::FilePlace;
use fosssim_judge::{
    Outcome, Rules,
    kept_trace::{KeptTrace, MAX_KEPT_BYTES},
    recording,
    replay::{self, ObserverPair, Options, Progress, Remark},
};
use fosssim_sandbox::{
    self as sandbox, Backend, Job, Limits, Policy, ProgramIdentity, RemainingFolder, RunningProgram,
    collect::CollectError,
};
use std::{
    io::{self, Read},
    path::Path,
    time::Instant,
};

/// The name of the scene's copy in the working folder.
const SCENE_FILE: &str = "scene.xml";
const TRACE_FILE: &str = "trace.bin";

/// The number of attempts after which an error of the grader or the machine is reported.
const MAX_ATTEMPTS: u32 = 2;

/// Runs programs on scenes, with these settings.
#[derive(Clone, Copy)]
pub struct Runner<'a> {
    /// The sandbox in which programs run.
    pub backend: &'a Backend,
    /// The command line of programs. `{program}`, `{scene}` and `{trace}` in it are replaced.
    pub command: &'a [String],
    /// The limits that apply to each run.
    pub limits: &'a RunLimits,
    /// The rule books by which traces are judged.
    pub rules: Rules,
    /// The level of detail for staff. Results contain no more than this.
    pub hints: Hints,
    /// The level of detail for students about the scene.
    pub student_hints: Hints,
    /// Whether traces are compared with recordings instead of a simulation of the reference.
    pub uses_recordings: bool,
    /// The source of working folders in which programs run.
    pub folders: &'a Folders,
    /// The switch that stops all runs.
    pub cancellation: &'a Cancellation,
    /// The folder for traces on which the grader failed. It is created when it is needed.
    pub fault_folder: &'a FilePlace,
    /// The file in which a trace is saved if it is not accepted; `None` if this was not requested.
    pub trace_location: Option<&'a FilePlace>,
    /// The storage of cards, if they were requested. Cards are drawn for all traces with findings.
    pub cards: Option<Cards<'a>>,
    /// The sums of the processor times of all runs, for `--timings`.
    pub timings: Option<&'a Timings>,
}

impl Runner<'_> {
    /// Runs `program` on a scene in a new working folder, which is removed afterwards, and judges the trace. After an
    /// error of the grader or the machine, the program is run once more. If there is a second error, the verdict is a
    /// judge error. `on_step` receives the number of every judged step.
    pub fn grade(&self, program: &StagedProgram, task: &SceneTask, on_step: &mut dyn FnMut(u32)) -> SceneResult {
        let mut attempt = 1;
        loop {
            if self.cancellation.is_canceled() {
                return task.without_run(Verdict::NotRun, Reason::Stopped);
            }
            match self.grade_once(program, task, on_step) {
                Ok(result) => return result,
                Err(_) if attempt < MAX_ATTEMPTS => attempt += 1,
                Err(error) => return task.failure_result(Failure::Machine(error)),
            }
        }
    }

    fn grade_once(
        &self,
        program: &StagedProgram,
        task: &SceneTask,
        on_step: &mut dyn FnMut(u32),
    ) -> Result<SceneResult, String> {
        let begin = Instant::now();
        let mut watch = Stopwatch::new(self.timings);
        let (running, folder) = self.start(&program.program, program.identity, task)?;
        let is_untouched = running.is_in_memory();
        let registered = self.cancellation.register(running.canceler());
        let (outcome, left) = running.wait_with_folder().map_err(|error| error.to_string())?;
        drop(registered);
        if let Some(timings) = self.timings {
            timings.add(RunPart::Program, outcome.cpu);
        }
        watch.end_part(RunPart::Start);
        let (trace, trace_bytes) = self.open_trace(&left)?;
        // The trace is kept outside of the code that judges it. If that code panics, the trace can still be saved for
        // developers.
        let mut kept_trace = KeptTrace::new(MAX_KEPT_BYTES);
        let mut rulings = StepRulings::default();
        let mut reporter = StepReporter(on_step);
        let observer = &mut ObserverPair(&mut rulings, &mut reporter);
        let judge_result = self.judge_trace(program, task, &mut kept_trace, trace, observer);
        watch.end_part(RunPart::Judging);
        drop(left);
        match is_untouched {
            true => self.folders.keep_folder(folder),
            false => drop(folder),
        }
        watch.end_part(RunPart::CleanUp);
        let failed =
            |stage, fault: &_| failed_scene::fault_result(task, self.fault_folder, stage, fault, kept_trace.bytes());
        let judge_result = match judge_result {
            Ok(judge_result) => judge_result?,
            Err(fault) => return Ok(failed(Activity::Judging, &fault)),
        };
        let run = JudgedRun {
            task,
            program: &ProgramRun::from(&outcome),
            outcome: &judge_result,
            trace_bytes,
            rules: self.rules,
            hints: self.hints,
            limits: self.limits,
        };
        let mut result = match explain_run(&run, &kept_trace, &program.program) {
            Ok(result) => result,
            Err((activity, fault)) => return Ok(failed(activity, &fault)),
        };
        watch.end_part(RunPart::Explaining);
        result.measured.judging = begin.elapsed().saturating_sub(result.measured.wall);
        if let Some(cards) = self.cards
            && !kept_trace.bytes().is_empty()
            && !(result.verdict.is_accepted() && result.difference_cause.is_none())
        {
            let judge_result = JudgedTrace {
                scene: &task.scene,
                name: &task.address(),
                explanations: &result.explanations,
                outcome: &judge_result,
                rulings: &rulings.into_steps(&judge_result),
                trace: kept_trace.bytes(),
                is_cut: trace_bytes > kept_trace.bytes().len() as u64,
                rules: self.rules,
                hints: self.hints,
            };
            let drawn = catch_panic(|| cards.store_cards(&judge_result, self.student_hints));
            (result.card, result.card_for_students) = match drawn {
                Ok(names) => names.map_err(|error| format!("the data of a page can't be stored: {error}"))?,
                Err(fault) => return Ok(failed(Activity::Drawing, &fault)),
            };
        }
        if let Some(location) = self.trace_location.filter(|_| !result.verdict.is_accepted()) {
            location.write(kept_trace.bytes()).map_err(|error| format!("the trace can't be stored: {error}"))?;
        }
        watch.end_part(RunPart::Drawing);
        Ok(result)
    }

    /// Runs `program` on a scene as in a grading, but does not judge its trace. Returns at most `keep` bytes of the
    /// trace.
    ///
    /// # Errors
    ///
    /// Fails if the grader or the machine fails. The error is the reason, as text.
    pub fn collect_trace(
        &self,
        program: &Path,
        task: &SceneTask,
        keep: usize,
    ) -> Result<(Vec<u8>, sandbox::RunOutcome), String> {
        let (running, _folder) = self.start(program, None, task)?;
        let _registered = self.cancellation.register(running.canceler());
        let (outcome, left) = running.wait_with_folder().map_err(|error| error.to_string())?;
        let mut kept = Vec::new();
        let (trace, _) = self.open_trace(&left)?;
        trace.take(keep as u64).read_to_end(&mut kept).map_err(|error| format!("the trace can't be read: {error}"))?;
        Ok((kept, outcome))
    }

    /// Opens the trace that a program wrote, and returns its length. The trace must be a regular file and is read up to
    /// the limit. Anything else counts as no trace.
    fn open_trace(&self, left: &RemainingFolder) -> Result<(Box<dyn Read + Send>, u64), String> {
        match left.regular_file(TRACE_FILE, u64::MAX) {
            Ok((file, length)) => Ok((Box::new(file.take(self.limits.trace)), length.min(self.limits.trace))),
            Err(CollectError::System { source, .. }) if source.kind() != io::ErrorKind::PermissionDenied => {
                Err(format!("the trace can't be opened: {source}"))
            }
            Err(_) => Ok((Box::new(io::empty()), 0)),
        }
    }

    /// Starts `program` on a scene in a new working folder, which exists as long as the returned value.
    fn start(
        &self,
        program: &Path,
        identity: Option<ProgramIdentity>,
        task: &SceneTask,
    ) -> Result<(RunningProgram, TemporaryFolder), String> {
        let folder = self.folders.take_folder().map_err(|error| format!("cannot create the run's folder: {error}"))?;
        let job = Job::new(program, folder.path())
            .arguments(self.build_arguments(program))
            .file(SCENE_FILE, task.xml.as_slice())
            .trace(TRACE_FILE)
            .policy(Policy::Submission)
            .folder_in_memory()
            .sanitizers(self.limits.sanitizers)
            .with_identity(identity)
            .limits(self.sandbox_limits());
        Ok((self.backend.start(&job).map_err(|error| error.to_string())?, folder))
    }

    /// Judges the trace of a program. The trace is always read to its end, so that all of it is kept.
    fn judge_trace(
        &self,
        program: &StagedProgram,
        task: &SceneTask,
        kept_trace: &mut KeptTrace,
        mut trace: impl Read + Send,
        watch: &mut dyn Progress,
    ) -> Result<Result<Outcome, String>, CaughtPanic> {
        let judged = catch_panic(|| {
            failed_scene::inject_panic(Activity::Judging, &program.program);
            self.judge(task, kept_trace, &mut trace, watch)
        });
        // The judge has already reported read errors.
        let _ = io::copy(&mut kept_trace.keep_from(trace), &mut io::sink());
        judged
    }

    fn judge(
        &self,
        task: &SceneTask,
        kept: &mut KeptTrace,
        trace: impl Read + Send,
        watch: &mut dyn Progress,
    ) -> Result<Outcome, String> {
        let options = Options {
            stopping_book: self.rules.official(),
            threads: 1,
            uses_fair_rules: self.rules.includes_fair(),
            ..Options::default()
        };
        if !self.uses_recordings {
            return Ok(replay::judge(&task.scene, kept.keep_from(trace), &options, watch));
        }
        let no_recording = || format!("{} has no recording: grade it without --recorded", task.name);
        let recording = zstd::Decoder::with_buffer(task.recording.ok_or_else(no_recording)?)
            .map_err(|error| format!("a recording can't be unpacked: {error}"))?;
        recording::judge(&task.scene, kept.keep_from(trace), recording, watch).map_err(|error| error.to_string())
    }

    fn build_arguments(&self, program: &Path) -> Vec<std::ffi::OsString> {
        self.command
            .iter()
            .skip(1)
            .map(|argument| {
                argument
                    .replace("{scene}", SCENE_FILE)
                    .replace("{trace}", TRACE_FILE)
                    .replace("{program}", &program.to_string_lossy())
                    .into()
            })
            .collect()
    }

    fn sandbox_limits(&self) -> Limits {
        let limits = self.limits;
        Limits {
            cpu: limits.cpu,
            wall: limits.wall,
            memory: limits.memory,
            output_bytes: limits.output,
            trace_bytes: limits.trace,
            folder_bytes: limits.folder,
            folder_files: limits.files,
            ..Limits::default()
        }
    }
}

/// Returns the result of a run that was judged, with its explanations. If this work panics, returns the activity and
/// the panic.
fn explain_run(run: &JudgedRun<'_>, kept: &KeptTrace, program: &Path) -> Result<SceneResult, (Activity, CaughtPanic)> {
    let mut explaining = catch_panic(|| failed_scene::inject_panic(Activity::Explaining, program)).err();
    let explain = |depth: SearchDepth| {
        catch_panic(|| depth.explain(&run.task.scene, kept)).unwrap_or_else(|fault| {
            explaining = Some(fault);
            Vec::new()
        })
    };
    let result = catch_panic(|| conclude(run, explain)).map_err(|fault| (Activity::Judging, fault))?;
    explaining.map_or(Ok(result), |fault| Err((Activity::Explaining, fault)))
}

/// Reports the progress of judging, step by step.
struct StepReporter<'a>(&'a mut dyn FnMut(u32));

impl Progress for StepReporter<'_> {
    fn observe_step_end(&mut self, step: u32, _remarks: &[Remark]) {
        (self.0)(step);
    }
}
