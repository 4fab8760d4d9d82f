//! Grading once more what the grader failed on.
use super::super::input::At;
use crate::{access::Staff, problem::Problem};
use axum::{Json, http::StatusCode};
use serde::Serialize;
use utoipa::ToSchema;

/// The submissions that are graded again.
#[derive(Serialize, ToSchema)]
pub(super) struct Again {
    /// How many submissions.
    jobs: i64,
}

/// Grades a submission once more, by the assignment's settings as they are.
#[utoipa::path(post, path = "/api/v1/courses/{course}/submissions/{id}/again", tag = "submissions",
    responses((status = 202, body = Again)))]
pub(super) async fn grade_again(staff: Staff, At { id, .. }: At) -> Result<(StatusCode, Json<Again>), Problem> {
    Ok((StatusCode::ACCEPTED, Json(Again { jobs: staff.grade_again(id).await? })))
}

/// Grades all submissions to an assignment on which the grader failed once more, and goes on with it if it waits for
/// staff.
#[utoipa::path(post, path = "/api/v1/courses/{course}/assignments/{assignment}/judge-errors/again",
    tag = "submissions",
    responses((status = 202, body = Again)))]
pub(super) async fn grade_errors_again(
    staff: Staff,
    At { assignment, .. }: At,
) -> Result<(StatusCode, Json<Again>), Problem> {
    Ok((StatusCode::ACCEPTED, Json(Again { jobs: staff.grade_errors_again(Some(&assignment)).await? })))
}

/// The same for all assignments of a course.
#[utoipa::path(post, path = "/api/v1/courses/{course}/judge-errors/again", tag = "submissions",
    responses((status = 202, body = Again)))]
pub(super) async fn grade_all_errors_again(staff: Staff) -> Result<(StatusCode, Json<Again>), Problem> {
    Ok((StatusCode::ACCEPTED, Json(Again { jobs: staff.grade_errors_again(None).await? })))
}
