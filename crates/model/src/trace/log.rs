//! The part of a trace that a step writes: its lists, and when which of them is part of a record (trace-format.md 2).
use super::{
    encode::{self, Encoded},
    frame::LoggedImpulse,
};
use crate::sim::{Detection, Impulse, Pass, PolynomialBytes, Stage};

/// The lists of a step so far, as a trace holds them.
#[derive(Debug, Clone, Default)]
pub(super) struct Log {
    /// Impulses.
    pub(super) impulses: Encoded,
    /// Polynomials.
    pub(super) polynomials: PolynomialBytes,
    /// Whether the responses of the current pass reach the trace: those of `hybrid` never do.
    logs_impulses: bool,
}

impl Log {
    /// A step begins, with empty lists.
    pub(super) fn begin_step(&mut self) {
        self.polynomials.clear();
        self.begin_step_behind();
    }

    /// The same; polynomials of earlier steps are kept.
    pub(super) fn begin_step_behind(&mut self) {
        self.impulses.clear();
        self.polynomials.begin();
        self.logs_impulses = false;
    }

    /// A detection pass begins.
    pub(super) fn begin_pass(&mut self, pass: Pass) {
        self.logs_impulses = matches!(pass.stage, Stage::Simple | Stage::ContinuousTime);
    }

    /// Appends the polynomials of one call.
    pub(super) fn detection(&mut self, detection: &Detection<'_>) {
        detection.polynomials.iter().for_each(|polynomial| self.polynomials.push(polynomial.coefficients()));
    }

    /// Appends an impulse, if it belongs to the trace.
    pub(super) fn impulse(&mut self, impulse: &Impulse) {
        if self.logs_impulses {
            encode::impulse(&mut self.impulses.bytes, &LoggedImpulse::from(*impulse));
            self.impulses.count += 1;
        }
    }
}
