//! Words that several reports share.
use fosssim_judge::PairWords;
use fosssim_model::sim::StepError;

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
    }
}
