//! Keeps polynomials that are right only with certain factors, or only in one of two forms.
use fosssim_findings::{Finding, fair::Form};
use fosssim_model::sim::PairKind;

/// The empty range of factors, for a polynomial that is right only in the other form.
pub(super) const NO_FACTORS: [f64; 2] = [f64::INFINITY, 0.0];

/// The reason why polynomials are right only if the program's factor has certain values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PendingCause {
    /// The polynomials lack coefficients that the course's library drops with some factors.
    Missing,
    /// The polynomials show no factor themselves, but are right only if the program's factor has certain values.
    Claim,
    /// The polynomials are larger than round-off, although the right ones are only round-off. A program that divides
    /// polynomials by their size has such polynomials, and its factors differ from polynomial to polynomial.
    RoundOff,
}

/// Polynomials of one kind, form and cause. The polynomials are right if the program's factor for their kind is
/// within the bounds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PendingPolynomials {
    /// The kind of pair and the number of the polynomial.
    pub place: (PairKind, usize),
    /// The form in which the polynomials are right. If there is only one form, any form is accepted.
    pub form: Form,
    /// The reason why the polynomials depend on the program's factor.
    pub cause: PendingCause,
    /// The number of such polynomials in the step.
    pub count: u64,
    /// The largest lower bound of the factors, and the finding for smaller factors.
    pub least_factor: (f64, Finding),
    /// The smallest upper bound of the factors, and the finding for larger factors.
    pub greatest_factor: (f64, Finding),
}

impl PendingPolynomials {
    /// Returns the finding for program factors between `low` and `high`, if there is one.
    pub fn finding(&self, [low, high]: [f64; 2]) -> Option<Finding> {
        // The factors are known only up to rounding errors.
        let room = 1e-9;
        let (min_factor, max_factor) = (self.least_factor, self.greatest_factor);
        if !(min_factor.0 <= high * (1.0 + room)) {
            return Some(min_factor.1);
        }
        (!(max_factor.0 >= low * (1.0 - room))).then_some(max_factor.1)
    }

    /// Returns whether the polynomials are judged in a trace of this form.
    pub fn counts_for_form(&self, form: Form) -> bool {
        self.form == Form::Either || self.form == form
    }
}
