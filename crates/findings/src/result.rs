//! Data types for the results of scenes. `report::words` describes them, and `grading::score` computes points.
use super::{
    cause::Cause,
    disclosure::Disclosure,
    explanation::{Explanation, ExplanationTopic},
    finding::FindingKind,
    timing::Timing,
    verdict::Verdict,
};
use fosssim_model::{
    sim::StepError,
    trace::{ReadFailure, TraceFormatError},
};
use serde::{Deserialize, Serialize};
use std::{path::PathBuf, time::Duration};

pub use fosssim_ended::{RunEnd, StartProblem};

/// The result of one scene, without its points, which depend on the suite. It contains everything that staff may see.
/// The module `mistakes::together` reduces it to what students may see.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneResult {
    /// The name of the scene, as `Group/name`.
    pub scene: String,
    /// The verdict on the scene.
    pub verdict: Verdict,
    /// The reason for the verdict.
    pub reason: Reason,
    /// The result of the run; `None` if the program was not run.
    pub ended: Option<RunEnd>,
    /// The reason why the two rule books judge the trace differently; `None` if they agree.
    #[serde(rename = "differs")]
    pub difference_cause: Option<Cause>,
    /// The part of the trace that a report may show.
    pub disclosure: Option<Disclosure>,
    /// Likely mistakes, the likeliest first.
    pub explanations: Vec<Explanation>,
    /// The number of steps in which there is no finding.
    pub right_steps: u32,
    /// The number of steps of the scene.
    pub steps: u32,
    /// Times and memory, which differ from run to run.
    pub measured: Measurements,
    /// The timed runs, if the suite gives points for speed and all scenes of the group were accepted.
    pub timing: Option<Timing>,
    /// The program's standard output, cut if it is long. It is raw text, which reports must escape.
    pub stdout: String,
    /// The program's standard error, cut if it is long. It is raw text, which reports must escape.
    pub stderr: String,
    /// The name of the stored card that shows the trace, if there is one.
    pub card: Option<String>,
    /// The name of the stored card for students. It exists only if it was requested, and if hints show students less
    /// than staff.
    pub card_for_students: Option<String>,
}

impl SceneResult {
    /// Creates the result of a scene that was not run.
    pub fn without_run(scene: &str, steps: u32, verdict: Verdict, reason: Reason) -> Self {
        Self {
            scene: scene.to_owned(),
            verdict,
            reason,
            ended: None,
            difference_cause: None,
            disclosure: None,
            explanations: Vec::new(),
            right_steps: 0,
            steps,
            measured: Measurements::default(),
            timing: None,
            stdout: String::new(),
            stderr: String::new(),
            card: None,
            card_for_students: None,
        }
    }

    /// Removes everything that the program could have controlled, except for the verdict. A program could reveal a
    /// hidden scene by an exit code, a signal, the first wrong step, a picture, its time or its memory. Values that are
    /// the same in every scene, and the names of likely mistakes, are kept.
    pub fn withhold(&mut self) {
        let harmless = match &self.reason {
            Reason::Right | Reason::Wrong(WrongTrace::Nothing) | Reason::NoTrace => true,
            Reason::Skipped(_) | Reason::Stopped | Reason::DoesNotBuild | Reason::Unusable(_) => true,
            Reason::Wrong(_) | Reason::Trace(_) | Reason::Program(_) | Reason::Failed(_) | Reason::Withheld => false,
        };
        self.explanations.retain(|explanation| {
            matches!(explanation.topic, ExplanationTopic::Mistake | ExplanationTopic::Unfinished)
        });
        for explanation in &mut self.explanations {
            (explanation.details, explanation.example) = (Vec::new(), None);
        }
        *self = Self {
            reason: if harmless { self.reason.clone() } else { Reason::Withheld },
            explanations: std::mem::take(&mut self.explanations),
            ..Self::without_run(&self.scene, self.steps, self.verdict, Reason::Withheld)
        };
    }
}

/// Times and memory of a run. They vary; all other values of a result depend only on the program and the scene.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Measurements {
    /// The processor time of the program.
    pub cpu: Duration,
    /// The wall time of the run.
    pub wall: Duration,
    /// The time that judging and explaining took after the run.
    pub judging: Duration,
    /// The peak memory of the program in bytes; `None` if it is unknown.
    pub memory: Option<u64>,
}

/// The reason why a scene has its verdict.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Reason {
    /// Every step is right.
    Right,
    /// The trace is complete, but wrong.
    Wrong(WrongTrace),
    /// The trace can't be read to its end.
    Trace(BadTrace),
    /// The program wrote no trace.
    NoTrace,
    /// The program failed. How it ended is in [`SceneResult::ended`], and the value is how far it came.
    Program(ProgramProgress),
    /// The scene was skipped, for this reason.
    #[serde(rename = "LeftOut")]
    Skipped(NotRunReason),
    /// Grading was interrupted.
    Stopped,
    /// The sources could not be built.
    DoesNotBuild,
    /// The reason is withheld from students ([`SceneResult::withhold`]).
    Withheld,
    /// The submission itself can't be run.
    Unusable(UnusableReason),
    /// The grader failed.
    Failed(Failure),
}

/// The fault of a trace, if the hints show it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum WrongTrace {
    /// The hints do not show what is wrong.
    #[serde(rename = "Untold")]
    Undisclosed,
    /// The trace logs no polynomials and no collisions.
    Nothing,
    /// The first record is wrong, and nothing else. The value is the kind of finding.
    FirstRecord(FindingKind),
    /// Some steps are wrong.
    Steps {
        /// The number of steps that are wrong.
        wrong: u64,
        /// The number of the first wrong step.
        first: u32,
        /// The kind of the first fault in that step.
        kind: FindingKind,
    },
    /// Records are damaged, and nothing else is wrong.
    Damaged,
    /// No single step is wrong, but small errors add up to more than the tolerance.
    SmallErrors,
    /// In a step, the original does not terminate, so the step has no result.
    NoResult(StepError),
    /// Fair rules: most decisions are borderline and differ from the reference's, so the trace cannot be judged.
    Borderline,
    /// No difference was found before judging stopped.
    Undecided,
}

/// The reason why a trace can't be read to its end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum BadTrace {
    /// A record cannot be read.
    Unreadable {
        /// The index of the record, from 0.
        frame: u64,
        /// The step to which the record belongs, from 1; 0 is the first record.
        step: u32,
        /// The part of the record that cannot be read, or why.
        cause: ReadFailure,
        /// The position of the damage in the file, in bytes.
        offset: u64,
        /// The damage, as the trace's reader reports it.
        damage: TraceFormatError,
    },
    /// The trace contains the states of all steps, but no collisions.
    StatesOnly,
    /// Fair rules: the trace is damaged.
    Damaged,
    /// Fair rules: bytes follow the last record.
    TrailingBytes,
}

/// The progress of a program, and the limit that stopped it, if any.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ProgramProgress {
    /// The limit that stopped the program; `None` if it ended by itself.
    pub limit: Option<Limit>,
    /// The number of steps whose records are complete.
    pub steps: u32,
}

/// A limit on a program's run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Limit {
    /// The limit of processor time or wall time. How the program ended shows which one it was.
    Time(Duration),
    /// The memory limit, in bytes.
    Memory(u64),
}

/// The reason why a scene was not run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum NotRunReason {
    /// Several scenes, in a row or four times as many in all, exceeded a limit of time, memory or output.
    Limits {
        /// The number of these scenes.
        scenes: u32,
        /// The worst verdict of these scenes.
        verdict: Verdict,
    },
    /// The submission has used up its total time for all scenes, which is the value.
    Total(Duration),
    /// An earlier scene was not accepted, and the grading was to stop at the first such scene.
    FailFast,
}

/// The reason why a submission cannot be run. The submission itself is the cause.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum UnusableReason {
    /// The program cannot be started.
    CouldNotStart(StartProblem),
    /// The folder does not contain a program of the expected name.
    NoProgram {
        /// The name that the program should have.
        sought: String,
        /// The contents of the folder.
        found: FolderContents,
    },
    /// The program cannot be read or copied. The value is the system's error message.
    Unreadable(String),
}

/// The contents of a submission's folder that does not contain the program.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum FolderContents {
    /// The folder cannot be read. The value is the system's error message.
    Unreadable(String),
    /// The folder is empty.
    Nothing,
    /// The folder contains other files and folders.
    Others {
        /// The first names in the folder, sorted. A slash follows the names of folders.
        names: Vec<String>,
        /// The number of further names, which are not listed.
        more: usize,
        /// The path of a file in a subfolder that has the expected name, if there is one.
        elsewhere: Option<String>,
    },
}

/// A failure of the grader.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Failure {
    /// The machine or the grader's input has a fault. The value describes it.
    Machine(String),
    /// The grader panicked, which is an error in the grader itself.
    Panic {
        /// The activity of the grader when it failed, if it is known.
        stage: Option<Activity>,
        /// The panic's message, and its location in the source code.
        fault: String,
        /// The trace on which the grader failed, if there was one.
        trace: Option<SavedTrace>,
    },
}

fosssim_num::closed_set! {
    /// The activities in which the grader can fail.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum Activity {
        /// The grader compares the trace with the reference.
        Judging = "judging",
        /// The grader searches for the likely mistake.
        Explaining = "explaining",
        /// The grader draws the cards for pages.
        Drawing = "drawing",
    }
}

/// The file that contains the trace on which the grader failed, if it could be stored.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum SavedTrace {
    /// The trace is stored in this file.
    In(PathBuf),
    /// The trace could not be stored.
    Lost {
        /// The folder in which the trace should have been saved.
        folder: PathBuf,
        /// The system's error message.
        error: String,
    },
}

/// The result of a build.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum BuildEnd {
    /// The build produced the program.
    #[serde(rename = "Made")]
    Success,
    /// The build ended with an exit code other than 0, or was stopped.
    #[serde(rename = "Ended")]
    Failure(RunEnd),
    /// The build ended normally, but did not produce a program of this name.
    #[serde(rename = "MadeNo")]
    MissingProgram(String),
    /// The program that was built cannot be used, for the given reason.
    #[serde(rename = "Unusable")]
    UnusableProgram(String),
    /// The sources cannot be copied, for the given reason.
    #[serde(rename = "Sources")]
    UnusableSources(String),
    /// The sources do not contain the script that builds them. The value is the script's name.
    #[serde(rename = "NoScript")]
    MissingScript(String),
}

impl BuildEnd {
    /// Returns whether the build produced the program.
    pub const fn is_success(&self) -> bool {
        matches!(self, Self::Success)
    }
}
