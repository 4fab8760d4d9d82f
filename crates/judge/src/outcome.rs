//! The verdict on one trace.
use super::{
    counts::FindingCounts,
    fair::{FairRefusal, Judgement},
    finding::Finding,
};
use fosssim_model::{
    sim::{SearchCounts, StepError},
    trace::Unreadable,
};
use fosssim_num::tolerances::{PARITY_ACCUMULATED, PARITY_MAXIMUM};

/// The original's overall verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Overall {
    /// All five conditions hold.
    Passed,
    /// One of them does not.
    Failed,
    /// Grading did not come to its end; there is no verdict.
    None,
}

/// The four residuals (oracle-behaviour.md 6.3), in scene units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Residuals {
    /// Sum of all position residuals.
    pub accumulated_position: f64,
    /// Sum of all velocity residuals.
    pub accumulated_velocity: f64,
    /// Largest position residual; NaN never raises it.
    pub maximum_position: f64,
    /// Largest velocity residual; NaN never raises it.
    pub maximum_velocity: f64,
}

impl Residuals {
    /// The residuals with their bounds, in the original's order: accumulated position and velocity, maximum position
    /// and velocity. A residual passes when it is strictly below its bound; NaN fails.
    #[must_use]
    pub const fn with_bounds(&self) -> [(f64, f64); 4] {
        [
            (self.accumulated_position, PARITY_ACCUMULATED),
            (self.accumulated_velocity, PARITY_ACCUMULATED),
            (self.maximum_position, PARITY_MAXIMUM),
            (self.maximum_velocity, PARITY_MAXIMUM),
        ]
    }
}

/// Why grading stopped before its end.
#[derive(Debug)]
pub enum Stop {
    /// The trace can't be read on; the original says so and stops.
    Trace {
        /// The frame that could not be read, from 0.
        frame: u64,
        /// The step it belongs to; 0 for the initial record.
        step: u32,
        /// What could not be read.
        cause: Unreadable,
        /// Byte offset of the damage.
        offset: u64,
        /// The damage in words, without position.
        message: String,
    },
    /// The trace's own states lead the reference into a computation without end or result; the original hangs.
    Step(StepError),
}

/// Damage that the original's reading passes over in silence; before a step without result also a number in the trace's
/// state that is not finite.
#[derive(Debug, Clone, PartialEq)]
pub struct Damage {
    /// The frame, from 0.
    pub frame: u64,
    /// The step it belongs to; 0 for the initial record.
    pub step: u32,
    /// Byte offset.
    pub offset: u64,
    /// The damage in words, without position.
    pub message: String,
}

/// Everything that judging one trace yields.
#[derive(Debug)]
pub struct Outcome {
    /// The verdict.
    pub overall: Overall,
    /// The residuals, also of an incomplete run.
    pub residuals: Residuals,
    /// Whether collisions passed; polynomials count as collisions. `None` without a verdict.
    pub collisions_passed: Option<bool>,
    /// Counts per kind of finding.
    pub counts: FindingCounts,
    /// Steps with at least one finding.
    pub wrong_steps: u64,
    /// The first finding of each kind that occurred, in the order of [`Kind::ALL`](super::Kind::ALL).
    pub examples: Vec<Finding>,
    /// The very first finding.
    pub first_divergence: Option<Finding>,
    /// Steps that were judged.
    pub steps_judged: u32,
    /// Steps of the scene.
    pub steps: u32,
    /// Records per step: 2 where the trace has mid records.
    pub records_per_step: u32,
    /// Why grading stopped early.
    pub stop: Option<Stop>,
    /// The first damage that the original's reading passes over in silence, see [`Damage`].
    pub damage: Option<Damage>,
    /// Judged steps whose records are damaged, or come after one that is. Their findings count for the original, but say
    /// nothing about the program that wrote the trace: they are no wrong steps, and no example is among them.
    pub damaged_steps: u32,
    /// Whether bytes follow the last record; the original never looks at them.
    pub trailing_bytes: bool,
    /// Root searches of the reference.
    pub searches: SearchCounts,
    /// What the fair rules say, if they were asked.
    pub fair: Option<Box<Judgement>>,
}

impl Outcome {
    /// Nothing judged yet.
    pub(super) fn empty(steps: u32) -> Self {
        Self {
            overall: Overall::None,
            residuals: Residuals::default(),
            collisions_passed: None,
            counts: FindingCounts::default(),
            wrong_steps: 0,
            examples: Vec::new(),
            first_divergence: None,
            steps_judged: 0,
            steps,
            records_per_step: 1,
            stop: None,
            damage: None,
            damaged_steps: 0,
            trailing_bytes: false,
            searches: SearchCounts::default(),
            fair: None,
        }
    }

    /// Keeps a finding if it is the first, or the first of its kind.
    pub(super) fn keep_first(&mut self, first: &Finding) {
        if self.first_divergence.is_none() {
            self.first_divergence = Some(*first);
        }
        if !self.examples.iter().any(|example| example.kind() == first.kind()) {
            self.examples.push(*first);
        }
    }

    fn conclude_fair(&mut self) {
        let Some(fair) = &mut self.fair else { return };
        let refusal = if self.stop.is_some() {
            Some(FairRefusal::Stopped)
        } else if self.damage.is_some() {
            Some(FairRefusal::Damaged)
        } else if self.trailing_bytes {
            Some(FairRefusal::TrailingBytes)
        } else {
            None
        };
        fair.conclude(refusal, self.steps_judged == self.steps);
    }

    /// Draws the verdict, when nothing stopped judging (oracle-behaviour.md 6).
    pub(super) fn conclude(&mut self) {
        self.conclude_fair();
        self.examples.sort_by_key(Finding::kind);
        if self.stop.is_some() {
            return;
        }
        let passed = self.counts.collisions() == 0;
        self.collisions_passed = Some(passed);
        // Strict, and NaN fails.
        let residuals_pass = self.residuals.with_bounds().iter().all(|(residual, bound)| residual < bound);
        let complete = self.steps_judged == self.steps;
        self.overall = if passed && residuals_pass && complete { Overall::Passed } else { Overall::Failed };
    }
}
