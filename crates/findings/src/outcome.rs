//! The verdict on one trace.
use super::{fair, parity};
use fosssim_model::{
    assignments::CollisionType,
    sim::{SearchCounts, StepError},
    trace::{Malformation, Unreadable},
};

/// The reason why grading stopped before its end.
#[derive(Debug, Clone)]
pub enum Stop {
    /// The trace can't be read further; the original reports that and stops.
    Trace {
        /// The frame that could not be read, from 0.
        frame: u64,
        /// The step to which it belongs; 0 for the initial record.
        step: u32,
        /// The reason why it could not be read.
        cause: Unreadable,
        /// Byte offset of the damage.
        offset: u64,
        /// The damage.
        what: Malformation,
    },
    /// Judging took more work than a trace may cause; or, by the original's rules, a step has no result.
    Step(StepError),
}

/// Damage that the original's reading passes over in silence.
pub use fosssim_model::trace::TraceError as Damage;

/// The result of judging one trace.
#[derive(Debug)]
pub struct Outcome {
    /// The judgement by the original's rules.
    pub parity: parity::Judgement,
    /// The judgement by the fair rules, if requested.
    pub fair: Option<Box<fair::Judgement>>,
    /// Steps that were judged.
    pub steps_judged: u32,
    /// Steps of the scene.
    pub steps: u32,
    /// The scene's collision handling.
    pub collisions: CollisionType,
    /// The reason why grading stopped early.
    pub stop: Option<Stop>,
    /// The first damage that the original's reading passes over in silence, see [`Damage`].
    pub damage: Option<Damage>,
    /// Judged steps whose records are damaged, or come after one that is. Their findings count for the original, but
    /// prove nothing about the program that wrote the trace: they are no wrong steps, and no example is among them.
    pub damaged_steps: u32,
    /// Whether bytes follow the last record; the original never reads them.
    pub trailing_bytes: bool,
    /// Root searches of the reference.
    pub searches: SearchCounts,
}

impl Outcome {
    /// Creates the account when nothing is judged yet.
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

    /// Draws the verdict of the original's rules.
    pub fn conclude(&mut self) {
        self.parity.conclude(self.stop.is_some(), self.steps_judged == self.steps);
    }
}
