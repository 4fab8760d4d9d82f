//! The reference simulator: state, forces, integrators, collision handling.
//!
//! [`Simulation::step`] fails only with a typed numerical outcome. It does no I/O, reads no clock, starts no thread and
//! prints nothing; all results go to an [`Observer`]. The mathematics is that of `simulation.md` and `collisions.md`,
//! evaluated in the order given there.
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

mod bodies;
mod collision;
mod forces;
mod integrators;
mod matrix;
mod nearby;
mod observer;
mod pair;
mod pairs;
mod polynomial_bytes;
#[cfg(test)]
mod samples;
mod search;
mod simulation;
mod state;
mod step_error;

pub use collision::{PairMotion, PointMotion, formulas};
pub use forces::{PenaltyPairs, PenaltyTerms, SweepOrder, gradients};
pub use integrators::min_work;
pub use observer::{
    Decision, Detection, ImpactTime, Impulse, Observer, Pass, ResumeState, Stage, SteeringObserver, StepController,
    WantedPairs, Zone,
};
pub use pair::{Pair, PairKind, PairKindMap};
pub use pairs::{Pairs, pairs};
pub use polynomial_bytes::PolynomialBytes;
pub use search::{RootSearch, SearchCounts};
pub use simulation::Simulation;
pub use state::State;
pub use step_error::StepError;
