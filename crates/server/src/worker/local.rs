//! The source of jobs for workers that access the database directly, in the server's process or in their own.
use super::{GRACE_PERIOD, JobSource, SourceError};
use crate::{
    db::{Database, DbError},
    health, ledger,
    queue::{self, Claimant, JobKind, Lease, Notifier, Progress, QueuePolicy, Subscription},
    store::{Artifact, Digest, Store, StoreError},
    task::{Outcome, Task},
    visible_grade::{self, StoredTexts},
    wire::{ClaimedJob, LeaseAnswer},
};
use std::{path::Path, time::Duration};
use tokio::sync::Mutex;

/// The time after which the search for jobs is repeated even without a notification.
const SEARCH_INTERVAL: Duration = Duration::from_secs(1);

/// The minimum extra time that a job may take beyond its grading.
const MIN_MARGIN: Duration = Duration::from_secs(60);

/// A source of jobs that uses the database and the store directly.
#[derive(Debug)]
pub struct LocalSource {
    database: Database,
    store: Store,
    notifier: Notifier,
    /// The notifications that wake this worker.
    subscription: Mutex<Subscription>,
    policy: QueuePolicy,
    worker: String,
    /// The worker's version, which the server shows.
    version: String,
    /// The ID of the worker's token; `None` for the server's own workers.
    token_id: Option<i64>,
}

impl Clone for LocalSource {
    fn clone(&self) -> Self {
        let (database, store, notifier) = (self.database.clone(), self.store.clone(), self.notifier.clone());
        let (token_id, version) = (self.token_id, self.version.clone());
        Self { token_id, version, ..Self::new(database, store, notifier, self.policy, self.worker.clone()) }
    }
}

impl From<DbError> for SourceError {
    fn from(error: DbError) -> Self {
        if error.is_transient() { Self::Unavailable(error.to_string()) } else { Self::Rejected(error.to_string()) }
    }
}

impl From<StoreError> for SourceError {
    fn from(error: StoreError) -> Self {
        match error {
            StoreError::Failed(_) => Self::Unavailable(error.to_string()),
            _ => Self::Rejected(error.to_string()),
        }
    }
}

impl LocalSource {
    /// Creates a source for the worker called `worker`.
    pub fn new(database: Database, store: Store, notifier: Notifier, policy: QueuePolicy, worker: String) -> Self {
        let subscription = Mutex::new(notifier.subscribe());
        Self {
            database,
            store,
            notifier,
            subscription,
            policy,
            worker,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            token_id: None,
        }
    }

    /// Sets the ID of the worker's token.
    pub fn with_token_id(self, token_id: i64) -> Self {
        Self { token_id: Some(token_id), ..self }
    }

    /// Sets the worker's version.
    pub fn with_version(self, version: String) -> Self {
        Self { version, ..self }
    }
}

/// Returns the maximum duration of a job: the limit of its grading, and time for transfers, storage and waits.
fn max_duration(task: &Task, policy: &QueuePolicy) -> Duration {
    Duration::from_secs(task.seconds) + GRACE_PERIOD + MIN_MARGIN.max(policy.lease * 10)
}

impl JobSource for LocalSource {
    async fn claim(&self) -> Result<Option<ClaimedJob>, SourceError> {
        let claimant = Claimant { worker: &self.worker, token_id: self.token_id };
        ledger::tick(&self.database, &self.policy).await?;
        loop {
            let mut transaction = self.database.begin().await?;
            let claim = if health::may_claim(&mut transaction, &self.policy, claimant).await? {
                queue::claim(&mut transaction, &self.policy, JobKind::Grading, claimant).await?
            } else {
                None
            };
            transaction.commit().await?;
            let Some(claim) = claim else { return Ok(None) };
            match serde_json::from_str(&claim.payload) {
                Ok(task) => {
                    let renew_every = self.policy.renewal_interval();
                    let renew_every = u64::try_from(renew_every.as_millis()).unwrap_or(u64::MAX);
                    return Ok(Some(ClaimedJob { lease: claim.lease, renew_every, task }));
                }
                // The task cannot be read, because another version of this program wrote it.
                Err(error) => {
                    self.fail(&claim.lease, &format!("the task can't be read: {error}")).await?;
                }
            }
        }
    }

    async fn wait(&self, max_wait: Duration) {
        self.subscription.lock().await.wait(max_wait.min(SEARCH_INTERVAL)).await;
    }

    async fn renew(&self, lease: &Lease, progress: Option<Progress>) -> Result<LeaseAnswer, SourceError> {
        // Check whether the clock has jumped, before a jump can end a lease.
        ledger::tick(&self.database, &self.policy).await?;
        let mut transaction = self.database.begin().await?;
        let task = queue::payload(&mut transaction, lease).await?.and_then(|text| serde_json::from_str(&text).ok());
        let is_held = match task {
            Some(task) => {
                let limit = max_duration(&task, &self.policy);
                queue::renew(&mut transaction, &self.policy, lease, progress, limit).await?
            }
            None => false,
        };
        transaction.commit().await?;
        Ok(is_held.into())
    }

    async fn finish(&self, lease: &Lease, outcome: &Outcome) -> Result<LeaseAnswer, SourceError> {
        for file in &outcome.files {
            if !self.store.has(&file.artifact.digest).await? {
                return Err(SourceError::Rejected(format!("{} is not in the store", file.name)));
            }
        }
        let StoredTexts { shown, failed, parts } = visible_grade::read_texts(&self.store, &outcome.files).await?;
        let outcome = Outcome { shown: Some(shown), failed, parts, ..outcome.clone() };
        let mut transaction = self.database.begin().await?;
        let completion = ledger::finish(&mut transaction, lease, &outcome).await?;
        self.notifier.commit(transaction).await?;
        Ok((completion != queue::CompletionEffect::Late).into())
    }

    async fn release(&self, lease: &Lease) -> Result<LeaseAnswer, SourceError> {
        let mut transaction = self.database.begin().await?;
        let is_held = queue::release(&mut transaction, lease).await?;
        self.notifier.commit(transaction).await?;
        Ok(is_held.into())
    }

    async fn fail(&self, lease: &Lease, fault: &str) -> Result<LeaseAnswer, SourceError> {
        let mut transaction = self.database.begin().await?;
        let failure = ledger::fail(&mut transaction, &self.policy, lease, fault).await?;
        self.notifier.commit(transaction).await?;
        if failure == queue::FailureEffect::GivenUp {
            tracing::error!(job = lease.job, fault, "a job was tried too often");
        }
        Ok((failure != queue::FailureEffect::Late).into())
    }

    async fn fetch(&self, _: &Lease, digest: &Digest, file: &Path) -> Result<(), SourceError> {
        Ok(self.store.fetch(digest, file).await?)
    }

    async fn store(&self, _: &Lease, file: &Path) -> Result<Artifact, SourceError> {
        Ok(self.store.put_file(file).await?)
    }

    async fn tick(&self, slots: usize, fault: Option<&str>) -> Result<(), SourceError> {
        let mut transaction = self.database.begin().await?;
        health::record_report(&mut transaction, (&self.worker, &self.version), self.token_id, slots, fault).await?;
        transaction.commit().await?;
        Ok(ledger::tick(&self.database, &self.policy).await?)
    }

    fn tick_every(&self) -> Duration {
        self.policy.tick_interval()
    }
}
