//! Measured times of one scene, for points for speed.
use super::verdict::Verdict;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// The timed runs of one scene.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Timing {
    /// The machine on which it was measured. Times of two machines are never compared.
    pub machine: String,
    /// The runs in their order.
    pub runs: Vec<TimedRun>,
    /// The verdict of a timed run that did not end as the graded one did; no further run was timed then.
    pub failed: Option<Verdict>,
}

/// Processor times of two runs, one after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct TimedRun {
    /// The submission's time.
    pub submission: Duration,
    /// The reference program's time.
    pub reference: Duration,
}
