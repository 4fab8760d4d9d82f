//! The common features of the scenes in which a program crashes or exceeds a limit.
use fosssim_ended::RunEnd;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A feature of a scene: a kind of event, or the events of a kind that have a certain property. Both are given by their
/// names.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SceneFeature {
    /// The kind of event.
    pub family: Cow<'static, str>,
    /// The name and the value of the property; `None` for all events of the kind.
    pub value: Option<[Cow<'static, str>; 2]>,
}

fosssim_num::closed_set! {
    /// A kind of failure of a program.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum FailureKind {
        /// The program is killed by a signal.
        Crash = "crash",
        /// The program ends with an exit code that means an error.
        Error = "end with an error code",
        /// The program exceeds the time limit.
        Time = "exceed the time limit",
        /// The program exceeds the memory limit.
        Memory = "need more memory than allowed",
        /// The program exceeds an output limit.
        Output = "write more than allowed",
        /// The program fails in more than one of these ways.
        Several = "crash or run into a limit",
    }
}

/// The common features of the scenes in which the program fails.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LocatedFailure {
    /// The kind of failure in these scenes.
    #[serde(rename = "failing")]
    pub failure: FailureKind,
    /// The features that all failing scenes have in common, the most general first. The scenes do not show which of
    /// them is the cause.
    #[serde(rename = "contents")]
    pub features: Vec<SceneFeature>,
    /// The number of scenes in which the program fails. All of them have these features.
    #[serde(rename = "failed")]
    pub failed_scenes: usize,
    /// The number of scenes that have these features.
    #[serde(rename = "with")]
    pub scenes_with_features: usize,
    /// The number of scenes that were run and do not have these features. The program does not fail in any of them.
    #[serde(rename = "without")]
    pub scenes_without_features: usize,
    /// The first scene in which the program fails.
    #[serde(rename = "first")]
    pub first_scene: String,
    /// The step of the last complete record in that scene; 0 for the first record.
    pub step: u32,
}

impl FailureKind {
    /// Returns the kind of failure of a program that ended in this way; `None` if it ended normally, or if no kind
    /// fits.
    pub const fn from_end(end: &RunEnd) -> Option<Self> {
        match end {
            RunEnd::Signaled(_) => Some(Self::Crash),
            RunEnd::Exited(0) | RunEnd::CouldNotStart(_) | RunEnd::Canceled => None,
            RunEnd::Exited(_) => Some(Self::Error),
            RunEnd::CpuLimit | RunEnd::WallLimit => Some(Self::Time),
            RunEnd::MemoryLimit => Some(Self::Memory),
            RunEnd::TraceLimit | RunEnd::FolderLimit => Some(Self::Output),
            RunEnd::ProcessLimit | RunEnd::Violation { .. } => None,
        }
    }
}
