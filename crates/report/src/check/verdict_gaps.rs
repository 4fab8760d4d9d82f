//! Checks that commands make on an outcome before they report it.
use fosssim_findings::{Outcome, Overall, Stop};
use fosssim_judge::{ReadFailure, fair::FairVerdict};
use fosssim_model::sim::StepError;

/// Returns whether there is something to explain: whether the fair rules reject the trace or, if they were not used,
/// whether the original's rules do not accept it.
pub fn needs_explanation(outcome: &Outcome) -> bool {
    match &outcome.fair {
        Some(fair) => fair.verdict == FairVerdict::Rejected,
        None => outcome.parity.overall != Overall::Passed,
    }
}

/// Returns the reason why no trace of this scene can get a verdict; `None` for nearly all scenes.
pub fn describe_no_verdict(outcome: &Outcome, scene: &str) -> Option<String> {
    match outcome.parity.endless_step {
        Some(StepError::VortexHessian { .. }) => Some(format!(
            "the scene {scene} has a vortexforce, which has no Hessian: choose an integrator that is not implicit"
        )),
        _ => None,
    }
}

/// Returns the message about a trace that could not be read to its end, and therefore has no verdict.
pub fn describe_unread(outcome: &Outcome, trace: &str, error: &str) -> String {
    let place = match &outcome.stop {
        Some(Stop::Trace { cause: ReadFailure::Io, offset, .. }) => format!(" at byte {offset}"),
        _ => String::new(),
    };
    format!("cannot read the trace {trace}{place}: {error}")
}
