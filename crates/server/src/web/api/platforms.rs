//! Learning platforms.
use super::super::input::{Body, Params};
use crate::{
    access::{Admin, RosterRead, ScoreInfo, Staff},
    lti::{Platform, PlatformWish},
    problem::Problem,
};
use axum::{Json, http::StatusCode};

/// The registered platforms.
#[utoipa::path(get, path = "/api/v1/platforms", tag = "administration",
    responses((status = 200, body = Vec<Platform>), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn platforms(admin: Admin) -> Result<Json<Vec<Platform>>, Problem> {
    Ok(Json(admin.platforms().await?))
}

/// Registers a platform, or changes it.
#[utoipa::path(put, path = "/api/v1/platforms/{name}", tag = "administration", params(("name" = String, Path)),
    request_body = PlatformWish,
    responses((status = 200, body = Platform), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn set_platform(
    admin: Admin,
    Params(name): Params<String>,
    Body(wish): Body<PlatformWish>,
) -> Result<Json<Platform>, Problem> {
    Ok(Json(admin.set_platform(&name, &wish).await?))
}

/// Shuts a platform: nobody comes from it any more, and no scores go there.
#[utoipa::path(delete, path = "/api/v1/platforms/{name}", tag = "administration", params(("name" = String, Path)),
    responses((status = 204, description = "Shut"), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn shut_platform(admin: Admin, Params(name): Params<String>) -> Result<StatusCode, Problem> {
    admin.shut_platform(&name).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Makes a new key of the service for platforms; it signs from an hour on.
#[utoipa::path(post, path = "/api/v1/platform-keys", tag = "administration",
    responses((status = 204, description = "Made"), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn new_key(admin: Admin) -> Result<StatusCode, Problem> {
    admin.new_platform_key().await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Reads who is in the course from the platforms that it is connected with.
#[utoipa::path(post, path = "/api/v1/courses/{course}/roster", tag = "courses", params(("course" = String, Path)),
    responses((status = 200, body = RosterRead), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn roster(staff: Staff) -> Result<Json<RosterRead>, Problem> {
    Ok(Json(staff.read_roster().await?))
}

/// What platforms were told of an assignment's scores.
#[utoipa::path(get, path = "/api/v1/courses/{course}/assignments/{assignment}/scores", tag = "assignments",
    params(("course" = String, Path), ("assignment" = String, Path)),
    responses((status = 200, body = Vec<ScoreInfo>), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn scores(
    staff: Staff,
    Params((_, assignment)): Params<(String, String)>,
) -> Result<Json<Vec<ScoreInfo>>, Problem> {
    Ok(Json(staff.scores(&assignment).await?))
}

/// Sends all scores of an assignment once more, also those that platforms took.
#[utoipa::path(post, path = "/api/v1/courses/{course}/assignments/{assignment}/scores", tag = "assignments",
    params(("course" = String, Path), ("assignment" = String, Path)),
    responses((status = 202, description = "They are on their way"), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn send_scores(
    staff: Staff,
    Params((_, assignment)): Params<(String, String)>,
) -> Result<StatusCode, Problem> {
    staff.send_scores(&assignment).await?;
    Ok(StatusCode::ACCEPTED)
}
