//! The result of judging one trace.
use super::{fair, parity};
use fosssim_model::{
    assignments::CollisionType,
    sim::{SearchCounts, StepError},
    trace::{Malformation, ReadFailure},
};

/// The reason why grading stopped before its end.
#[derive(Debug, Clone)]
pub enum Stop {
    /// The trace cannot be read further. The original reports this error and stops.
    Trace {
        /// The frame that could not be read, from 0.
        frame: u64,
        /// The step of that frame; 0 for the initial record.
        step: u32,
        /// The reason why it could not be read.
        cause: ReadFailure,
        /// The byte offset of the damage.
        offset: u64,
        /// The kind of damage.
        what: Malformation,
    },
    /// Judging needed more work than is allowed, or a step has no result by the original's rules.
    Step(StepError),
}

/// Damage that the original's reader skips silently.
pub use fosssim_model::trace::TraceError as Damage;

/// The result of judging one trace.
#[derive(Debug)]
pub struct Outcome {
    /// The judgement by the original's rules.
    pub parity: parity::Judgement,
    /// The judgement by the fair rules, if requested.
    pub fair: Option<Box<fair::Judgement>>,
    /// The number of judged steps.
    pub steps_judged: u32,
    /// The number of steps of the scene.
    pub steps: u32,
    /// The scene's collision handling.
    pub collisions: CollisionType,
    /// The reason why grading stopped early.
    pub stop: Option<Stop>,
    /// The first damage that the original's reader skips silently.
    pub damage: Option<Damage>,
    /// The number of judged steps whose records are damaged, or come after a damaged one. Findings in such steps count
    /// for the original, but prove nothing about the program. The steps do not count as wrong, and give no examples.
    pub damaged_steps: u32,
    /// Whether bytes follow the last record, which the original does not read.
    pub trailing_bytes: bool,
    /// The number of root searches of the reference.
    pub searches: SearchCounts,
}

impl Outcome {
    /// Creates the outcome before the first step is judged.
    #[must_use]
    pub fn empty(steps: u32) -> Self {
        Self {
            parity: parity::Judgement::default(),
            fair: None,
            steps_judged: 0,
            steps,
            collisions: CollisionType::None,
            stop: None,
            damage: None,
            damaged_steps: 0,
            trailing_bytes: false,
            searches: SearchCounts::default(),
        }
    }

    /// Sets the verdict of the original's rules.
    pub fn conclude(&mut self) {
        self.parity.conclude(self.stop.is_some(), self.steps_judged == self.steps);
    }
}
