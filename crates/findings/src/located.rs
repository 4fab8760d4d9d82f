//! The common properties of the scenes in which a program crashes or exceeds a limit.
use fosssim_ended::RunEnd;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A kind of event, or a property of such events with a value, by their names.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Content {
    /// The kind of event.
    pub family: Cow<'static, str>,
    /// The property's name and its value; `None` for all events of the kind.
    pub value: Option<[Cow<'static, str>; 2]>,
}

fosssim_num::closed_set! {
    /// The ways in which programs fail.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum FailureKind {
        /// The program is killed by a signal.
        Crash = "crash",
        /// The program ends with an exit code that means an error.
        Error = "end with an error code",
        /// The program exceeds the time limit.
        Time = "run out of time",
        /// The program exceeds the memory limit.
        Memory = "need more memory than allowed",
        /// The program exceeds an output limit.
        Output = "write more than allowed",
        /// The program fails in several ways.
        Several = "crash or run into a limit",
    }
}

/// The contents that the failing scenes have in common.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LocatedFailure {
    /// The way in which the program fails.
    pub failing: FailureKind,
    /// The common contents of all failing scenes, the most general first. The scenes cannot show which of these
    /// contents is the cause.
    pub contents: Vec<Content>,
    /// The number of scenes in which the program fails; all of these scenes have the contents.
    pub failed: usize,
    /// The number of scenes with the contents.
    pub with: usize,
    /// The number of run scenes without the contents; the program fails in none of them.
    pub without: usize,
    /// The first scene in which the program fails.
    pub first: String,
    /// The step of the last complete record in that scene; 0 for the first record.
    pub step: u32,
}

impl FailureKind {
    /// Returns the kind of failure for an end of a program; `None` if it ended well, or if the kind is unknown.
    #[must_use]
    pub const fn from_end(ended: &RunEnd) -> Option<Self> {
        match ended {
            RunEnd::Signalled(_) => Some(Self::Crash),
            RunEnd::Exited(0) | RunEnd::CouldNotStart(_) | RunEnd::Cancelled => None,
            RunEnd::Exited(_) => Some(Self::Error),
            RunEnd::CpuLimit | RunEnd::WallLimit => Some(Self::Time),
            RunEnd::MemoryLimit => Some(Self::Memory),
            RunEnd::TraceLimit | RunEnd::FolderLimit => Some(Self::Output),
            RunEnd::ProcessLimit | RunEnd::Violation { .. } => None,
        }
    }
}
