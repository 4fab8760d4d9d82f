//! Measures how much processor time each part of a run takes, for `grade --timings`.
use fosssim_sandbox::{ProcessorTimeScope, processor_time};
use std::{
    collections::BTreeMap,
    sync::{Mutex, PoisonError},
    time::Duration,
};

/// A part of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum RunPart {
    /// The grader starts the program in its sandbox, and waits for it.
    Start,
    /// The program runs.
    Program,
    /// The trace is judged.
    Judging,
    /// The working folder is emptied.
    CleanUp,
    /// The mistake is searched for.
    Explaining,
    /// Cards for pages are drawn.
    Drawing,
}

impl RunPart {
    /// The parts that run in the grader's own process, and their names.
    pub const GRADER_PARTS: [(Self, &str); 5] = [
        (Self::Start, "starting runs"),
        (Self::Judging, "judging"),
        (Self::Explaining, "explaining"),
        (Self::Drawing, "drawing for pages"),
        (Self::CleanUp, "cleaning up"),
    ];
}

/// For each part, the processor time of all runs and their number.
#[derive(Debug, Default)]
pub struct Timings(Mutex<BTreeMap<RunPart, (Duration, u32)>>);

impl Timings {
    /// Returns the processor time that a part of all runs took, and the number of runs.
    pub fn total(&self, part: RunPart) -> (Duration, u32) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get(&part).copied().unwrap_or_default()
    }

    /// Adds the processor time that a part of one run took.
    pub(super) fn add(&self, part: RunPart, time: Duration) {
        let mut parts = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (total, runs) = parts.entry(part).or_default();
        (*total, *runs) = (*total + time, *runs + 1);
    }
}

/// Measures the parts of one run, in the run's thread. Without `--timings`, no clock is read.
pub(super) struct Stopwatch<'a> {
    timings: Option<&'a Timings>,
    last: Duration,
}

impl<'a> Stopwatch<'a> {
    /// Starts the measurement of a run.
    pub(super) fn new(timings: Option<&'a Timings>) -> Self {
        Self { timings, last: timings.map_or(Duration::ZERO, |_| processor_time(ProcessorTimeScope::Thread)) }
    }

    /// Adds the time since the previous part ended to `part`.
    pub(super) fn end_part(&mut self, part: RunPart) {
        if let Some(timings) = self.timings {
            let now = processor_time(ProcessorTimeScope::Thread);
            timings.add(part, now.saturating_sub(self.last));
            self.last = now;
        }
    }
}
