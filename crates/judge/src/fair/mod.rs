//! The fair rule book. No correct program fails because of round-off, scale or the course's own slip, and no wrong
//! program passes because of an absolute tolerance (numerics.md 2).
//!
//! It judges one step as follows:
//!
//! 1. It rebuilds the log that the submission should have written from *its own* states. It follows the submission: it
//!    finds the roots of the submission's polynomials, responds to its logged contacts, and begins the geometric part
//!    at its mid record. A mistake is therefore counted once, at the stage where it is made. If the time of impact of
//!    its polynomials is the reference's except for round-off, the reference's time is used. If right polynomials lead
//!    the root finder to a decision that differs from the reference's, both decisions are accepted.
//! 2. A polynomial may have any positive factor; each coefficient may be off by [`FAIR_UNITS`] times its running error
//!    bound. A small leading coefficient may be missing, because the course's library drops it. The factor must make it
//!    small: either two coefficients show this factor, or it is usual in the trace, which is known only at the trace's
//!    end. NaN fails.
//! 3. States may be off by [`FAIR_UNITS`] roundings of the scene's size. If that is too little, they may be off by
//!    [`FAIR_SENSITIVITY_FACTOR`] times the effect of such roundings of the step's input on its result.
//! 4. A decision that such roundings can change is borderline: it is followed and counted as borderline, never as
//!    wrong. However, the normal and the time of such a collision must be right. Coefficients that were lost because of
//!    a factor do not count as round-off: decisions and times of impact are compared with those of the whole
//!    polynomials. Coefficients that a factor keeps, although the course's library drops them from the reference's
//!    polynomials, are followed.
//! 5. It checks everything: the first record, mid records, times of impact, repeated contacts, and bytes after the last
//!    record.
//! 6. A step from or to a state that has no meaningful continuation is never right, unless the reference itself reaches
//!    such a state.
//!
//! A step with records identical to the reference's needs none of this. Polynomials that are right by a wide margin
//! (`follower::quick_matches`) need no bounds.
//!
//! [`FAIR_UNITS`]: fosssim_num::tolerances::FAIR_UNITS
//! [`FAIR_SENSITIVITY_FACTOR`]: fosssim_num::tolerances::FAIR_SENSITIVITY_FACTOR

mod borderline;
mod cause;
pub mod compare;
mod contact;
mod context;
mod factors;
mod follower;
pub mod formulas;
mod judgment;
mod ordinary_range;
mod pending_polynomials;
mod polynomial;
mod probe;
mod reach;
mod step;
mod step_judgment;
#[cfg(test)]
mod tests;
mod unapplied_pairs;

pub use borderline::find_borderline;
pub use cause::find_cause;
pub use contact::certain_decision;
pub(super) use context::{Context, Records};
pub use fosssim_findings::{
    Cause,
    fair::{Borderline, FairRejection, FairVerdict, Form, Judgment, Shares},
};
pub(super) use judgment::JudgmentBuilder;
pub(super) use probe::{PERTURBED_RUNS, perturb};
pub(super) use reach::ExtraordinarySteps;
pub(super) use step::{judge_initial_record, judge_records};
pub(super) use step_judgment::StepJudgment;
pub use unapplied_pairs::count_applications;
