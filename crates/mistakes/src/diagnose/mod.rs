//! Finds the likely mistakes of a program from its wrong traces.
//!
//! This module uses neither processes nor reports. It takes the steps of a trace that the fair rules find wrong, finds
//! the mistake that reproduces them, and returns [`Explanation`]s, the likeliest first. These are values, from which
//! reports make sentences.
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

mod corrected_trace;
mod evidence;
mod excluded_mistakes;
mod explain;
mod joint_explanation;
mod known;
mod naming;
mod near_pairs;
mod non_finite;
pub mod polynomial;
mod sampling;
mod stages;
mod student_code;

pub use corrected_trace::{CorrectedTrace, correct_trace};
pub use excluded_mistakes::refuted_keys;
pub use explain::{explain, explain_kept_trace};
pub use fosssim_findings::explanation::{
    Amount, ChangeRatio, ChangedParticles, ChangedQuantity, CoefficientGuess, Detail, Example, ExamplePlace,
    ExampleValue, Explanation, ExplanationTopic, GeometricPartError, Guess, ListGuess, LoopEnd, NanStage,
    NonFiniteValue, PairCounts, PolynomialDetail, PolynomialEvidence, Quantity, QuantityGuess, Ratios, RoundCountError,
    StageDetail, StageFault, StepRecord, StepStage, Substitute, Weight, WrongChange, WrongDecisions, WrongMotion,
    WrongPairs, WrongPositions, WrongResponses, WrongVectors, WrongZoneRounds, WrongZones,
};
use fosssim_findings::explanation::{fault, guess, topic};
pub use fosssim_student::{assignments::probe_scenes, formula_detector::find_formula};
pub use joint_explanation::explain_together;
pub use known::{find_known, may_change_trace, mistake_is_visible, reproduces};
pub use naming::is_named_in;
pub use near_pairs::{PairTrait, pair_traits};
pub use non_finite::explain_non_finite_value;
pub use student_code::{find_milestone, is_written_by_student};

#[cfg(test)]
mod tests;
