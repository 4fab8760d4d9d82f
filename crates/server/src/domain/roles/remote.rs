//! A worker on another machine. It runs untrusted programs, so a submission may gain control of it. It can claim jobs,
//! read their files, and report their results, but it sees no courses, no students and no other submissions.
use crate::domain::App;
use crate::{
    problem::{Problem, ensure},
    queue::{Lease, Progress},
    store::{Artifact, Digest, OpenArtifact},
    task::{Outcome, Suite, Task},
    values,
    wire::{ClaimedJob, WorkerSettings},
    worker::{JobSource, LocalSource, REPORTS, SourceError},
};
use std::path::Path;

/// A worker on another machine, identified by its token.
pub struct RemoteWorker {
    pub(crate) app: App,
    token_id: i64,
    worker: String,
}

/// The maximum size of a report that a worker stores, in bytes.
const MAX_FILE_BYTES: u64 = 256 << 20;

impl From<SourceError> for Problem {
    fn from(error: SourceError) -> Self {
        match error {
            SourceError::Unavailable(error) => {
                tracing::warn!(error, "a worker was not answered");
                Self::unavailable("the database or the store does not answer")
            }
            SourceError::Rejected(error) => Self::invalid(error),
            SourceError::Dismissed => {
                Self::unknown_secret("worker token", "ask the server's administrator for a new token")
            }
        }
    }
}

impl RemoteWorker {
    pub(in crate::domain) fn new(app: App, token_id: i64, token_name: &str, name: &str) -> Self {
        let plain: String = name.chars().filter(|c| c.is_ascii_alphanumeric() || "-_.".contains(*c)).take(80).collect();
        Self { app, token_id, worker: format!("{token_name}/{plain}") }
    }

    fn source(&self) -> LocalSource {
        let parts = &self.app.0;
        LocalSource::new(
            parts.database.with_priority(),
            parts.store.clone(),
            parts.notifier.clone(),
            parts.policy,
            self.worker.clone(),
        )
        .with_token_id(self.token_id)
    }

    /// Returns whether a lease was given to this worker's token. Requests with other leases are ignored.
    async fn owns(&self, lease: &Lease) -> Result<bool, Problem> {
        let mut transaction = self.app.0.database.with_priority().read().await?;
        let statement = "SELECT token FROM job WHERE id = ? AND attempt = ?";
        let row = transaction.row(statement, values![lease.job, lease.attempt]).await?;
        Ok(row.map(|row| row.maybe_int("token")).transpose()?.flatten() == Some(self.token_id))
    }

    /// Returns the next waiting job with its task; `None` if the queue is empty.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn claim(&self) -> Result<Option<ClaimedJob>, Problem> {
        Ok(self.source().claim().await?)
    }

    /// Records that the worker is alive, and stores its version, and either its number of slots or the reason why it
    /// can't grade.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn tick(&self, slots: usize, fault: Option<&str>, version: &str) -> Result<WorkerSettings, Problem> {
        let fault = fault.map(|fault| strip_controls(fault, 2000));
        let source = self.source().with_version(strip_controls(version, 60));
        source.tick(slots.min(MAX_SLOTS), fault.as_deref()).await?;
        let tick_every = self.app.0.policy.tick_interval().as_millis();
        let tick_every = u64::try_from(tick_every).unwrap_or(u64::MAX);
        Ok(WorkerSettings { tick_every, version: env!("CARGO_PKG_VERSION").to_owned() })
    }

    /// Extends a lease, and stores the progress of the grading. Returns false if the lease is no longer valid.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn renew(&self, lease: &Lease, progress: Option<Progress>) -> Result<bool, Problem> {
        Ok(self.owns(lease).await? && self.source().renew(lease, progress).await?.held)
    }

    /// Returns a job to the queue. Returns false if the lease is no longer valid.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn release(&self, lease: &Lease) -> Result<bool, Problem> {
        Ok(self.owns(lease).await? && self.source().release(lease).await?.held)
    }

    /// Records that the worker failed to grade a job. Returns false if the lease is no longer valid.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn fail(&self, lease: &Lease, fault: &str) -> Result<bool, Problem> {
        Ok(self.owns(lease).await? && self.source().fail(lease, &strip_controls(fault, 2000)).await?.held)
    }

    /// Stores a result. Returns false if the lease is no longer valid. Workers are not trusted, so the result may name
    /// only files that the worker stored for this job.
    ///
    /// # Errors
    ///
    /// Fails if the result is invalid, or if the database does not answer.
    pub async fn finish(&self, lease: &Lease, outcome: &Outcome) -> Result<bool, Problem> {
        if !self.owns(lease).await? {
            return Ok(false);
        }
        let outcome = self.check_outcome(lease, outcome).await?;
        Ok(self.source().finish(lease, &outcome).await?.held)
    }

    async fn check_outcome(&self, lease: &Lease, outcome: &Outcome) -> Result<Outcome, Problem> {
        let is_code = |code: &str| (1..=4).contains(&code.len()) && code.bytes().all(|c| c.is_ascii_uppercase());
        ensure(
            is_code(&outcome.code) && outcome.code != crate::task::JUDGE_ERROR,
            Problem::invalid("the verdict's code is unknown"),
        )?;
        let seconds = Some(outcome.seconds.clone()).filter(|seconds| !seconds.is_empty());
        for number in [&outcome.points, &outcome.max_points, &seconds].into_iter().flatten() {
            let is_number = number.parse::<f64>().is_ok_and(f64::is_finite)
                && number.len() <= 40
                && number.bytes().all(|c| c.is_ascii_digit() || b"+-.eE".contains(&c));
            ensure(is_number, Problem::invalid("points and seconds must be numbers"))?;
        }
        let value = |text: &Option<String>| text.as_ref().and_then(|text| text.parse::<f64>().ok());
        if let (Some(points), max_points) = (value(&outcome.points), value(&outcome.max_points).unwrap_or(MAX_POINTS))
            && !(0.0..=max_points.min(MAX_POINTS)).contains(&points)
        {
            return Err(Problem::invalid("points must be between 0 and the maximum"));
        }
        let mut outcome = outcome.clone();
        outcome.verdict = strip_controls(&outcome.verdict, 200);
        outcome.summary = strip_controls(&outcome.summary, 2000);
        outcome.version = strip_controls(&outcome.version, 60);
        let is_digest = |text: &str| text.parse::<Digest>().is_ok();
        ensure(outcome.grader.is_empty() || is_digest(&outcome.grader), Problem::invalid("grader must be a digest"))?;
        let mut transaction = self.app.0.database.with_priority().read().await?;
        let mut names = std::collections::BTreeSet::new();
        for file in &mut outcome.files {
            // The server, not the worker, chooses the names and media types of reports.
            let Some((_, _, media_type)) = REPORTS.iter().find(|(_, name, _)| *name == file.name) else {
                return Err(Problem::invalid(format!("no report is called {}", strip_controls(&file.name, 60))));
            };
            ensure(names.insert(file.name.clone()), Problem::invalid("two reports have the same name"))?;
            file.media_type = (*media_type).to_owned();
            let statement = "SELECT size FROM job_file WHERE job = ? AND attempt = ? AND digest = ?";
            let stored =
                transaction.row(statement, values![lease.job, lease.attempt, file.artifact.digest.as_str()]).await?;
            let Some(stored) = stored else {
                return Err(Problem::conflict("a report was not stored for this job", "store it first"));
            };
            file.artifact.size = u64::try_from(stored.int("size")?).unwrap_or(0);
        }
        Ok(outcome)
    }

    /// Returns the task of a job, if the worker holds its lease.
    async fn find_leased_task(&self, lease: &Lease) -> Result<Task, Problem> {
        let mut transaction = self.app.0.database.with_priority().read().await?;
        let statement = "SELECT payload FROM job
            WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running' AND token = ?";
        let row = transaction.row(statement, values![lease.job, lease.attempt, &lease.key, self.token_id]).await?;
        let row = row.ok_or_else(|| Problem::not_found("job of yours"))?;
        serde_json::from_str(&row.text("payload")?).map_err(|_| Problem::fault())
    }

    /// Returns an artifact of a job that the worker holds.
    ///
    /// # Errors
    ///
    /// Fails if the worker does not hold the job, or the artifact is not the job's.
    pub async fn artifact(&self, lease: &Lease, digest: &Digest) -> Result<OpenArtifact, Problem> {
        let task = self.find_leased_task(lease).await?;
        let suite = matches!(&task.suite, Suite::Archive(suite) if suite == digest);
        ensure(task.submission.artifact.digest == *digest || suite, Problem::not_found("artifact of this job"))?;
        Ok(self.app.0.store.open(digest).await?)
    }

    /// Stores a report of a job that the worker holds.
    ///
    /// # Errors
    ///
    /// Fails if the worker does not hold the job, or the store fails.
    pub async fn store(&self, lease: &Lease, file: &Path) -> Result<Artifact, Problem> {
        self.find_leased_task(lease).await?;
        let artifact = self.app.0.store.put_file(file).await?;
        let mut transaction = self.app.0.database.with_priority().begin().await?;
        // A transaction that takes the job away waits for this one, and this one waits for it.
        let statement = "SELECT id FROM job WHERE id = ? AND attempt = ? AND lease_key = ? AND state = 'running'
            {for update}";
        let leased = transaction.row(statement, values![lease.job, lease.attempt, &lease.key]).await?;
        ensure(leased.is_some(), Problem::not_found("job of yours"))?;
        let size = i64::try_from(artifact.size).unwrap_or(i64::MAX);
        let statement = "INSERT INTO job_file (job, attempt, digest, size) VALUES (?, ?, ?, ?)
            ON CONFLICT (job, attempt, digest) DO NOTHING";
        transaction.execute(statement, values![lease.job, lease.attempt, artifact.digest.as_str(), size]).await?;
        transaction.commit().await?;
        Ok(artifact)
    }

    /// Checks that the worker holds the job, and returns the job's size limit. This is called before a body is
    /// received.
    ///
    /// # Errors
    ///
    /// Fails if the worker does not hold the job.
    pub async fn check_lease(&self, lease: &Lease) -> Result<u64, Problem> {
        self.find_leased_task(lease).await.map(|_| MAX_FILE_BYTES)
    }
}

/// A number of points that is larger than that of any suite. Results above it are rejected.
const MAX_POINTS: f64 = 1e9;
const MAX_SLOTS: usize = 256;

/// Returns untrusted text on one line, without control characters, and shortened to `max` characters.
fn strip_controls(text: &str, max: usize) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).take(max).collect()
}
