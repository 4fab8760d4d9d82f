//! The messages between workers on other machines and the server, as JSON. Unknown fields are ignored, because the two
//! sides may have different versions during an upgrade.
use crate::{
    queue::{Lease, Progress},
    task::{Outcome, Task},
};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A job that a worker has claimed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct ClaimedJob {
    /// The lease, which the worker's further messages must contain.
    pub lease: Lease,
    /// The time between two renewals of the lease, in milliseconds.
    pub renew_every: u64,
    /// The task that the worker must do.
    pub task: Task,
}

/// A message that the worker is alive.
#[derive(Serialize, Deserialize, ToSchema)]
#[schema(as = SignOfLife)]
pub(crate) struct WorkerReport {
    /// The maximum number of parallel gradings. It is 0 while the worker can't grade.
    #[schema(maximum = 10_000)]
    pub(crate) slots: usize,
    /// The reason why the worker can't grade, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) fault: Option<String>,
    /// The worker's version.
    #[serde(default)]
    #[schema(max_length = 60)]
    pub(crate) version: String,
}

/// The server's settings for a worker: the interval of its reports, and the server's version.
#[derive(Serialize, Deserialize, ToSchema)]
#[schema(as = Manners)]
pub struct WorkerSettings {
    /// The time between two reports that the worker is alive, in milliseconds.
    pub(crate) tick_every: u64,
    /// The server's version.
    #[serde(default)]
    pub(crate) version: String,
}

/// The server's answer to a message about a lease.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct LeaseAnswer {
    /// Whether the lease is still valid. If not, another worker has the job, and the request changed nothing.
    pub held: bool,
}

impl From<bool> for LeaseAnswer {
    fn from(held: bool) -> Self {
        Self { held }
    }
}

/// A message that extends a lease.
#[derive(Serialize, Deserialize, ToSchema)]
pub(crate) struct Renewal {
    #[serde(flatten)]
    pub(crate) lease: Lease,
    /// The progress of the grading, if the grader reports it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) progress: Option<Progress>,
}

/// A message that the worker failed to grade a job.
#[derive(Serialize, Deserialize, ToSchema)]
pub(crate) struct JobFault {
    pub(crate) lease: Lease,
    #[schema(max_length = 2000)]
    pub(crate) fault: String,
}

/// A message with the result of a job.
#[derive(Serialize, Deserialize, ToSchema)]
pub(crate) struct FinishedJob {
    pub(crate) lease: Lease,
    pub(crate) outcome: Outcome,
}
