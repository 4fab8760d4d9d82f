//! The interface between workers and the source of their jobs, which also receives the results. The source is the
//! database, or a server over HTTP.
use crate::{
    queue::{Lease, Progress},
    store::{Artifact, Digest},
    task::Outcome,
    wire::{ClaimedJob, LeaseAnswer},
};
use std::{future::Future, path::Path, time::Duration};
use thiserror::Error;

/// The reason why a request to the source failed.
#[derive(Debug, Error)]
pub enum SourceError {
    /// The source does not answer at present; a retry may succeed.
    #[error("{0}")]
    Unavailable(String),
    /// The source rejects the request; a retry cannot succeed.
    #[error("{0}")]
    Rejected(String),
    /// The source no longer accepts the worker, because its token is unknown or was revoked.
    #[error("the worker's token is unknown or revoked; create another one on the page \"Administration\"")]
    Dismissed,
}

/// A source of jobs for workers. It also receives the results.
pub trait JobSource: Clone + Send + Sync + 'static {
    /// Claims the next job; `None` if there is no job. The call must not be interrupted. Otherwise the source might
    /// assign a job that no worker receives.
    fn claim(&self) -> impl Future<Output = Result<Option<ClaimedJob>, SourceError>> + Send;

    /// Waits until there may be a job, but not longer than `max_wait`. The call may be interrupted.
    fn wait(&self, max_wait: Duration) -> impl Future<Output = ()> + Send;

    /// Extends a lease, and reports the progress of the grading if it is known.
    fn renew(
        &self,
        lease: &Lease,
        progress: Option<Progress>,
    ) -> impl Future<Output = Result<LeaseAnswer, SourceError>> + Send;

    /// Reports the result. A repeated report has no effect.
    fn finish(&self, lease: &Lease, outcome: &Outcome)
    -> impl Future<Output = Result<LeaseAnswer, SourceError>> + Send;

    /// Gives the job back to the queue. This does not count as a failure.
    fn release(&self, lease: &Lease) -> impl Future<Output = Result<LeaseAnswer, SourceError>> + Send;

    /// Reports that a try failed because of the grader or the machine, and not because of the submission.
    fn fail(&self, lease: &Lease, fault: &str) -> impl Future<Output = Result<LeaseAnswer, SourceError>> + Send;

    /// Copies one of the job's artifacts into a new file.
    fn fetch(
        &self,
        lease: &Lease,
        digest: &Digest,
        file: &Path,
    ) -> impl Future<Output = Result<(), SourceError>> + Send;

    /// Stores a file that belongs to the job's result.
    fn store(&self, lease: &Lease, file: &Path) -> impl Future<Output = Result<Artifact, SourceError>> + Send;

    /// Reports that this worker is alive, with its number of slots. If the worker can't grade, `fault` is the reason.
    /// Workers call this regularly.
    fn tick(&self, slots: usize, fault: Option<&str>) -> impl Future<Output = Result<(), SourceError>> + Send;

    /// Returns the time between two calls of [`tick`](Self::tick).
    fn tick_every(&self) -> Duration;
}
