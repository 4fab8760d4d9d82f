//! The part of the API for monitoring the server.
use crate::{domain::Visitor, problem::Problem};
use axum::{
    http::header,
    response::{IntoResponse, Response},
};

/// Returns 200 if the process is alive.
#[utoipa::path(get, path = "/health", tag = "operations",
    responses((status = 200, body = String, content_type = "text/plain", description = "The process is alive")))]
pub(super) async fn health() -> &'static str {
    "alive\n"
}

/// Returns 200 if requests can be served: the database answers, its tables have the version of this program, and the
/// database and the store can be written.
#[utoipa::path(get, path = "/ready", tag = "operations",
    responses((status = 200, body = String, content_type = "text/plain", description = "Requests can be served")))]
pub(super) async fn ready(visitor: Visitor) -> Result<&'static str, Problem> {
    visitor.check_ready().await?;
    Ok("ready\n")
}

/// Returns the description of the API.
#[utoipa::path(get, path = "/api/openapi.json", tag = "operations",
    responses((status = 200, body = Object, description = "OpenAPI 3.1")))]
pub(super) async fn openapi() -> Response {
    ([(header::CONTENT_TYPE, "application/json")], crate::web::openapi()).into_response()
}

/// Returns metrics in Prometheus' text format, without personal data. If the database does not answer, only the metrics
/// of the process itself are included.
#[utoipa::path(get, path = "/metrics", tag = "operations",
    responses((status = 200, body = String, content_type = "text/plain", description = "Prometheus' text format")))]
pub(super) async fn metrics(visitor: Visitor) -> Result<Response, Problem> {
    let kind = [(header::CONTENT_TYPE, "text/plain; version=0.0.4; charset=utf-8")];
    Ok((kind, visitor.metrics().await?).into_response())
}
