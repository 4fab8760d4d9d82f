//! Results of scenes, as values. `report::words` turns them into sentences, and `grading::score` into points.
use super::{
    cause::Cause,
    disclosure::Disclosure,
    explanation::{About, Explanation},
    finding::FindingKind,
    timing::Timing,
    verdict::Verdict,
};
use fosssim_model::{
    sim::StepError,
    trace::{Malformation, ReadFailure},
};
use serde::{Deserialize, Serialize};
use std::{path::PathBuf, time::Duration};

pub use fosssim_ended::{RunEnd, StartProblem};

/// The result of one scene: everything but its points, which follow from the suite. It contains everything that staff
/// may see; `mistakes::together::told_to_students` makes the reduced version for students.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneResult {
    /// The scene's name, `Group/name`.
    pub scene: String,
    /// The verdict.
    pub verdict: Verdict,
    /// The reason for the verdict.
    pub reason: Reason,
    /// The end of the program, if it was run.
    pub ended: Option<RunEnd>,
    /// The rule of the original that makes the two rule books disagree about the trace, if they do.
    pub differs: Option<Cause>,
    /// The part of the trace that a report may show.
    pub disclosure: Option<Disclosure>,
    /// Likely mistakes, the likeliest first.
    pub explanations: Vec<Explanation>,
    /// The number of steps without a finding.
    pub right_steps: u32,
    /// The number of steps of the scene.
    pub steps: u32,
    /// The measurements, which differ from run to run.
    pub measured: Measurements,
    /// The timed runs, if the suite gives points for speed and all scenes of the group are accepted.
    pub timing: Option<Timing>,
    /// The program's standard output, truncated; raw text that a report has to escape.
    pub stdout: String,
    /// The program's standard error, truncated; raw text that a report has to escape.
    pub stderr: String,
    /// The name of the card that shows the trace.
    pub card: Option<String>,
    /// The name of the card for students, if it was requested and hints show students less than staff.
    pub card_for_students: Option<String>,
}

impl SceneResult {
    /// Creates the result of a scene that was not run.
    #[must_use]
    pub fn without_run(scene: &str, steps: u32, verdict: Verdict, reason: Reason) -> Self {
        Self {
            scene: scene.to_owned(),
            verdict,
            reason,
            ended: None,
            differs: None,
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

    /// Removes everything except the verdict that the program could have controlled. A program could reveal a hidden
    /// scene by an exit code, a signal, the first wrong step, a picture, its time or its memory. Values that are the
    /// same in every scene stay, and so do the names of likely mistakes.
    pub fn withhold(&mut self) {
        let harmless = match &self.reason {
            Reason::Right | Reason::Wrong(WrongTrace::Nothing) | Reason::NoTrace => true,
            Reason::LeftOut(_) | Reason::Stopped | Reason::DoesNotBuild | Reason::Unusable(_) => true,
            Reason::Wrong(_) | Reason::Trace(_) | Reason::Program(_) | Reason::Failed(_) | Reason::Withheld => false,
        };
        self.explanations.retain(|one| matches!(one.about, About::Mistake | About::Unfinished));
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

/// The measurements of a run, which vary; all other values of a result depend only on the program and the scene.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Measurements {
    /// The processor time of the program.
    pub cpu: Duration,
    /// The wall time of the run.
    pub wall: Duration,
    /// The additional time for judging and explaining.
    pub judging: Duration,
    /// The peak memory of the program in bytes, if known.
    pub memory: Option<u64>,
}

/// The reason why a scene has its verdict.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Reason {
    /// Every step is right.
    Right,
    /// The trace is complete and wrong.
    Wrong(WrongTrace),
    /// The trace can't be read to its end.
    Trace(BadTrace),
    /// The program wrote no trace.
    NoTrace,
    /// The program failed. The end is in [`SceneResult::ended`]; the value is the program's progress.
    Program(ProgramProgress),
    /// The scene was skipped, for this reason.
    LeftOut(NotRunReason),
    /// Grading was interrupted.
    Stopped,
    /// The sources do not build.
    DoesNotBuild,
    /// The reason is withheld from students ([`SceneResult::withhold`]).
    Withheld,
    /// The submission itself can't be run.
    Unusable(UnusableReason),
    /// The grader failed.
    Failed(Failure),
}

/// The fault of a trace, with the details that hints allow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum WrongTrace {
    /// Hints hide the fault.
    Untold,
    /// The trace logs no polynomials and no collisions.
    Nothing,
    /// Only the first record is wrong.
    FirstRecord(FindingKind),
    /// Some steps are wrong.
    Steps {
        /// The number of wrong steps.
        wrong: u64,
        /// The number of the first wrong step.
        first: u32,
        /// The kind of the first fault in that step.
        kind: FindingKind,
    },
    /// The only fault is that records are damaged.
    Damaged,
    /// No step is wrong, but small errors add up beyond the tolerance.
    SmallErrors,
    /// A step has no result, because the original does not terminate.
    NoResult(StepError),
    /// Fair rules: most decisions are borderline and differ from the reference's.
    Borderline,
    /// No difference was found before judging stopped.
    Undecided,
}

/// The reason why a trace can't be read to its end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum BadTrace {
    /// A record cannot be read.
    Unreadable {
        /// The index of the frame, from 0.
        frame: u64,
        /// The step to which it belongs; 0 for the first record.
        step: u32,
        /// The part of the record that cannot be read, or the reason.
        cause: ReadFailure,
        /// The byte offset of the damage.
        offset: u64,
        /// The damage that the reader reported.
        damage: Malformation,
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
    /// The limit that stopped the program.
    pub limit: Option<Limit>,
    /// The number of steps with complete records.
    pub steps: u32,
}

/// A limit of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Limit {
    /// The limit of processor time or wall time; the program's end shows which.
    Time(Duration),
    /// The memory limit, in bytes.
    Memory(u64),
}

/// The reason why a scene is not run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum NotRunReason {
    /// Several scenes in a row exceeded a limit of time, memory or output.
    Limits {
        /// The number of scenes in the row.
        scenes: u32,
        /// The worst verdict of the scenes in the row.
        verdict: Verdict,
    },
    /// The submission has used up its total time, which is the value.
    Total(Duration),
    /// An earlier scene is not accepted, and grading stops at the first such scene.
    FailFast,
}

/// The reason why a submission cannot be run, which is its own fault.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum UnusableReason {
    /// The program cannot be started.
    CouldNotStart(StartProblem),
    /// The folder has no program of the expected name.
    NoProgram {
        /// The expected name of the program.
        sought: String,
        /// The contents of the folder.
        found: FolderContents,
    },
    /// The program cannot be read or copied; the value is the error message.
    Unreadable(String),
}

/// The contents of a submission's folder that does not contain the program.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum FolderContents {
    /// The folder cannot be read; the value is the system's error message.
    Unreadable(String),
    /// The folder is empty.
    Nothing,
    /// The folder contains other files and folders.
    Others {
        /// The first names, sorted; names of folders end in a slash.
        names: Vec<String>,
        /// The number of names that are not listed.
        more: usize,
        /// The path of a file with the expected name in a subfolder, if there is one.
        elsewhere: Option<String>,
    },
}

/// A failure of the grader.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Failure {
    /// An error of the machine or of the grader's input, as text.
    Machine(String),
    /// A panic of the grader.
    Panic {
        /// The grader's activity when it failed, if known.
        stage: Option<Activity>,
        /// The panic message, with its place in the source.
        fault: String,
        /// The saved trace on which the grader failed.
        trace: Option<SavedTrace>,
    },
}

fosssim_num::closed_set! {
    /// The grader's activities.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum Activity {
        /// The grader compares the trace with the reference.
        Judging = "judging",
        /// The grader looks for the likely mistake.
        Explaining = "explaining",
        /// The grader draws the cards for pages.
        Drawing = "drawing",
    }
}

/// The place of a trace on which the grader failed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum SavedTrace {
    /// The trace is in this file.
    In(PathBuf),
    /// The trace could not be kept.
    Lost {
        /// The folder in which the trace should have been saved.
        folder: PathBuf,
        /// The system's error message.
        error: String,
    },
}

/// The way a build ended.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum BuildEnd {
    /// The build made the program.
    Made,
    /// The build did not end with exit code 0.
    Ended(RunEnd),
    /// The build ended well, but made no program of this name.
    MadeNo(String),
    /// The built program cannot be used; the value is the reason.
    Unusable(String),
    /// The sources cannot be copied; the value is the reason.
    Sources(String),
    /// The sources lack the script that builds them; the value is its name.
    NoScript(String),
}

impl BuildEnd {
    /// Returns whether the build made a program.
    #[must_use]
    pub const fn is_success(&self) -> bool {
        matches!(self, Self::Made)
    }
}
