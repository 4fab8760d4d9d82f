//! The messages between workers on other machines and the server, as JSON. Fields that the other side does not know are
//! passed over: the two may be of different versions while they are upgraded.
use crate::{
    queue::{Lease, Progress},
    task::{Outcome, Task},
};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A job for a worker.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct ClaimedJob {
    /// The lease to show from now on.
    pub lease: Lease,
    /// The time between two renewals, in milliseconds.
    pub renew_every: u64,
    /// The task.
    pub task: Task,
}

/// A sign of life.
#[derive(Serialize, Deserialize, ToSchema)]
pub(crate) struct SignOfLife {
    /// The number of gradings that it does at one time; 0 while it can't grade.
    #[schema(maximum = 10_000)]
    pub(crate) slots: usize,
    /// The reason why it can't grade.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) fault: Option<String>,
    /// The worker's version.
    #[serde(default)]
    #[schema(max_length = 60)]
    pub(crate) version: String,
}

/// The rules for a worker.
#[derive(Serialize, Deserialize, ToSchema)]
pub struct Manners {
    /// The time between two reports that the worker is alive, in milliseconds.
    pub(crate) tick_every: u64,
    /// The server's version.
    #[serde(default)]
    pub(crate) version: String,
}

/// Whether the lease still holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct LeaseAnswer {
    /// If not, another worker has the job and nothing was changed.
    pub held: bool,
}

impl From<bool> for LeaseAnswer {
    fn from(held: bool) -> Self {
        Self { held }
    }
}

/// A lease to extend.
#[derive(Serialize, Deserialize, ToSchema)]
pub(crate) struct Renewal {
    #[serde(flatten)]
    pub(crate) lease: Lease,
    /// The progress of the grading, if the worker knows it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) progress: Option<Progress>,
}

/// The reason why a try failed.
#[derive(Serialize, Deserialize, ToSchema)]
pub(crate) struct JobFault {
    pub(crate) lease: Lease,
    #[schema(max_length = 2000)]
    pub(crate) fault: String,
}

/// A result.
#[derive(Serialize, Deserialize, ToSchema)]
pub(crate) struct FinishedJob {
    pub(crate) lease: Lease,
    pub(crate) outcome: Outcome,
}
