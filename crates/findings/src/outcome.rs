//! The result of judging one trace.
use super::{fair, parity};
use fosssim_model::{
    assignments::CollisionType,
    sim::StepError,
    trace::{ReadFailure, TraceFormatError},
};

/// The reason why judging stopped before the end of the trace.
#[derive(Debug, Clone)]
pub enum Stop {
    /// The trace cannot be read any further. The original reports this error and stops, too.
    Trace {
        /// The index of the record that could not be read, from 0.
        frame: u64,
        /// The step to which the record belongs, from 1; 0 is the initial record.
        step: u32,
        /// The part of the record that could not be read, or why.
        cause: ReadFailure,
        /// The position of the damage in the file, in bytes.
        offset: u64,
        /// The kind of damage.
        what: TraceFormatError,
    },
    /// Judging needed more work than is allowed, or a step has no result by the original's rules.
    Step(StepError),
}

/// Damage that the original's reader skips silently.
pub use fosssim_model::trace::TraceError as Damage;

/// The result of judging one trace.
#[derive(Debug)]
pub struct Outcome {
    /// The judgment of the trace by the original's rules.
    pub parity: parity::Judgment,
    /// The judgment of the trace by the fair rules, if it was requested.
    pub fair: Option<Box<fair::Judgment>>,
    /// The number of steps that were judged.
    pub steps_judged: u32,
    /// The number of steps of the scene.
    pub steps: u32,
    /// The collision handling that the scene uses.
    pub collisions: CollisionType,
    /// The reason why judging stopped early; `None` if it reached the end.
    pub stop: Option<Stop>,
    /// The first damage that the original's reader skips without a message.
    pub damage: Option<Damage>,
    /// The number of judged steps whose records are damaged or follow a damaged one. In such steps, findings count for
    /// the original, but prove nothing about the program. The steps do not count as wrong, and do not provide examples.
    pub damaged_steps: u32,
    /// Whether bytes follow the last record. The original does not read them.
    pub trailing_bytes: bool,
}

impl Outcome {
    /// Creates the outcome for a trace before its first step is judged.
    pub fn empty(steps: u32) -> Self {
        Self {
            parity: parity::Judgment::default(),
            fair: None,
            steps_judged: 0,
            steps,
            collisions: CollisionType::None,
            stop: None,
            damage: None,
            damaged_steps: 0,
            trailing_bytes: false,
        }
    }

    /// Sets the verdict of the original's rules.
    pub fn conclude(&mut self) {
        self.parity.conclude(self.stop.is_some(), self.steps_judged == self.steps);
    }
}
