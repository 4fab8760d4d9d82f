//! Measured processor times of one scene, for points for speed.
use super::verdict::Verdict;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// The timed runs of one scene.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Timing {
    /// The name of the machine on which the times were measured. Times of different machines are not compared.
    pub machine: String,
    /// The timed runs, in the order in which they were made.
    pub runs: Vec<TimedRun>,
    /// The verdict on a timed run, if it differs from that on the graded run. No further runs were timed after it.
    pub failed: Option<Verdict>,
}

/// The processor times of two consecutive runs: one of the submission, and one of the reference program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct TimedRun {
    /// The processor time of the submission.
    pub submission: Duration,
    /// The processor time of the reference program.
    pub reference: Duration,
}
