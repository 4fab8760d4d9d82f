//! The reference simulator: state, forces, integrators, collision handling.
//!
//! [`Simulation::step`] fails only with a typed numerical outcome. It never does I/O, reads no clock, starts no
//! thread and prints nothing; everything it computes reaches an [`Observer`]. The mathematics is that of
//! `simulation.md` and `collisions.md`, evaluated in the order given there.
#![forbid(unsafe_code)]
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

mod bodies;
mod collision;
mod forces;
mod integrators;
mod observer;
mod pairs;
mod polynomial_bytes;
#[cfg(test)]
mod samples;
mod simulation;

pub use collision::{PairMotion, PointMotion};
pub use observer::{Decision, Detection, Impulse, Observer, Pair, PairKind, Pass, Resume, Stage, Time, Wanted, Zone};
pub use pairs::{ByKind, Pairs, pairs};
pub use polynomial_bytes::PolynomialBytes;
pub use simulation::{RootSearch, SearchCounts, Simulation, State, StepError};
