//! The API of regrades.
use super::super::input::{Body, ListStart, QueryInput, UrlPathParts, read_fields};
use crate::{
    domain::{Regrade, Settings, Staff},
    problem::Problem,
    schema::Title,
};
use axum::{Json, http::StatusCode};
use serde::Deserialize;
use serde_json::{Map, Value};
use utoipa::ToSchema;

/// The reason for a new regrade, and its settings.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(as = RegradeWish)]
pub(super) struct RegradeInput {
    /// The reason for the regrade, which students read after it is applied.
    #[schema(value_type = Title)]
    reason: String,
    /// The grading settings that differ from the assignment's settings.
    #[serde(default, deserialize_with = "read_fields")]
    #[schema(value_type = Settings, required = false)]
    settings: Map<String, Value>,
}

answers! { CREATED:
    /// Grades all submissions again, and stores the new results next to the old grades. No grade changes until the
    /// regrade is applied.
    post "/api/v1/courses/{course}/assignments/{assignment}/regrades" "regrades"
        begin(staff: Staff, { assignment }, input: RegradeInput) -> Regrade: async {
            let settings = staff.assignment(&assignment).await?.settings.with_changes(&input.settings)?;
            staff.regrade(&assignment, &input.reason, &settings).await
        };
}

answers! { OK:
    /// Returns a regrade that is open or applied, with the changed grades and the likely reasons.
    get "/api/v1/courses/{course}/assignments/{assignment}/regrades/{id}" "regrades"
        show(staff: Staff, { assignment, id }, ?query: ListStart) -> Regrade:
            staff.show_regrade(&assignment, id, query.after);
    /// Makes the results of a regrade count.
    post "/api/v1/courses/{course}/assignments/{assignment}/regrades/{id}/apply" "regrades"
        apply(staff: Staff, { assignment, id }) -> Regrade: staff.apply_regrade(&assignment, id);
    /// Discards a regrade, so that no grade changes.
    post "/api/v1/courses/{course}/assignments/{assignment}/regrades/{id}/discard" "regrades"
        discard(staff: Staff, { assignment, id }) -> Regrade: staff.discard_regrade(&assignment, id);
    /// Lists the regrades of an assignment, newest first.
    get "/api/v1/courses/{course}/assignments/{assignment}/regrades" "regrades"
        regrades(staff: Staff, { assignment }) -> Vec<Regrade>: staff.regrades(&assignment);
}
