//! The common properties of scenes in which a program crashes or runs into a limit, as a value.
use fosssim_ended::RunEnd;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A kind of event, or a value of one of its properties, by their names.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Content {
    /// The kind of event.
    pub family: Cow<'static, str>,
    /// A property and its value.
    pub value: Option<[Cow<'static, str>; 2]>,
}

fosssim_num::closed_set! {
    /// The ways in which programs fail.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
    pub enum FailureKind {
        /// By a signal.
        Crash = "crash",
        /// By an exit code of their own.
        Error = "end with an error code",
        /// By the limit of time.
        Time = "run out of time",
        /// By the limit of memory.
        Memory = "need more memory than allowed",
        /// By a limit of their output.
        Output = "write more than allowed",
        /// In several of these ways.
        Several = "crash or run into a limit",
    }
}

/// The contents that the failing scenes have in common.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LocatedFailure {
    /// The way in which the program fails.
    pub failing: FailureKind,
    /// The contents of all these scenes, the most general first; the scenes can't distinguish them.
    pub contents: Vec<Content>,
    /// The number of scenes in which the program fails; all of them have this content.
    pub failed: usize,
    /// The number of scenes with this content.
    pub with: usize,
    /// The number of scenes that were run and do not contain it; the program fails in none of these.
    pub without: usize,
    /// The first scene in which it fails.
    pub first: String,
    /// The step of the last complete record there; 0 for the first record.
    pub step: u32,
}

impl FailureKind {
    /// Returns the failure of a program that ended so; `None` if it ended well, or if its end does not show it.
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
