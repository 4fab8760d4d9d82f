//! The API for workers on other machines. A worker claims, renews and finishes jobs, and transfers their files. If the
//! body is a file, the lease is in the header `Fosssim-Lease`, as `JOB:ATTEMPT:KEY`.
use super::super::{
    download,
    input::{Body, UrlPathParts},
    upload,
};
use crate::{
    domain::RemoteWorker,
    problem::{Problem, ensure},
    queue::Lease,
    store::{Artifact, Digest},
    wire::{ClaimedJob, FinishedJob, JobFault, LeaseAnswer, Renewal, WorkerReport, WorkerSettings},
};
use axum::{
    Json,
    extract::Request,
    http::{HeaderMap, StatusCode, header},
    response::{IntoResponse, Response},
};

/// Claims the next job. If the queue is empty, the answer is 204.
#[utoipa::path(post, path = "/api/v1/worker/claim", tag = "workers",
    responses((status = 200, body = ClaimedJob), (status = 204, description = "No job")))]
pub(super) async fn claim(remote: RemoteWorker) -> Result<Response, Problem> {
    Ok(match remote.claim().await? {
        Some(job) => Json(job).into_response(),
        None => StatusCode::NO_CONTENT.into_response(),
    })
}

answers! { OK:
    /// Reports that the worker is alive. The answer contains the server's settings for workers.
    post "/api/v1/worker/tick" "workers"
        tick(remote: RemoteWorker, alive: WorkerReport) -> WorkerSettings:
            remote.tick(alive.slots, alive.fault.as_deref(), &alive.version);
    /// Extends a lease, and reports the progress of the grading.
    post "/api/v1/worker/renew" "workers"
        renew(remote: RemoteWorker, renewal: Renewal) -> LeaseAnswer: remote.renew(&renewal.lease, renewal.progress);
    /// Gives a job back to the queue. This does not count as a failure.
    post "/api/v1/worker/release" "workers" release(remote: RemoteWorker, lease: Lease) -> LeaseAnswer:
        remote.release(&lease);
    /// Reports that the worker failed to grade a job.
    post "/api/v1/worker/fail" "workers"
        fail(remote: RemoteWorker, fault: JobFault) -> LeaseAnswer: remote.fail(&fault.lease, &fault.fault);
    /// Stores the result of a job, and ends the job.
    post "/api/v1/worker/finish" "workers"
        finish(remote: RemoteWorker, result: FinishedJob) -> LeaseAnswer: remote.finish(&result.lease, &result.outcome);
}

fn lease(headers: &HeaderMap) -> Result<Lease, Problem> {
    let text = headers.get("fosssim-lease").and_then(|value| value.to_str().ok()).unwrap_or_default();
    let mut parts = text.splitn(3, ':');
    let mut next = || parts.next().unwrap_or_default();
    match (next().parse(), next().parse(), next()) {
        (Ok(job), Ok(attempt), key) if !key.is_empty() => Ok(Lease { job, attempt, key: key.to_owned() }),
        _ => Err(Problem::invalid("the request must contain the lease: Fosssim-Lease: JOB:ATTEMPT:KEY")),
    }
}

/// Returns a file of a job that the worker holds. The file is named by its digest.
#[utoipa::path(get, path = "/api/v1/worker/files/{digest}", tag = "workers",
    params(("Fosssim-Lease" = String, Header)),
    responses((status = 200, description = "The file's bytes")))]
pub(super) async fn artifact(
    remote: RemoteWorker,
    UrlPathParts { digest, .. }: UrlPathParts,
    headers: HeaderMap,
) -> Result<Response, Problem> {
    let digest: Digest = digest.parse().map_err(Problem::invalid)?;
    let opened = remote.artifact(&lease(&headers)?, &digest).await?;
    let kind = [(header::CONTENT_TYPE, "application/octet-stream")];
    Ok((kind, download::whole_answer(opened, None)).into_response())
}

/// Stores a report for a job that the worker holds. The bytes must match the digest in the URL.
#[utoipa::path(put, path = "/api/v1/worker/files/{digest}", tag = "workers",
    params(("Fosssim-Lease" = String, Header)),
    request_body(content = Vec<u8>, content_type = "application/octet-stream"),
    responses((status = 200, body = Artifact)))]
pub(super) async fn store(
    remote: RemoteWorker,
    UrlPathParts { digest, .. }: UrlPathParts,
    request: Request,
) -> Result<Json<Artifact>, Problem> {
    let digest: Digest = digest.parse().map_err(Problem::invalid)?;
    let lease = lease(request.headers())?;
    let max_bytes = remote.check_lease(&lease).await?;
    let received = upload::receive(&remote.app, request, max_bytes).await?;
    let found = crate::store::digest_of_file(&received.file).await?;
    ensure(found.digest == digest, Problem::invalid("the bytes do not match the digest"))?;
    Ok(Json(remote.store(&lease, &received.file).await?))
}
