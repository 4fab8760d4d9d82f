//! Where workers get their jobs and bring their results: the database itself, or a server over HTTP.
use crate::{
    queue::{Lease, Progress},
    store::{Artifact, Digest},
    task::Outcome,
    wire::{ClaimedJob, LeaseAnswer},
};
use std::{future::Future, path::Path, time::Duration};
use thiserror::Error;

/// The reason why a source did not answer.
#[derive(Debug, Error)]
pub enum SourceError {
    /// The request may succeed a moment later.
    #[error("{0}")]
    Away(String),
    /// The request never succeeds.
    #[error("{0}")]
    Refused(String),
    /// The worker's token is not known, or not any more.
    #[error("its token is unknown or revoked: an administrator makes another one on the page \"Administration\"")]
    Dismissed,
}

/// Where workers get their jobs and bring their results.
pub trait JobSource: Clone + Send + Sync + 'static {
    /// Returns the next job, if there is one. Not to be interrupted: the source might have given away a job that nobody
    /// gets.
    fn claim(&self) -> impl Future<Output = Result<Option<ClaimedJob>, SourceError>> + Send;

    /// Waits until there may be a job, or `patience` is over. May be interrupted.
    fn wait(&self, patience: Duration) -> impl Future<Output = ()> + Send;

    /// Extends the lease, and says how far the grading is, if anybody knows.
    fn renew(
        &self,
        lease: &Lease,
        progress: Option<Progress>,
    ) -> impl Future<Output = Result<LeaseAnswer, SourceError>> + Send;

    /// Brings the result. Saying it twice is no harm.
    fn finish(&self, lease: &Lease, outcome: &Outcome)
    -> impl Future<Output = Result<LeaseAnswer, SourceError>> + Send;

    /// Gives the job back at no cost.
    fn release(&self, lease: &Lease) -> impl Future<Output = Result<LeaseAnswer, SourceError>> + Send;

    /// Says that the try came to nothing through no fault of the submission.
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

    /// Says that this worker is alive, with this many slots, and why it can't grade where it can't; called every now
    /// and then.
    fn tick(&self, slots: usize, fault: Option<&str>) -> impl Future<Output = Result<(), SourceError>> + Send;

    /// Returns how often [`tick`](Self::tick) is to be called.
    fn tick_every(&self) -> Duration;
}
