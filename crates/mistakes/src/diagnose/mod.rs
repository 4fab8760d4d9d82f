//! From findings to the likely mistake.
//!
//! Knows nothing of processes and reports. It looks at the steps of a trace that the fair rules find wrong, asks which
//! mistake reproduces them, and yields [`Explanation`]s, the likeliest first: values, of which reports make sentences.
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

mod about;
mod detail;
mod example;
mod explain;
mod explanation;
mod fault;
mod guess;
mod heads;
mod known;
mod not_finite;
pub mod polynomial;
mod sampling;
mod settled;
mod stages;

pub use crate::{assignments::probe_scenes, plain::formula_in};
pub use about::{About, OfPolynomials};
pub use detail::{Amount, Detail, PolynomialDetail, Ratios, StageDetail, Stand, Weight};
pub use example::{Example, ExamplePlace, ExampleValue, StepRecord};
pub use explain::{explain, explain_kept, explain_stages};
pub use explanation::Explanation;
pub use fault::{
    Changed, LoopEnd, NanStage, NotFinite, Quantity, StageFault, StepStage, WrongDecisions, WrongGeometric,
    WrongMotion, WrongNumber, WrongPositions, WrongResponses, WrongVectors, WrongZoneRounds, WrongZones,
};
pub use guess::{CoefficientGuess, Guess, ListGuess, QuantityGuess};
pub use heads::{common, refuted, several};
pub use known::{known, shows};
pub use not_finite::not_finite;
pub use settled::{Settled, settled};

#[cfg(test)]
mod tests;
