//! Sends artifacts in pieces while they are read. If the client already has an artifact, it is not sent again.
use crate::{
    domain::{Member, Transfer},
    problem::Problem,
    store::{Artifact, OpenArtifact},
};
use axum::{
    body::Body,
    http::{HeaderMap, HeaderValue, StatusCode, header},
    response::{IntoResponse, Response},
};
use futures_util::TryStreamExt;

/// Sends an artifact, unless the request's headers show that the client already has it.
pub(super) async fn send(member: &Member, headers: &HeaderMap, artifact: &Artifact) -> Result<Response, Problem> {
    let transfer = member.transfer()?;
    let tag = format!("\"{}\"", artifact.digest);
    let is_same = |tags: &str| tags == "*" || tags.split(',').any(|other| other.trim().trim_start_matches("W/") == tag);
    let is_known = headers.get(header::IF_NONE_MATCH).and_then(|value| value.to_str().ok()).is_some_and(is_same);
    let unchanged = || StatusCode::NOT_MODIFIED.into_response();
    let mut response = if is_known { unchanged() } else { whole_answer(member.open(artifact).await?, Some(transfer)) };
    insert(&mut response, header::ETAG, &tag);
    Ok(response)
}

/// Returns an answer that contains a whole artifact.
pub(super) fn whole_answer(opened: OpenArtifact, transfer: Option<Transfer>) -> Response {
    let pieces = opened.pieces.inspect_err(move |error| {
        // The answer is broken off, so that the client notices that bytes are missing.
        tracing::error!(%error, "a response was interrupted");
        let _of_this_answer = &transfer;
    });
    let mut response = Body::from_stream(pieces).into_response();
    insert(&mut response, header::CONTENT_LENGTH, &opened.size.to_string());
    response
}

fn insert(response: &mut Response, name: header::HeaderName, value: &str) {
    if let Ok(value) = HeaderValue::from_str(value) {
        response.headers_mut().insert(name, value);
    }
}
