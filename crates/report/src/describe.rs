//! Words that several reports share.
use fosssim_judge::PairWords;
use fosssim_model::sim::{Pair, StepError};

/// The message when judging a trace would take too long.
const BEYOND_BUDGET: &str = "up to here, judging took many times the work of the scene's own run, which is as much as a \
                             trace may ask for";

/// A pair as `detect --pair` takes it.
pub(crate) fn pair_key(pair: Pair) -> String {
    format!("{}:{},{}", pair.kind.short(), pair.first, pair.second)
}

/// The step of a computation without result, and what happened there.
#[must_use]
pub fn step_error(error: &StepError) -> (u32, String) {
    match error {
        StepError::RootSearch { step, pair } => {
            (*step, format!("the root search of {} would never end", PairWords(*pair)))
        }
        StepError::Newton { step } => (*step, "Newton's method of implicit-euler does not converge".to_owned()),
        StepError::VortexHessian { step } => {
            (*step, "a vortex force has no Hessian, which implicit integrators need".to_owned())
        }
        StepError::Work { step } => (*step, BEYOND_BUDGET.to_owned()),
    }
}

/// A computation without result, in words.
#[must_use]
pub fn no_result(error: &StepError) -> String {
    let (step, words) = step_error(error);
    format!("step {step} has no result, because {words}")
}
