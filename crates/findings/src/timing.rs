//! Measured times of one scene, for points for speed.
use super::verdict::Verdict;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// The timed runs of one scene.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Timing {
    /// The name of the machine that measured. Times that were measured on different machines are not compared.
    pub machine: String,
    /// The runs, in the order of time.
    pub runs: Vec<TimedRun>,
    /// The verdict of a timed run that differs from the graded run's; it ended the timing.
    pub failed: Option<Verdict>,
}

/// The processor times of two consecutive runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct TimedRun {
    /// The submission's time.
    pub submission: Duration,
    /// The reference program's time.
    pub reference: Duration,
}
