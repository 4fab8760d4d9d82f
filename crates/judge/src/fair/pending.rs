//! Polynomials that are right only with some factors, or only in one of two forms.
use fosssim_findings::{Finding, fair::Form};
use fosssim_model::sim::PairKind;

/// The factors of a polynomial that none makes right: it is so in the other form only.
pub(super) const NONE: [f64; 2] = [f64::INFINITY, 0.0];

/// Polynomials of a kind and form, claims or not, that are right if the program's polynomials of that kind have a
/// factor within bounds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pending {
    /// Kind of pair and number of the polynomial.
    pub place: (PairKind, usize),
    /// The form in which they are right; any form, if there is only one.
    pub form: Form,
    /// Whether they claim factors of their own, and show none.
    pub is_claim: bool,
    /// The number of them in the step.
    pub count: u64,
    /// The greatest of the least factors that they need, and the finding otherwise.
    pub least: (f64, Finding),
    /// The least of the greatest factors that they allow, and the finding otherwise.
    pub most: (f64, Finding),
}

impl Pending {
    /// Returns the finding, if there is one, for program factors between these.
    pub fn finding(&self, [low, high]: [f64; 2]) -> Option<Finding> {
        // Factors are known except for rounding.
        let room = 1e-9;
        let (least, most) = (self.least, self.most);
        if !(least.0 <= high * (1.0 + room)) {
            return Some(least.1);
        }
        (!(most.0 >= low * (1.0 - room))).then_some(most.1)
    }

    /// Returns whether it counts in a trace of this form.
    pub fn is_of(&self, form: Form) -> bool {
        self.form == Form::Either || self.form == form
    }
}
