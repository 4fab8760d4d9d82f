//! Texts that several reports share.
use fosssim_judge::WithoutResult;
use fosssim_model::sim::{Pair, StepError};

/// Returns a pair in the form that `detect --pair` accepts.
#[must_use]
pub fn pair_key(pair: Pair) -> String {
    format!("{}:{},{}", pair.kind.short(), pair.first, pair.second)
}

/// Returns a sentence about a computation without a result.
#[must_use]
pub fn no_result(error: &StepError) -> String {
    format!("step {} has no result, because {}", error.step(), WithoutResult(*error))
}
