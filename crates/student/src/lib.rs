//! A second simulator, which can make mistakes; it simulates a student's submission.
//!
//! It is written separately from [`fosssim_model::sim`], and makes documented mistakes of the [`CATALOG`] on request.
//! The catalog also contains correct variants. The sample program is this simulator with arguments and a file.
//! `diagnose` uses it to find the mistake that reproduces a submission. It is **never used for judging**: verdicts come
//! only from [`fosssim_model::sim`]. It uses no files and no processes, and prints nothing.
//!
//! The mathematics is that of `simulation.md` and `collisions.md`. The crates below supply the course's parts: the
//! scene, the vectors, the linear solver and the root finder. They also supply the right polynomials, which mistakes
//! change.
#![forbid(unsafe_code)]
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

pub mod assignments;
mod author;
mod continuous_time;
mod detection;
mod failsafe;
mod false_positives;
mod forces;
pub mod formula_detector;
mod hessians;
mod hybrid;
mod impulses;
mod integrators;
mod logged_polynomials;
mod near_pairs;
mod objects;
mod penalty;
mod record;
mod response;
mod rounding;
mod simple;
mod slip_effects;
mod step;
mod step_failure;
mod world;
mod zones;

pub use crate::assignments::{
    all::{all_rows, find},
    rows::{Area, RowKind},
    states::{Edit, Slip, StepMistake, TERMS, Term},
    t2m2::{CATALOG, Mistake, Row},
};
pub use author::Student;
pub use detection::body_polynomials;
pub use false_positives::FALSE_POSITIVES;
pub use objects::{Contact, Object, Pair, State};
pub use record::{Record, record_limited_trace, record_trace};
pub use step::step;
pub use step_failure::StepFailure;
pub use world::{StepGuard, StepLog, World};
