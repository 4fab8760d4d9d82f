//! Reports the progress of judging.
use super::{
    counts::FindingCounts,
    finding::{Finding, FindingKind},
};
use fosssim_model::{sim::Impulse, trace::LoggedImpulse};

/// Observes the progress of judging. Steps are reported in order, even if several threads judge them. Methods do
/// nothing by default.
pub trait Progress {
    /// Observes the start of judging, after the initial record has been read.
    fn observe_begin(&mut self) {}
    /// Observes that a step is about to be judged; steps count from 1.
    fn observe_step_begin(&mut self, _step: u32) {}
    /// Observes that a step has been judged.
    fn observe_step_end(&mut self, _step: u32, _remarks: &[Remark]) {}
    /// Observes a step with a fault. It is not called for the rest of damaged records.
    fn observe_wrong_step(&mut self, _wrong: &WrongStep<'_>) {}
}

/// A step with findings of at least one rule book.
#[derive(Debug, Clone, Copy)]
pub struct WrongStep<'a> {
    /// The step, from 1.
    pub step: u32,
    /// The findings by the original's rules.
    pub parity: StepFindings<'a>,
    /// The findings by the fair rules, empty if these rules were not requested. Findings that only the whole trace
    /// shows, such as mixed forms, are not included.
    pub fair: StepFindings<'a>,
}

/// The findings of one book in one step.
#[derive(Debug, Clone, Copy)]
pub struct StepFindings<'a> {
    /// The first finding of each kind, in the order in which they were made.
    pub first_findings: &'a [Finding],
    /// The number of further findings of each kind.
    pub further_counts: FindingCounts,
}

impl Progress for () {}

/// Two observers that are called one after the other.
pub struct ObserverPair<'a>(pub &'a mut dyn Progress, pub &'a mut dyn Progress);

impl Progress for ObserverPair<'_> {
    fn observe_begin(&mut self) {
        self.0.observe_begin();
        self.1.observe_begin();
    }

    fn observe_step_begin(&mut self, step: u32) {
        self.0.observe_step_begin(step);
        self.1.observe_step_begin(step);
    }

    fn observe_step_end(&mut self, step: u32, remarks: &[Remark]) {
        self.0.observe_step_end(step, remarks);
        self.1.observe_step_end(step, remarks);
    }

    fn observe_wrong_step(&mut self, wrong: &WrongStep<'_>) {
        self.0.observe_wrong_step(wrong);
        self.1.observe_wrong_step(wrong);
    }
}

/// A line that the original prints about a step, in the original's order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Remark {
    /// A collision that the trace lacks.
    Missed(Impulse),
    /// A collision that the trace should not have.
    Superfluous(LoggedImpulse),
    /// A collision with a wrong normal.
    WrongNormal {
        /// The trace's impulse.
        actual: LoggedImpulse,
        /// The reference's impulse.
        expected: Impulse,
    },
    /// A number of consecutive findings of one kind about polynomials.
    Polynomials(FindingKind, u32),
}
