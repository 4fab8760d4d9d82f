//! Finds the likely mistake from findings.
//!
//! Does not use processes or reports. It takes the steps of a trace that the fair rules find wrong, finds the mistake
//! that reproduces them, and returns [`Explanation`]s, the likeliest first. These are values, from which reports make
//! sentences.
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

mod evidence;
mod excluded_mistakes;
mod explain;
mod heads;
mod known;
mod naming;
mod near;
mod not_finite;
pub mod polynomial;
mod sampling;
mod settled_trace;
mod stages;
mod written;

pub use excluded_mistakes::refuted_keys;
pub use explain::{explain, explain_kept};
pub use fosssim_findings::explanation::{
    About, Amount, ChangeCause, ChangeRatio, ChangedParticles, ChangedQuantity, CoefficientGuess, Detail, Example,
    ExamplePlace, ExampleValue, Explanation, Guess, ListGuess, LoopEnd, NanStage, NotFinite, OfPolynomials, PairCounts,
    PolynomialDetail, Quantity, QuantityGuess, Ratios, StageDetail, StageFault, StepRecord, StepStage, Substitute,
    Weight, WrongChange, WrongDecisions, WrongGeometric, WrongMotion, WrongNumber, WrongPairs, WrongPositions,
    WrongResponses, WrongVectors, WrongZoneRounds, WrongZones,
};
use fosssim_findings::explanation::{about, fault, guess};
pub use fosssim_student::{assignments::probe_scenes, plain::formula_in};
pub use heads::explain_together;
pub use known::{can_show, find_known, mistake_is_visible, reproduces};
pub use naming::is_named_in;
pub use near::{PairTrait, pair_traits};
pub use not_finite::not_finite;
pub use settled_trace::{SettledTrace, settle_trace};
pub use written::{is_written, milestone};

#[cfg(test)]
mod tests;
