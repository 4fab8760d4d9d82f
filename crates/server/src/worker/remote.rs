//! A source of jobs for workers on other machines: a server, over HTTP. The workers have a token, but no access to the
//! database.
use super::{JobSource, SourceError};
use crate::{
    queue::{Lease, Progress},
    store::{Artifact, Digest, digest_of_file},
    task::Outcome,
    wire::{ClaimedJob, FinishedJob, JobFault, LeaseAnswer, Renewal, WorkerReport, WorkerSettings},
};
use serde::{Serialize, de::DeserializeOwned};
use std::{
    fmt, fs, io,
    path::Path,
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    time::Duration,
};
use ureq::{Agent, Body, RequestBuilder, http::Response};

/// The time between two requests for a job.
const REQUEST_INTERVAL: Duration = Duration::from_secs(1);

/// The maximum time to wait for the server's answer, and for each part of a file.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(60);
const FILE_TIMEOUT: Duration = Duration::from_secs(900);

/// The maximum size of an answer, in bytes.
const MAX_ANSWER_BYTES: u64 = 1 << 20;

/// A server on another machine as a source of jobs. Clones are cheap.
#[derive(Clone)]
pub struct RemoteSource(Arc<Parts>);

struct Parts {
    agent: Agent,
    server: String,
    authorization: String,
    name: String,
    /// The time between two reports that the worker is alive, in milliseconds. The server sets it.
    tick_every: AtomicU64,
}

impl fmt::Debug for RemoteSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "RemoteSource({})", self.0.server)
    }
}

impl RemoteSource {
    /// Creates a source for the worker called `name`, from the server's URL and the worker's token.
    pub fn new(server: &str, token: &str, name: &str) -> Self {
        let agent = Agent::config_builder()
            // The status is checked below, so that the error contains the server's message.
            .http_status_as_error(false)
            // The token must be sent only to this server.
            .max_redirects(0)
            .timeout_connect(Some(ANSWER_TIMEOUT))
            .timeout_recv_response(Some(ANSWER_TIMEOUT))
            .timeout_global(Some(FILE_TIMEOUT))
            .user_agent(concat!("fosssim-server/", env!("CARGO_PKG_VERSION")))
            .build()
            .new_agent();
        Self(Arc::new(Parts {
            agent,
            server: server.trim_end_matches('/').to_owned(),
            authorization: format!("Bearer {token}"),
            name: name.to_owned(),
            tick_every: AtomicU64::new(2000),
        }))
    }

    /// Sends a request to the server in a thread that may block.
    async fn call<T: Send + 'static>(
        &self,
        request: impl FnOnce(&Parts) -> Result<T, SourceError> + Send + 'static,
    ) -> Result<T, SourceError> {
        let parts = self.0.clone();
        let answer = tokio::task::spawn_blocking(move || request(&parts)).await;
        answer.map_err(|error| SourceError::Unavailable(error.to_string()))?
    }

    async fn send_with_lease(
        &self,
        path: &'static str,
        body: impl Serialize + Send + 'static,
    ) -> Result<LeaseAnswer, SourceError> {
        self.call(move |parts| parts.json(path, &body)).await
    }
}

/// Returns a lease as text for the header.
fn format_lease(lease: &Lease) -> String {
    format!("{}:{}:{}", lease.job, lease.attempt, lease.key)
}

fn outage(error: impl fmt::Display) -> SourceError {
    SourceError::Unavailable(format!("the server does not answer: {error}"))
}

impl Parts {
    fn url(&self, path: &str) -> String {
        format!("{}/api/v1/worker/{path}", self.server)
    }

    /// Sends a JSON body, and parses the JSON answer.
    fn json<T: DeserializeOwned>(&self, path: &str, body: &impl Serialize) -> Result<T, SourceError> {
        let answer = self.post(path, body)?;
        let mut answer = check_status(answer)?;
        let text = answer.body_mut().with_config().limit(MAX_ANSWER_BYTES).read_to_vec().map_err(outage)?;
        serde_json::from_slice(&text).map_err(|error| SourceError::Rejected(format!("the server's answer: {error}")))
    }

    /// Adds the worker's identity, and the job's lease if there is one, to a request.
    fn sign<B>(&self, request: RequestBuilder<B>, lease: Option<&str>) -> RequestBuilder<B> {
        let request = request.header("Authorization", &self.authorization).header("Fosssim-Worker", &self.name);
        match lease {
            Some(lease) => request.header("Fosssim-Lease", lease),
            None => request,
        }
    }

    fn post(&self, path: &str, body: &impl Serialize) -> Result<Response<Body>, SourceError> {
        let body = serde_json::to_vec(body).map_err(|error| SourceError::Rejected(error.to_string()))?;
        let request = self.sign(self.agent.post(self.url(path)), None);
        request.header("Content-Type", "application/json").send(&body).map_err(outage)
    }
}

/// Returns the answer if its status means success. Otherwise returns an error: either the server does not answer at
/// present, or it rejects the request permanently.
fn check_status(mut answer: Response<Body>) -> Result<Response<Body>, SourceError> {
    let status = answer.status();
    if status.is_success() {
        return Ok(answer);
    }
    let body = answer.body_mut().with_config().limit(MAX_ANSWER_BYTES).read_to_vec().unwrap_or_default();
    let problem: serde_json::Value = serde_json::from_slice(&body).unwrap_or_default();
    let text = format!("{status}: {}", problem["detail"].as_str().unwrap_or_default());
    // If this program makes an error, or something is missing, a retry does not help. An error of a proxy is temporary.
    match status.as_u16() {
        401 if problem["type"] == "urn:fosssim:unknown-secret" => Err(SourceError::Dismissed),
        400 | 403 | 404 | 409 | 413 | 422 => Err(SourceError::Rejected(text)),
        _ => Err(SourceError::Unavailable(text)),
    }
}

impl JobSource for RemoteSource {
    async fn claim(&self) -> Result<Option<ClaimedJob>, SourceError> {
        self.call(move |parts| {
            let mut answer = check_status(parts.post("claim", &serde_json::json!({}))?)?;
            if answer.status() == 204 {
                return Ok(None);
            }
            let text = answer.body_mut().with_config().limit(MAX_ANSWER_BYTES).read_to_vec().map_err(outage)?;
            serde_json::from_slice(&text)
                .map(Some)
                .map_err(|error| SourceError::Rejected(format!("the job can't be read: {error}")))
        })
        .await
    }

    async fn wait(&self, max_wait: Duration) {
        tokio::time::sleep(max_wait.min(REQUEST_INTERVAL)).await;
    }

    async fn renew(&self, lease: &Lease, progress: Option<Progress>) -> Result<LeaseAnswer, SourceError> {
        self.send_with_lease("renew", Renewal { lease: lease.clone(), progress }).await
    }

    async fn finish(&self, lease: &Lease, outcome: &Outcome) -> Result<LeaseAnswer, SourceError> {
        self.send_with_lease("finish", FinishedJob { lease: lease.clone(), outcome: outcome.clone() }).await
    }

    async fn release(&self, lease: &Lease) -> Result<LeaseAnswer, SourceError> {
        self.send_with_lease("release", lease.clone()).await
    }

    async fn fail(&self, lease: &Lease, fault: &str) -> Result<LeaseAnswer, SourceError> {
        self.send_with_lease("fail", JobFault { lease: lease.clone(), fault: fault.to_owned() }).await
    }

    async fn fetch(&self, lease: &Lease, digest: &Digest, file: &Path) -> Result<(), SourceError> {
        let (lease, wanted, path) = (format_lease(lease), digest.clone(), file.to_owned());
        self.call(move |parts| {
            let request = parts.agent.get(parts.url(&format!("files/{wanted}")));
            let answer = parts.sign(request, Some(&lease)).call().map_err(outage)?;
            let mut answer = check_status(answer)?;
            let written = fs::File::create_new(&path).and_then(|mut output| {
                let mut input = answer.body_mut().with_config().limit(u64::MAX).reader();
                io::copy(&mut input, &mut output)
            });
            written.map(drop).map_err(|error| {
                // Remove the file, so that a retry can create it.
                drop(fs::remove_file(&path));
                outage(error)
            })
        })
        .await?;
        let found = digest_of_file(file).await.map_err(outage)?;
        if found.digest != *digest {
            drop(fs::remove_file(file));
            return Err(SourceError::Unavailable(format!("the server's bytes do not match {digest}")));
        }
        Ok(())
    }

    async fn store(&self, lease: &Lease, file: &Path) -> Result<Artifact, SourceError> {
        let artifact = digest_of_file(file).await.map_err(|error| SourceError::Rejected(error.to_string()))?;
        let (lease, digest, path) = (format_lease(lease), artifact.digest.clone(), file.to_owned());
        self.call(move |parts| {
            let input = fs::File::open(&path).map_err(|error| SourceError::Rejected(error.to_string()))?;
            let request = parts.sign(parts.agent.put(parts.url(&format!("files/{digest}"))), Some(&lease));
            let answer = request.header("Content-Type", "application/octet-stream").send(input).map_err(outage)?;
            check_status(answer).map(drop)
        })
        .await?;
        Ok(artifact)
    }

    async fn tick(&self, slots: usize, fault: Option<&str>) -> Result<(), SourceError> {
        let alive =
            WorkerReport { slots, fault: fault.map(str::to_owned), version: env!("CARGO_PKG_VERSION").to_owned() };
        let settings: WorkerSettings = self.call(move |parts| parts.json("tick", &alive)).await?;
        if settings.version != env!("CARGO_PKG_VERSION") {
            tracing::debug!(server = settings.version, "the server has another version");
        }
        self.0.tick_every.store(settings.tick_every.clamp(100, 60_000), Ordering::Relaxed);
        Ok(())
    }

    fn tick_every(&self) -> Duration {
        Duration::from_millis(self.0.tick_every.load(Ordering::Relaxed))
    }
}
