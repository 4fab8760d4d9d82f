//! Runs one program on one scene in the sandbox and judges its trace while it is written.
use super::{
    conclude::conclude,
    config::{Hints, RunLimits},
    grade::SceneGrade,
    staging,
    verdict::Verdict,
};
use crate::{
    diagnose::{self, Explanation},
    judge::{
        Outcome, Rules,
        parity::{self, Options, Progress, Remark},
        recorded::{self, RecordingError},
    },
    sandbox::{self, Backend, Canceller, Job, Limits, Policy, Running, SandboxError},
    scene::Scene,
};
use std::{
    io::{self, Read},
    path::Path,
    sync::{
        Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    time::Duration,
};
use tempfile::TempDir;

/// Name of the scene's copy in the working folder, and of the trace.
const SCENE_FILE: &str = "scene.xml";
const TRACE_FILE: &str = "trace.bin";

/// A fault of ours or of the machine is tried so often before it is reported.
const ATTEMPTS: u32 = 2;

/// So much of a trace is kept in memory until it is judged, in bytes: should it be wrong, its beginning is explained.
/// The course's largest trace has 18 MB.
const KEPT_TRACE: usize = 24 << 20;

/// A scene to run.
#[derive(Debug, Clone)]
pub struct SceneTask {
    /// Its name, `Group/name`.
    pub name: String,
    /// Its XML, as the program gets it.
    pub xml: Vec<u8>,
    /// The scene itself.
    pub scene: Scene,
    /// Its recorded trace, compressed with zstd, when there is one.
    pub recording: Option<&'static [u8]>,
}

/// How scenes are run.
#[derive(Debug)]
pub struct Runner<'a> {
    /// The sandbox.
    pub backend: &'a Backend,
    /// The command line; `{program}`, `{scene}` and `{trace}` are replaced.
    pub run: &'a [String],
    /// Limits of each run.
    pub limits: &'a RunLimits,
    /// The rule books to ask.
    pub rules: Rules,
    /// How much the result tells.
    pub hints: Hints,
    /// Whether a run is cut short at its first wrong step.
    pub fail_fast: bool,
    /// Whether traces are judged against the recordings instead of the reference simulator.
    pub recorded: bool,
    /// Stops everything from outside.
    pub cancellation: &'a Cancellation,
}

impl Runner<'_> {
    /// Runs `program` on a scene, in a working folder of its own that is gone afterwards, and judges it. A fault of
    /// ours is tried once more, then it is the verdict. `on_step` hears the number of every judged step.
    #[must_use]
    pub fn grade(&self, program: &Path, task: &SceneTask, on_step: &mut dyn FnMut(u32)) -> SceneGrade {
        let mut attempt = 1;
        loop {
            if self.cancellation.is_cancelled() {
                return self.without_run(task, Verdict::NotRun, "grading was stopped".to_owned());
            }
            match self.attempt(program, task, on_step) {
                Ok(grade) => return grade,
                Err(_) if attempt < ATTEMPTS => attempt += 1,
                Err(error) => return self.without_run(task, Verdict::JudgeError, error.to_string()),
            }
        }
    }

    fn without_run(&self, task: &SceneTask, verdict: Verdict, summary: String) -> SceneGrade {
        not_run(&task.name, task.scene.steps(), verdict, summary)
    }

    fn attempt(
        &self,
        program: &Path,
        task: &SceneTask,
        on_step: &mut dyn FnMut(u32),
    ) -> Result<SceneGrade, ExecuteError> {
        let (mut running, _folder) = self.start(program, task)?;
        let canceller = running.canceller();
        let _registered = self.cancellation.register(canceller.clone());
        let bytes = AtomicU64::new(0);
        let mut kept = Vec::new();
        let keep = if self.hints >= Hints::What { KEPT_TRACE } else { 0 };
        let options = Options {
            stop_at_first: self.fail_fast,
            stop_by: self.rules.official(),
            threads: 1,
            fair: self.rules.ask_fair(),
            ..Options::default()
        };
        let mut watch = Watch { on_step };
        let mut cut_short = false;
        let judged = match running.trace() {
            Some(inner) => {
                let mut trace = Counted { inner, bytes: &bytes, kept: &mut kept, keep };
                let judged = self.judge(task, &mut trace, &options, &mut watch)?;
                cut_short = self.fail_fast
                    && judged.account(self.rules.official()).wrong_steps > 0
                    && judged.steps_judged < judged.steps;
                if cut_short {
                    canceller.cancel();
                }
                // What the judge did not want is read all the same, within the limit: a program must not die of our
                // closing the pipe. An error here ends the program as well, and its outcome says so.
                let _ = io::copy(&mut trace, &mut io::sink());
                judged
            }
            None => self.judge(task, io::empty(), &options, &mut watch)?,
        };
        let outcome = running.wait()?;
        let bytes = bytes.load(Ordering::Relaxed);
        let grade = conclude(&task.name, &outcome, &judged, bytes, cut_short, self.rules, self.hints);
        let explanations = self.hints.cut(explain(&grade, task, &kept));
        Ok(SceneGrade { explanations, ..grade })
    }

    /// Runs `program` on a scene as for grading, and hands its trace over unjudged, at most `keep` bytes of it.
    ///
    /// # Errors
    /// Faults of ours or of the machine, in words.
    pub fn collect(
        &self,
        program: &Path,
        task: &SceneTask,
        keep: usize,
    ) -> Result<(Vec<u8>, sandbox::Outcome), String> {
        let (mut running, _folder) = self.start(program, task).map_err(|error| error.to_string())?;
        let _registered = self.cancellation.register(running.canceller());
        let (bytes, mut kept) = (AtomicU64::new(0), Vec::new());
        if let Some(inner) = running.trace() {
            let mut trace = Counted { inner, bytes: &bytes, kept: &mut kept, keep };
            // An error here ends the program as well, and its outcome says so.
            let _ = io::copy(&mut trace, &mut io::sink());
        }
        let outcome = running.wait().map_err(|error| error.to_string())?;
        Ok((kept, outcome))
    }

    /// Starts `program` on a scene, in a working folder of its own that lives as long as the result.
    fn start(&self, program: &Path, task: &SceneTask) -> Result<(Running, TempDir), ExecuteError> {
        let folder =
            tempfile::Builder::new().prefix(&staging::prefix("run")).tempdir().map_err(ExecuteError::Folder)?;
        let scene_file = folder.path().join(SCENE_FILE);
        std::fs::write(&scene_file, &task.xml).map_err(ExecuteError::Folder)?;
        let job = Job::new(program, folder.path())
            .arguments(self.arguments(program))
            .trace_pipe(TRACE_FILE)
            .policy(Policy::Submission)
            .limits(self.sandbox_limits());
        Ok((self.backend.start(&job)?, folder))
    }

    fn judge(
        &self,
        task: &SceneTask,
        trace: impl Read + Send,
        options: &Options,
        watch: &mut Watch<'_>,
    ) -> Result<Outcome, ExecuteError> {
        if !self.recorded {
            return Ok(parity::judge(&task.scene, trace, options, watch));
        }
        let packed = task.recording.ok_or_else(|| ExecuteError::NoRecording(task.name.clone()))?;
        let recording = zstd::Decoder::with_buffer(packed).map_err(ExecuteError::Recording)?;
        Ok(recorded::judge(&task.scene, trace, recording, watch)?)
    }

    fn arguments(&self, program: &Path) -> Vec<std::ffi::OsString> {
        self.run
            .iter()
            .skip(1)
            .map(|word| {
                word.replace("{scene}", SCENE_FILE)
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

/// What is likely wrong with a program whose trace is: nothing where the fair rules find no fault, or where what the program
/// did besides is its worse fault.
fn explain(grade: &SceneGrade, task: &SceneTask, trace: &[u8]) -> Vec<Explanation> {
    match grade.verdict {
        Verdict::WrongAnswer | Verdict::BadTrace if grade.differs.is_none() => diagnose::explain(&task.scene, trace),
        _ => Vec::new(),
    }
}

/// A scene that was not judged, with the reason.
#[must_use]
pub fn not_run(scene: &str, steps: u32, verdict: Verdict, summary: String) -> SceneGrade {
    SceneGrade {
        scene: scene.to_owned(),
        verdict,
        summary,
        differs: None,
        details: Vec::new(),
        explanations: Vec::new(),
        points: 0.0,
        max_points: 0.0,
        right_steps: 0,
        steps,
        cpu: Duration::ZERO,
        wall: Duration::ZERO,
        memory: None,
        stdout: String::new(),
        stderr: String::new(),
        cached: false,
    }
}

/// Why a scene could not be run: always our fault or the machine's.
#[derive(Debug, thiserror::Error)]
enum ExecuteError {
    #[error("no working folder for a run: {0}")]
    Folder(io::Error),
    #[error("there is no recording of {0}: judge it without --recorded")]
    NoRecording(String),
    #[error("a recording can't be unpacked: {0}")]
    Recording(io::Error),
    #[error(transparent)]
    Damaged(#[from] RecordingError),
    #[error(transparent)]
    Sandbox(#[from] SandboxError),
}

/// Counts the bytes that arrive, and keeps the first ones.
struct Counted<'a, R> {
    inner: R,
    bytes: &'a AtomicU64,
    kept: &'a mut Vec<u8>,
    /// So many are kept.
    keep: usize,
}

impl<R: Read> Read for Counted<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.inner.read(buffer)?;
        self.bytes.fetch_add(count as u64, Ordering::Relaxed);
        let room = self.keep - self.kept.len();
        self.kept.extend_from_slice(&buffer[..count.min(room)]);
        Ok(count)
    }
}

/// Tells how judging goes.
struct Watch<'a> {
    on_step: &'a mut dyn FnMut(u32),
}

impl Progress for Watch<'_> {
    fn step_judged(&mut self, step: u32, _remarks: &[Remark]) {
        (self.on_step)(step);
    }
}

/// Stops a grading from outside, for example on Ctrl-C: no new run begins, and every run at work is ended.
#[derive(Debug, Default)]
pub struct Cancellation {
    cancelled: AtomicBool,
    next: AtomicU64,
    running: Mutex<Vec<(u64, Canceller)>>,
}

impl Cancellation {
    /// Stops everything, now and later.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::SeqCst);
        for (_, canceller) in self.lock().iter() {
            canceller.cancel();
        }
    }

    /// Whether grading has been stopped.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::SeqCst)
    }

    /// Adds a run for as long as the result lives. A run that begins after the stop is ended at once.
    pub(super) fn register(&self, canceller: Canceller) -> impl Drop + '_ {
        let number = self.next.fetch_add(1, Ordering::Relaxed);
        self.lock().push((number, canceller.clone()));
        if self.is_cancelled() {
            canceller.cancel();
        }
        Registered { cancellation: self, number }
    }

    fn lock(&self) -> MutexGuard<'_, Vec<(u64, Canceller)>> {
        self.running.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

struct Registered<'a> {
    cancellation: &'a Cancellation,
    number: u64,
}

impl Drop for Registered<'_> {
    fn drop(&mut self) {
        self.cancellation.lock().retain(|(number, _)| *number != self.number);
    }
}
