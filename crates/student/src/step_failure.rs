//! The reasons why a step of a student's program is not completed.
use fosssim_num::rpoly::DoesNotTerminate;

/// The reason why a step is not completed.
#[derive(Debug, thiserror::Error)]
pub enum StepFailure {
    /// The course's root finder would search forever.
    #[error("the root finder would search forever: a polynomial is not finite")]
    RootFinder(#[from] DoesNotTerminate),
    /// Newton's method cycles without converging.
    #[error("implicit-euler does not converge")]
    Newton,
    /// A vortex force cannot be integrated implicitly.
    #[error("no addHessXToTotal defined for VortexForce")]
    VortexHessian,
    /// The guard of [`StepLog`](super::StepLog) stopped the step at a polynomial, because the caller has enough
    /// information. A step with a guard also stops after too many rounds or impact zones.
    #[error("the caller rejected a polynomial, so the step was stopped")]
    Stopped,
}
