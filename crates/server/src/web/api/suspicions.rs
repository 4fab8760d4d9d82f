//! Where the reference may be wrong.
use super::super::input::Params;
use crate::{
    access::{Staff, Suspicion},
    problem::Problem,
};
use axum::{Json, http::StatusCode};

/// Scenes in which more than a third of the students who are right otherwise answer the same, and not what the
/// reference does.
#[utoipa::path(get, path = "/api/v1/courses/{course}/assignments/{assignment}/suspicions", tag = "assignments",
    params(("course" = String, Path), ("assignment" = String, Path)),
    responses((status = 200, body = Vec<Suspicion>), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn suspicions(
    staff: Staff,
    Params((_, assignment)): Params<(String, String)>,
) -> Result<Json<Vec<Suspicion>>, Problem> {
    Ok(Json(staff.suspicions(&assignment).await?))
}

/// The reference is right there.
#[utoipa::path(post, path = "/api/v1/courses/{course}/assignments/{assignment}/suspicions/{id}/dismiss",
    tag = "assignments", params(("course" = String, Path), ("assignment" = String, Path), ("id" = i64, Path)),
    responses((status = 204, description = "Noted"), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn dismiss(
    staff: Staff,
    Params((_, assignment, id)): Params<(String, String, i64)>,
) -> Result<StatusCode, Problem> {
    staff.decide_suspicion(&assignment, id, false).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Tells the students whose submissions answer so that the reference may be wrong.
#[utoipa::path(post, path = "/api/v1/courses/{course}/assignments/{assignment}/suspicions/{id}/tell",
    tag = "assignments", params(("course" = String, Path), ("assignment" = String, Path), ("id" = i64, Path)),
    responses((status = 204, description = "Noted"), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn tell(
    staff: Staff,
    Params((_, assignment, id)): Params<(String, String, i64)>,
) -> Result<StatusCode, Problem> {
    staff.decide_suspicion(&assignment, id, true).await?;
    Ok(StatusCode::NO_CONTENT)
}
