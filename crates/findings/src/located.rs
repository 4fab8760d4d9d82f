//! The common properties of scenes in which a program crashes or runs into a limit, as a value.
use fosssim_ended::Ended;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A kind of event, or one value of one of its properties, by their names.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Content {
    /// The kind of event.
    pub family: Cow<'static, str>,
    /// A property and its value.
    pub value: Option<[Cow<'static, str>; 2]>,
}

/// How programs fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Failing {
    /// By a signal.
    Crash,
    /// By an exit code of their own.
    Error,
    /// By the limit of time.
    Time,
    /// By the limit of memory.
    Memory,
    /// By a limit of what they may write.
    Output,
    /// By several of these.
    Several,
}

/// The contents that the failing scenes have in common.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct LocatedFailure {
    /// How it fails.
    pub failing: Failing,
    /// The contents of all these scenes, the most general first; the scenes can't tell them apart.
    pub contents: Vec<Content>,
    /// The number of scenes in which it fails; all of them contain it.
    pub failed: usize,
    /// The number of scenes that contain it.
    pub with: usize,
    /// The number of scenes that were run and do not contain it; the program fails in none of these.
    pub without: usize,
    /// The first scene in which it fails.
    pub first: String,
    /// The step of the last complete record there; 0 for the first record.
    pub step: u32,
}

impl Failing {
    /// Returns how a program failed that ended so; nothing where it ended well, or where that says nothing of it.
    #[must_use]
    pub const fn from_end(ended: &Ended) -> Option<Self> {
        match ended {
            Ended::Signalled(_) => Some(Self::Crash),
            Ended::Exited(0) | Ended::CouldNotStart(_) | Ended::Cancelled => None,
            Ended::Exited(_) => Some(Self::Error),
            Ended::CpuLimit | Ended::WallLimit => Some(Self::Time),
            Ended::MemoryLimit => Some(Self::Memory),
            Ended::TraceLimit | Ended::FolderLimit => Some(Self::Output),
            Ended::ProcessLimit | Ended::Violation { .. } => None,
        }
    }
}
