//! The interface between workers and the source of their jobs, which also receives the results: the database, or a
//! server over HTTP.
use crate::{
    queue::{Lease, Progress},
    store::{Artifact, Digest},
    task::Outcome,
    wire::{ClaimedJob, LeaseAnswer},
};
use std::{future::Future, path::Path, time::Duration};
use thiserror::Error;

/// The reason why a request to a source failed.
#[derive(Debug, Error)]
pub enum SourceError {
    /// A retry may succeed.
    #[error("{0}")]
    Away(String),
    /// A retry cannot succeed.
    #[error("{0}")]
    Refused(String),
    /// The worker's token is unknown or revoked.
    #[error("its token is unknown or revoked; an administrator can create another one on the page \"Administration\"")]
    Dismissed,
}

/// The source of workers' jobs, which also receives their results.
pub trait JobSource: Clone + Send + Sync + 'static {
    /// Returns the next job, if there is one. The call must not be interrupted; otherwise the source might assign a job
    /// that no worker receives.
    fn claim(&self) -> impl Future<Output = Result<Option<ClaimedJob>, SourceError>> + Send;

    /// Waits until there may be a job, at most for `patience`. The call may be interrupted.
    fn wait(&self, patience: Duration) -> impl Future<Output = ()> + Send;

    /// Extends the lease, and reports the progress of the grading, if it is known.
    fn renew(
        &self,
        lease: &Lease,
        progress: Option<Progress>,
    ) -> impl Future<Output = Result<LeaseAnswer, SourceError>> + Send;

    /// Reports the result. A repeated report has no effect.
    fn finish(&self, lease: &Lease, outcome: &Outcome)
    -> impl Future<Output = Result<LeaseAnswer, SourceError>> + Send;

    /// Returns the job without counting a failure.
    fn release(&self, lease: &Lease) -> impl Future<Output = Result<LeaseAnswer, SourceError>> + Send;

    /// Reports that the try failed because of the grader or the machine, not of the submission.
    fn fail(&self, lease: &Lease, fault: &str) -> impl Future<Output = Result<LeaseAnswer, SourceError>> + Send;

    /// Copies an artifact of the job into a new file.
    fn fetch(
        &self,
        lease: &Lease,
        digest: &Digest,
        file: &Path,
    ) -> impl Future<Output = Result<(), SourceError>> + Send;

    /// Stores a file for the result of the job.
    fn store(&self, lease: &Lease, file: &Path) -> impl Future<Output = Result<Artifact, SourceError>> + Send;

    /// Reports regularly that this worker is alive, with its slots and the reason why it can't grade, if it can't.
    fn tick(&self, slots: usize, fault: Option<&str>) -> impl Future<Output = Result<(), SourceError>> + Send;

    /// Returns the time between two calls of [`tick`](Self::tick).
    fn tick_every(&self) -> Duration;
}
