//! The original's rule book: lock-step comparison (oracle-behaviour.md 4 to 6).
use super::{
    finding::{Finding, Kind},
    outcome::{Counts, Outcome},
    rules::Book,
};
use fosssim_model::{
    scene::Scene,
    sim::{Impulse, RootSearch},
    trace::LoggedImpulse,
};

/// How to judge.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Number of threads that judge steps; the results do not depend on it. 0 takes one per core, eight at most.
    pub threads: usize,
    /// Whether certificates may stand in for root searches.
    pub root_search: RootSearch,
    /// Stop after the first step with a finding (a hopeless run is cut short; the outcome then has no verdict).
    pub stop_at_first: bool,
    /// The book that decides where that is.
    pub stop_by: Book,
    /// Judge by the fair rules as well ([`Outcome::fair`]).
    pub fair: bool,
    /// Look at every step and every call by itself, the long way. The outcome is the same; it shows that it is.
    pub one_by_one: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            threads: 0,
            root_search: RootSearch::WhereNeeded,
            stop_at_first: false,
            stop_by: Book::Parity,
            fair: false,
            one_by_one: false,
        }
    }
}

/// Hears how judging goes, in the order of the steps whatever the number of threads. Methods do nothing by default.
pub trait Progress {
    /// The initial record has been read; judging begins.
    fn begins(&mut self) {}
    /// A step is about to be judged (from 1).
    fn step_begins(&mut self, _step: u32) {}
    /// A step has been judged.
    fn step_judged(&mut self, _step: u32, _remarks: &[Remark]) {}
    /// The same step holds something wrong; not called for what is left of damaged records.
    fn step_wrong(&mut self, _wrong: &WrongStep<'_>) {}
}

/// A step in which a book has found something.
#[derive(Debug, Clone, Copy)]
pub struct WrongStep<'a> {
    /// The step, from 1.
    pub step: u32,
    /// What the original's rules have found.
    pub parity: StepFindings<'a>,
    /// What the fair rules have found; empty when they were not asked. What only the whole trace tells, such as mixed forms, is
    /// not among it.
    pub fair: StepFindings<'a>,
}

/// What one book has found in one step.
#[derive(Debug, Clone, Copy)]
pub struct StepFindings<'a> {
    /// The first finding of each kind, in the order in which they were made.
    pub firsts: &'a [Finding],
    /// How many there are of each kind besides.
    pub more: Counts,
}

impl Progress for () {}

/// What the original prints about a step, in its order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Remark {
    /// A collision that the trace lacks.
    Missed(Impulse),
    /// A collision that the trace should not have.
    Superfluous(LoggedImpulse),
    /// A collision with another normal.
    WrongNormal {
        /// The trace's.
        actual: LoggedImpulse,
        /// The reference's.
        expected: Impulse,
    },
    /// So many findings of one kind about polynomials, one after the other.
    Polynomials(Kind, u32),
}

/// Judges a trace as the original does, in lock step with the reference: each step starts from the trace's own state,
/// takes over its mid record, and is compared with its end record (oracle-behaviour.md 4 to 6). Memory does not depend
/// on the trace's length. What follows the last record is not read, save for one byte that tells whether it is there.
pub fn judge<R: std::io::Read + Send>(
    scene: &Scene,
    mut trace: R,
    options: &Options,
    progress: &mut dyn Progress,
) -> Outcome {
    super::replay::judge(scene, &mut trace, options, progress)
}
