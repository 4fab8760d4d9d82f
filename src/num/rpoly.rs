//! All zeros of one real polynomial by the Jenkins-Traub algorithm, bit for bit as the original.

/// The search would never end: a coefficient is not finite (root-finder.md 9.4), or the Newton iteration of the bound
/// cycles among subnormal numbers (9.5). The original hangs here.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the root search does not terminate")]
pub struct DoesNotTerminate;
