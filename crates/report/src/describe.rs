//! Texts that appear in several reports.
use fosssim_judge::MissingResult;
use fosssim_model::sim::{Pair, StepError};

/// Returns a pair as text, in the form that `detect --pair` accepts.
pub fn pair_key(pair: Pair) -> String {
    format!("{}:{},{}", pair.kind.short(), pair.first, pair.second)
}

/// Returns a sentence about a step whose computation has no result.
pub fn describe_step_error(error: &StepError) -> String {
    format!("step {} has no result, because {}", error.step(), MissingResult(*error))
}
