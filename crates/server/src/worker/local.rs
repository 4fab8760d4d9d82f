//! The desk of workers that hold the database themselves: those within the server, and those of who wants it so.
use super::{Answer, Desk, DeskError, GRACE, Job};
use crate::{
    db::{Database, DbError},
    health, ledger,
    queue::{self, Bell, Claimant, Completion, Ear, Failure, Lane, Lease, Policy},
    shown,
    store::{Artefact, Digest, Store, StoreError},
    task::{Outcome, Task},
};
use std::{path::Path, time::Duration};
use tokio::sync::Mutex;

/// How often a worker looks although nobody rang.
const LOOK_EVERY: Duration = Duration::from_secs(1);

/// What a job may take besides its grading, at least.
const LEAST_MARGIN: Duration = Duration::from_secs(60);

/// The database and the store as a desk.
#[derive(Debug)]
pub struct LocalDesk {
    database: Database,
    store: Store,
    bell: Bell,
    /// What this copy has heard.
    ear: Mutex<Ear>,
    policy: Policy,
    worker: String,
    /// The token that the worker came by, if any.
    token: Option<i64>,
}

impl Clone for LocalDesk {
    fn clone(&self) -> Self {
        let (database, store, bell) = (self.database.clone(), self.store.clone(), self.bell.clone());
        Self { token: self.token, ..Self::new(database, store, bell, self.policy, self.worker.clone()) }
    }
}

impl From<DbError> for DeskError {
    fn from(error: DbError) -> Self {
        if error.is_transient() { Self::Away(error.to_string()) } else { Self::Refused(error.to_string()) }
    }
}

impl From<StoreError> for DeskError {
    fn from(error: StoreError) -> Self {
        match error {
            StoreError::Failed(_) => Self::Away(error.to_string()),
            _ => Self::Refused(error.to_string()),
        }
    }
}

impl LocalDesk {
    /// A desk for the worker of this name.
    pub fn new(database: Database, store: Store, bell: Bell, policy: Policy, worker: String) -> Self {
        let ear = Mutex::new(bell.ear());
        Self { database, store, bell, ear, policy, worker, token: None }
    }

    /// The same for a worker that came by this token.
    pub fn with_token(self, token: i64) -> Self {
        Self { token: Some(token), ..self }
    }
}

/// A job's end comes no later than its grading's and so much more, for what is fetched, stored and waited for.
fn longest(task: &Task, policy: &Policy) -> Duration {
    Duration::from_secs(task.seconds) + GRACE + LEAST_MARGIN.max(policy.lease * 10)
}

impl Desk for LocalDesk {
    async fn claim(&self, is_idle: bool) -> Result<Option<Job>, DeskError> {
        let claimant = Claimant { worker: &self.worker, is_idle, token: self.token };
        ledger::tick(&self.database, &self.policy).await?;
        loop {
            let mut transaction = self.database.begin().await?;
            let claim = if health::may_claim(&mut transaction, &self.policy, claimant).await? {
                queue::claim(&mut transaction, &self.policy, Lane::Grading, claimant).await?
            } else {
                None
            };
            transaction.commit().await?;
            let Some(claim) = claim else { return Ok(None) };
            match serde_json::from_str(&claim.payload) {
                Ok(task) => {
                    let alone = claim.is_suspected();
                    return Ok(Some(Job { lease: claim.lease, renew_every: self.policy.renew_every(), task, alone }));
                }
                // Written by another version of the program: not this worker's to do.
                Err(error) => {
                    self.fail(&claim.lease, &format!("the task can't be read: {error}")).await?;
                }
            }
        }
    }

    async fn wait(&self, patience: Duration) {
        self.ear.lock().await.wait(patience.min(LOOK_EVERY)).await;
    }

    async fn renew(&self, lease: &Lease) -> Result<Answer, DeskError> {
        // A step of the clock is noticed before it can end a lease.
        ledger::tick(&self.database, &self.policy).await?;
        let mut transaction = self.database.begin().await?;
        let task = queue::payload(&mut transaction, lease).await?.and_then(|text| serde_json::from_str(&text).ok());
        let held = match task {
            Some(task) => queue::renew(&mut transaction, &self.policy, lease, longest(&task, &self.policy)).await?,
            None => false,
        };
        transaction.commit().await?;
        Ok(if held { Answer::Held } else { Answer::Lost })
    }

    async fn finish(&self, lease: &Lease, outcome: &Outcome) -> Result<Answer, DeskError> {
        for file in &outcome.files {
            if !self.store.has(&file.artefact.digest).await? {
                return Err(DeskError::Refused(format!("{} is not in the store", file.name)));
            }
        }
        let shown = Some(shown::of_outcome(&self.store, &outcome.files).await?);
        let outcome = Outcome { shown, ..outcome.clone() };
        let mut transaction = self.database.begin().await?;
        let completion = ledger::finish(&mut transaction, lease, &outcome).await?;
        Bell::ring(&mut transaction).await?;
        transaction.commit().await?;
        self.bell.strike();
        Ok(match completion {
            Completion::Done | Completion::Repeated => Answer::Held,
            Completion::Late => Answer::Lost,
        })
    }

    async fn release(&self, lease: &Lease) -> Result<Answer, DeskError> {
        let mut transaction = self.database.begin().await?;
        let held = queue::release(&mut transaction, lease).await?;
        Bell::ring(&mut transaction).await?;
        transaction.commit().await?;
        self.bell.strike();
        Ok(if held { Answer::Held } else { Answer::Lost })
    }

    async fn fail(&self, lease: &Lease, fault: &str) -> Result<Answer, DeskError> {
        let mut transaction = self.database.begin().await?;
        let failure = ledger::fail(&mut transaction, &self.policy, lease, fault).await?;
        Bell::ring(&mut transaction).await?;
        transaction.commit().await?;
        self.bell.strike();
        if failure == Failure::Buried {
            tracing::error!(job = lease.job, fault, "a job was tried too often");
        }
        Ok(if failure == Failure::Late { Answer::Lost } else { Answer::Held })
    }

    async fn fetch(&self, _: &Lease, digest: &Digest, file: &Path) -> Result<(), DeskError> {
        Ok(self.store.fetch(digest, file).await?)
    }

    async fn store(&self, _: &Lease, file: &Path) -> Result<Artefact, DeskError> {
        Ok(self.store.put_file(file).await?)
    }

    async fn tick(&self, slots: usize, fault: Option<&str>) -> Result<(), DeskError> {
        let mut transaction = self.database.begin().await?;
        health::seen(&mut transaction, &self.worker, self.token, slots, fault).await?;
        transaction.commit().await?;
        Ok(ledger::tick(&self.database, &self.policy).await?)
    }

    fn tick_every(&self) -> Duration {
        self.policy.tick_every()
    }
}
