//! The part of a trace that a step writes: its lists, and when they are added to a record (trace-format.md 2).
use super::{
    encode::{self, IMPULSE_BYTES},
    frame::LoggedImpulse,
    layout::Layout,
};
use crate::sim::{Detection, Impulse, Pass, PolynomialBytes, Stage, State};

/// The lists of a step so far, in the bytes of a trace.
#[derive(Debug, Clone, Default)]
pub(super) struct Log {
    /// The bytes of the impulses.
    impulses: Vec<u8>,
    /// The polynomials of the step.
    pub(super) polynomials: PolynomialBytes,
    /// Whether the trace logs the responses of the current pass; those of `hybrid` are never logged.
    logs_impulses: bool,
}

impl Log {
    /// Begins a step with empty lists.
    pub(super) fn begin_step(&mut self) {
        self.polynomials.clear();
        self.begin_next_step();
    }

    /// Begins a step, and keeps the polynomials of earlier steps.
    pub(super) fn begin_next_step(&mut self) {
        self.impulses.clear();
        self.polynomials.begin_list();
        self.logs_impulses = false;
    }

    /// Begins a detection pass.
    pub(super) fn begin_pass(&mut self, pass: Pass) {
        self.logs_impulses = matches!(pass.stage, Stage::Simple | Stage::ContinuousTime);
    }

    /// Appends the polynomials of one call.
    pub(super) fn append_detection(&mut self, detection: &Detection<'_>) {
        detection.polynomials.iter().for_each(|polynomial| self.polynomials.push(polynomial.coefficients()));
    }

    /// Appends an impulse, if the trace logs it.
    pub(super) fn append_impulse(&mut self, impulse: &Impulse) {
        if self.logs_impulses {
            encode::encode_impulse(&mut self.impulses, &LoggedImpulse::from(*impulse));
        }
    }

    /// Returns the number of impulses.
    pub(super) fn impulse_count(&self) -> usize {
        self.impulses.len() / IMPULSE_BYTES
    }

    /// Appends a record with the current lists, without its polynomials.
    pub(super) fn write_head(&self, out: &mut Vec<u8>, layout: Layout, state: &State) {
        encode::append_state(out, state);
        if layout.has_impulses {
            encode::append_count(out, self.impulse_count());
            out.extend_from_slice(&self.impulses);
        }
        if layout.has_polynomials {
            encode::append_count(out, self.polynomials.count());
        }
    }
}
