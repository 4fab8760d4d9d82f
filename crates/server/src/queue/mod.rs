//! The queue of jobs. Its statements run within the caller's transaction, so a job is enqueued together with its
//! upload, and finished together with its result.
//!
//! A worker **claims** a job for the time of a lease, which the worker **renews**. The worker then **finishes** the
//! job, gives it back (**releases** it) or reports that it **failed**. Every claim has a number, the attempt, and a key
//! that only the worker knows. Every message of a worker must contain both, so that a worker without a valid lease
//! changes nothing. After a failure, a job waits for another try, longer each time. After [`QueuePolicy::max_failures`]
//! failures it is **given up**: it is not tried again, and staff must check it. The loss of a worker does not count as
//! a failure of the job. However, a job whose workers were lost very often is given up, too. The modules that use the
//! queue define the jobs and their results.

mod claim;
mod enqueue;
mod lease;
mod notifier;
mod queue_position;
mod tick;

pub use claim::{Claimant, claim, is_due};
pub use enqueue::{JobOwner, NewJob, enqueue, is_waiting};
pub use lease::{CompletionEffect, FailureEffect, Progress, complete, fail, payload, release, renew};
pub use notifier::{Notifier, Subscription};
pub use queue_position::{QueuePosition, find_queue_position, find_time_left};
pub use tick::{GivenUpJob, Tick, tick};

use serde::{Deserialize, Serialize};
use std::time::Duration;
use utoipa::ToSchema;

/// The kind of work that a job needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JobKind {
    /// A worker grades a submission.
    Grading,
    /// The service itself sends scores to a learning platform.
    Passback,
}

impl JobKind {
    /// Returns the kind's name, as the table of jobs stores it (column `lane`).
    pub fn name(self) -> &'static str {
        match self {
            Self::Grading => "grading",
            Self::Passback => "passback",
        }
    }
}

/// The maximum wait until the next try that a platform can request.
const MAX_PLATFORM_WAIT: Duration = Duration::from_secs(86_400);

/// The time limits and the numbers of tries in the queue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct QueuePolicy {
    /// The maximum time between two reports of a worker.
    pub lease: Duration,
    /// The number of failures after which a job is given up.
    pub max_failures: u32,
    /// The wait after the first failure. After each further failure the wait is four times as long.
    pub first_wait: Duration,
    /// The maximum wait between two tries.
    pub longest_wait: Duration,
}

impl Default for QueuePolicy {
    fn default() -> Self {
        Self {
            lease: Duration::from_secs(30),
            max_failures: 5,
            first_wait: Duration::from_secs(1),
            longest_wait: Duration::from_secs(120),
        }
    }
}

impl QueuePolicy {
    /// Returns the time between two renewals of a lease. It is short enough that two renewals in a row may get lost.
    pub fn renewal_interval(&self) -> Duration {
        self.lease / 4
    }

    /// Returns the time between two searches for expired leases.
    pub fn tick_interval(&self) -> Duration {
        self.lease / 8
    }

    /// Returns the gap between two searches for expired leases from which the database counts as having been
    /// unavailable. During such a gap, workers could not renew their leases.
    fn outage_gap(&self) -> Duration {
        self.lease / 2
    }

    /// Returns how often a job's worker may be lost. This limit is far above the limit for failures, because the job
    /// itself rarely causes a worker's crash.
    fn max_deaths(&self) -> i64 {
        8 * i64::from(self.max_failures)
    }

    /// Returns how long a job waits after its worker was lost. The wait is short, because the job is rarely the cause.
    fn wait_after_death(&self, deaths: i64) -> Duration {
        self.first_wait * u32::try_from(deaths).unwrap_or(0).clamp(1, 10)
    }

    /// Returns the maximum wait of a job after `failures` failures.
    fn max_delay(&self, failures: i64) -> Duration {
        let steps = u32::try_from(failures.max(1) - 1).unwrap_or(u32::MAX).min(16);
        self.first_wait.saturating_mul(4_u32.saturating_pow(steps)).min(self.longest_wait)
    }

    /// Returns a random wait up to [`Self::max_delay`], so that jobs that failed at the same time are not tried again
    /// at the same time.
    fn retry_delay(&self, failures: i64) -> Duration {
        let longest = self.max_delay(failures);
        longest - longest / 4 * (getrandom::u32().unwrap_or(0) % 256) / 255
    }
}

/// A worker's right to a job, which the worker proves with the key.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct Lease {
    /// The job's ID.
    #[schema(minimum = 0, maximum = 9_007_199_254_740_991_i64)]
    pub job: i64,
    /// The number of the claim, from 1.
    #[schema(minimum = 0, maximum = 9_007_199_254_740_991_i64)]
    pub attempt: i64,
    /// A secret that only the worker and the database know.
    #[schema(max_length = 200)]
    pub key: String,
}

/// A job that was claimed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Claim {
    /// The lease, which the worker's further messages must contain.
    pub lease: Lease,
    /// The ID of the submission that is graded, if any.
    pub submission: Option<i64>,
    /// The task, as it was enqueued, as text.
    pub payload: String,
    /// The number of the job's earlier failures.
    pub failures: i64,
    /// The number of times that a worker of the job was lost.
    pub deaths: i64,
}

/// Returns a duration in milliseconds, in the type of the database.
pub(crate) fn millis(duration: Duration) -> i64 {
    i64::try_from(duration.as_millis()).unwrap_or(i64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_failure_waits_longer_up_to_a_limit() {
        let policy = QueuePolicy::default();
        let waits: Vec<u64> = (1..=6).map(|failures| policy.max_delay(failures).as_secs()).collect();
        assert_eq!(waits, [1, 4, 16, 64, 120, 120]);
        assert_eq!(policy.max_delay(i64::MAX), policy.longest_wait);
        let some: std::collections::BTreeSet<Duration> = (0..100).map(|_| policy.retry_delay(3)).collect();
        assert!(some.len() > 10 && some.first() >= Some(&Duration::from_secs(12)), "{some:?}");
        assert!(some.last() <= Some(&Duration::from_secs(16)), "{some:?}");
    }
}
