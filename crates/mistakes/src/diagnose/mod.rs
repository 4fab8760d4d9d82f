//! From findings to the likely mistake.
//!
//! Knows nothing of processes and reports. It looks at the steps of a trace that the fair rules find wrong, asks which
//! mistake reproduces them, and yields [`Explanation`]s, the likeliest first.
#![forbid(unsafe_code)]
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

mod about;
mod explain;
mod explanation;
mod known;
mod notation;
pub mod outside;
pub mod polynomial;
mod samples;
mod stages;

pub use crate::{assignments::probe_scenes, plain::formula_in};
pub use about::{About, OfPolynomials, StepStage};
pub use explain::{common, explain, refuted, several};
pub use explanation::{Example, ExampleValue, Explanation};
pub use known::{known, shows};

#[cfg(test)]
mod tests;
