//! Regrades: begun, looked at, applied or discarded.
use super::super::input::{After, Asked, At, Body, whole_numbers};
use crate::{
    access::{Regrade, Settings, Staff},
    problem::Problem,
    schema::Title,
};
use axum::{Json, http::StatusCode};
use serde::Deserialize;
use serde_json::{Map, Value};
use utoipa::ToSchema;

/// A regrade as it is to be.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RegradeWish {
    /// Why, as students read it when it is applied.
    #[schema(value_type = Title)]
    reason: String,
    /// Settings about grading that are to be others than the assignment's.
    #[serde(default, deserialize_with = "whole_numbers")]
    #[schema(value_type = Option<Settings>)]
    settings: Map<String, Value>,
}

/// Grades all submissions again, beside their grades. Nothing changes until it is applied.
#[utoipa::path(post, path = "/api/v1/courses/{course}/assignments/{assignment}/regrades", tag = "regrades",
    request_body = RegradeWish,
    responses((status = 201, body = Regrade), (status = 202, body = Regrade, description = "It goes on: see `doing`")))]
pub(super) async fn begin(
    staff: Staff,
    At { assignment, .. }: At,
    Body(wish): Body<RegradeWish>,
) -> Result<(StatusCode, Json<Regrade>), Problem> {
    let settings = staff.assignment(&assignment).await?.settings.with(&wish.settings)?;
    Ok(answer(staff.regrade(&assignment, &wish.reason, &settings).await?, StatusCode::CREATED))
}

/// The changes that a regrade would make, or made, and why.
#[utoipa::path(get, path = "/api/v1/courses/{course}/assignments/{assignment}/regrades/{id}", tag = "regrades",
    params(("after" = Option<i64>, Query,
        description = "Only changes of submissions after this one: `next` of the answer before")),
    responses((status = 200, body = Regrade)))]
pub(super) async fn show(
    staff: Staff,
    At { assignment, id, .. }: At,
    Asked(asked): Asked<After>,
) -> Result<Json<Regrade>, Problem> {
    Ok(Json(staff.show_regrade(&assignment, id, asked.after).await?))
}

/// A regrade that is worked on after the answer was accepted only.
fn answer(regrade: Regrade, done: StatusCode) -> (StatusCode, Json<Regrade>) {
    (if regrade.doing.is_some() { StatusCode::ACCEPTED } else { done }, Json(regrade))
}

/// Makes its results count.
#[utoipa::path(post, path = "/api/v1/courses/{course}/assignments/{assignment}/regrades/{id}/apply",
    tag = "regrades",
    responses((status = 200, body = Regrade), (status = 202, body = Regrade, description = "It goes on: see `doing`")))]
pub(super) async fn apply(staff: Staff, At { assignment, id, .. }: At) -> Result<(StatusCode, Json<Regrade>), Problem> {
    Ok(answer(staff.apply_regrade(&assignment, id).await?, StatusCode::OK))
}

/// Gives it up; nothing changes.
#[utoipa::path(post, path = "/api/v1/courses/{course}/assignments/{assignment}/regrades/{id}/discard",
    tag = "regrades",
    responses((status = 200, body = Regrade), (status = 202, body = Regrade, description = "It goes on: see `doing`")))]
pub(super) async fn discard(
    staff: Staff,
    At { assignment, id, .. }: At,
) -> Result<(StatusCode, Json<Regrade>), Problem> {
    Ok(answer(staff.discard_regrade(&assignment, id).await?, StatusCode::OK))
}

answers! { OK:
    /// The regrades of an assignment, latest first.
    get "/api/v1/courses/{course}/assignments/{assignment}/regrades" "regrades"
        regrades(staff: Staff, { assignment }) -> Vec<Regrade>: staff.regrades(&assignment);
}
