//! Regrades: begun, reviewed, applied or discarded.
use super::super::input::{AddressParts, Body, ListStart, QueryInput, whole_numbers};
use crate::{
    domain::{Regrade, Settings, Staff},
    problem::Problem,
    schema::Title,
};
use axum::{Json, http::StatusCode};
use serde::Deserialize;
use serde_json::{Map, Value};
use utoipa::ToSchema;

/// The settings of a new regrade.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RegradeWish {
    /// Why, as students read it when it is applied.
    #[schema(value_type = Title)]
    reason: String,
    /// Settings about grading that differ from the assignment's.
    #[serde(default, deserialize_with = "whole_numbers")]
    #[schema(value_type = Settings, required = false)]
    settings: Map<String, Value>,
}

/// Returns the changes that a regrade would make, or made, and why.
#[utoipa::path(get, path = "/api/v1/courses/{course}/assignments/{assignment}/regrades/{id}", tag = "regrades",
    params(("after" = Option<i64>, Query,
        description = "Only changes of submissions after this one: `next` of the answer before")),
    responses((status = 200, body = Regrade)))]
pub(super) async fn show(
    staff: Staff,
    AddressParts { assignment, id, .. }: AddressParts,
    QueryInput(asked): QueryInput<ListStart>,
) -> Result<Json<Regrade>, Problem> {
    Ok(Json(staff.show_regrade(&assignment, id, asked.after).await?))
}

answers! { CREATED:
    /// Grades all submissions again, next to their grades. Nothing changes until the regrade is applied.
    post "/api/v1/courses/{course}/assignments/{assignment}/regrades" "regrades"
        begin(staff: Staff, { assignment }, wish: RegradeWish) -> Regrade: async {
            let settings = staff.assignment(&assignment).await?.settings.with(&wish.settings)?;
            staff.regrade(&assignment, &wish.reason, &settings).await
        };
}

answers! { OK:
    /// Makes its results count.
    post "/api/v1/courses/{course}/assignments/{assignment}/regrades/{id}/apply" "regrades"
        apply(staff: Staff, { assignment, id }) -> Regrade: staff.apply_regrade(&assignment, id);
    /// Discards a regrade; nothing changes.
    post "/api/v1/courses/{course}/assignments/{assignment}/regrades/{id}/discard" "regrades"
        discard(staff: Staff, { assignment, id }) -> Regrade: staff.discard_regrade(&assignment, id);
    /// The regrades of an assignment, latest first.
    get "/api/v1/courses/{course}/assignments/{assignment}/regrades" "regrades"
        regrades(staff: Staff, { assignment }) -> Vec<Regrade>: staff.regrades(&assignment);
}
