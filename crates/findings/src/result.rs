//! Results of scenes, as values: `report::words` makes sentences of them, `grading::score` the points.
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
    trace::{Malformation, Unreadable},
};
use serde::{Deserialize, Serialize};
use std::{path::PathBuf, time::Duration};

pub use fosssim_ended::{RunEnd, StartProblem};

/// The result of one scene: everything but its points, which follow from the suite. It holds all that staff may know;
/// reports for students are made of what `mistakes::together::told_to_students` leaves of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneResult {
    /// The scene's name, `Group/name`.
    pub scene: String,
    /// The verdict.
    pub verdict: Verdict,
    /// The reason why that is the verdict.
    pub reason: Reason,
    /// The way the program ended, if it was run.
    pub ended: Option<RunEnd>,
    /// The rule of the original that makes the two rule books come to different verdicts about the trace, if they do.
    pub differs: Option<Cause>,
    /// The part of the trace that a report may show.
    pub disclosure: Option<Disclosure>,
    /// Likely mistakes, the likeliest first.
    pub explanations: Vec<Explanation>,
    /// Steps without a finding, of all steps.
    pub right_steps: u32,
    /// Steps of the scene.
    pub steps: u32,
    /// The measurements, which differ from run to run.
    pub measured: Measurements,
    /// Timed runs, where the suite gives points for speed and all scenes of the group are accepted.
    pub timing: Option<Timing>,
    /// The program's standard output, capped; raw text that a report has to escape.
    pub stdout: String,
    /// The program's standard error, capped; raw text that a report has to escape.
    pub stderr: String,
    /// The name of the card that was drawn of its trace.
    pub card: Option<String>,
    /// The name of the card for students, if hints let them see less and such a card was requested.
    pub card_for_students: Option<String>,
}

impl SceneResult {
    /// Returns a scene without a run, with the reason.
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

    /// Leaves the verdict, and nothing else that the program could have chosen: a program that was run on a hidden
    /// scene could reveal it by an exit code, a signal, the first wrong step, a picture, its time or its memory. What
    /// is the same in every scene stays, and so do names of likely mistakes, of which a report shows few.
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

/// The measurements of a run; all other values of a result follow from the program and the scene.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Measurements {
    /// Processor time of the program.
    pub cpu: Duration,
    /// Wall time of the run.
    pub wall: Duration,
    /// The time that judging and explaining took beyond that.
    pub judging: Duration,
    /// Peak memory of the program in bytes, when known.
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
    /// The way in which the program ended ([`SceneResult::ended`]), and its progress.
    Program(ProgramProgress),
    /// The scene was left out.
    LeftOut(NotRunReason),
    /// Grading was stopped.
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

/// The fault of a trace, with what hints allow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum WrongTrace {
    /// Hints hide the fault.
    Untold,
    /// In that nothing is logged: no polynomial and no collision.
    Nothing,
    /// In its first record alone.
    FirstRecord(FindingKind),
    /// In steps.
    Steps {
        /// The number of wrong steps.
        wrong: u64,
        /// The first such step.
        first: u32,
        /// The first fault there.
        kind: FindingKind,
    },
    /// Only in that its records are damaged.
    Damaged,
    /// In no step: small errors add up beyond the tolerance.
    SmallErrors,
    /// In that a step has no result, where the original computes without end.
    NoResult(StepError),
    /// By the fair rules: in that most of its decisions differ from the reference's, though round-off may flip them.
    Borderline,
    /// In nothing so far, but judging it was given up.
    Undecided,
}

/// The reason why a trace can't be read to its end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum BadTrace {
    /// A record can't be read.
    Unreadable {
        /// The frame, from 0.
        frame: u64,
        /// The step to which it belongs; 0 for the first record.
        step: u32,
        /// Which part of the record, or why not.
        cause: Unreadable,
        /// Byte offset of the damage.
        offset: u64,
        /// The damage that the reader reported.
        damage: Malformation,
    },
    /// The trace holds the states of all steps, and nothing of collisions.
    StatesOnly,
    /// By the fair rules: it is damaged.
    Damaged,
    /// By the fair rules: bytes follow its last record.
    TrailingBytes,
}

/// The progress of a program, and the limit that stopped it, if one did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ProgramProgress {
    /// The limit.
    pub limit: Option<Limit>,
    /// Steps whose records were complete.
    pub steps: u32,
}

/// A limit of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Limit {
    /// The time on the processor or on the clock; the program's end says which.
    Time(Duration),
    /// The memory, in bytes.
    Memory(u64),
}

/// The reason why a scene is not run any more.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum NotRunReason {
    /// This number of scenes in a row ran into a limit of time, memory or output; the verdict is the worst of theirs.
    Limits {
        /// How many.
        scenes: u32,
        /// The worst of their verdicts.
        verdict: Verdict,
    },
    /// The submission has used up its time.
    Total(Duration),
    /// A scene is not accepted, and the grading was to stop there.
    FailFast,
}

/// The reason why a submission can't be run: its own fault.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum UnusableReason {
    /// The program can't be started.
    CouldNotStart(StartProblem),
    /// There is no program of the expected name.
    NoProgram {
        /// That name.
        sought: String,
        /// The contents that are there instead.
        found: FolderContents,
    },
    /// The program can't be read or copied, for this reason of the operating system or of the copy.
    Unreadable(String),
}

/// The contents of a submission's folder where a program is missing.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum FolderContents {
    /// The folder can't be read, for this reason of the operating system.
    Unreadable(String),
    /// The folder is empty.
    Nothing,
    /// The folder holds other files and folders.
    Others {
        /// The first names in order; folders end in a slash.
        names: Vec<String>,
        /// The number of them besides.
        more: usize,
        /// A file of the right name in another place.
        elsewhere: Option<String>,
    },
}

/// A failure of the grader.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Failure {
    /// A fault of the machine, or of the grader's input, in its own words.
    Machine(String),
    /// Itself: a panic, with its words and its place in the source.
    Panic {
        /// The activity on which it failed; nothing, where that is not known.
        stage: Option<Activity>,
        /// The panic.
        fault: String,
        /// The place where the trace is that it failed on.
        trace: Option<SavedTrace>,
    },
}

fosssim_num::closed_set! {
    /// The grader's activities.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum Activity {
        /// Comparing the trace with the reference.
        Judging = "judging",
        /// Looking for the likely mistake.
        Explaining = "explaining",
        /// Drawing what pages show of the trace.
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
        /// The folder for the run.
        folder: PathBuf,
        /// The reason that the operating system gives.
        error: String,
    },
}

/// The way a build ended.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum BuildEnd {
    /// The build made the program.
    Made,
    /// The build ended in another way than with exit code 0.
    Ended(RunEnd),
    /// The build ended well and made no program of this name.
    MadeNo(String),
    /// The build's product can't be used, for this reason.
    Unusable(String),
    /// The sources can't be copied, for this reason.
    Sources(String),
    /// The sources lack this script, which builds them.
    NoScript(String),
}

impl BuildEnd {
    /// Returns whether there is a program.
    #[must_use]
    pub const fn is_success(&self) -> bool {
        matches!(self, Self::Made)
    }
}
