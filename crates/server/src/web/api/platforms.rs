//! Learning platforms.
use super::super::input::{AddressParts, Body, QueryInput};
use crate::{
    domain::{Admin, RosterRead, RosterWish, ScoreInfo, Staff},
    lti::{Platform, PlatformWish},
    problem::Problem,
};
use axum::{Json, http::StatusCode};
use serde::Deserialize;

/// Whether the roster is only read, or applied although many members leave.
#[derive(Deserialize)]
pub(super) struct RosterParameters {
    #[serde(default)]
    preview: bool,
    #[serde(default)]
    confirm: bool,
}

/// Reads who is in the course from the platforms that it is connected with.
#[utoipa::path(post, path = "/api/v1/courses/{course}/roster", tag = "courses",
    params(("preview" = Option<bool>, Query, description = "Only report who would be added and removed"),
        ("confirm" = Option<bool>, Query, description = "Also if more than a third would be removed")),
    responses((status = 200, body = RosterRead)))]
pub(super) async fn roster(
    staff: Staff,
    QueryInput(asked): QueryInput<RosterParameters>,
) -> Result<Json<RosterRead>, Problem> {
    let wish = match asked {
        RosterParameters { preview: true, .. } => RosterWish::Preview,
        RosterParameters { confirm: true, .. } => RosterWish::Confirmed,
        RosterParameters { .. } => RosterWish::Apply,
    };
    Ok(Json(staff.read_roster(wish).await?))
}

answers! { OK:
    /// Registers a platform, or changes it.
    put "/api/v1/platforms/{name}" "administration"
        set_platform(admin: Admin, { name }, wish: PlatformWish) -> Platform: admin.set_platform(&name, &wish);
    /// The registered platforms.
    get "/api/v1/platforms" "administration" platforms(admin: Admin) -> Vec<Platform>: admin.platforms();
    /// The messages to platforms about an assignment's scores.
    get "/api/v1/courses/{course}/assignments/{assignment}/scores" "assignments"
        scores(staff: Staff, { assignment }) -> Vec<ScoreInfo>: staff.scores(&assignment);
}

deeds! { ACCEPTED:
    /// Sends all scores of an assignment once more, also those that platforms took.
    post "/api/v1/courses/{course}/assignments/{assignment}/scores" "assignments"
        send_scores(staff: Staff, { assignment }) -> "The scores are being sent": staff.send_scores(&assignment);
}

deeds! { NO_CONTENT:
    /// Closes a platform: nobody arrives from it any more, and no scores are sent.
    delete "/api/v1/platforms/{name}" "administration"
        shut_platform(admin: Admin, { name }) -> "Shut": admin.shut_platform(&name);
    /// Makes a new key of the service for platforms; it signs from an hour on.
    post "/api/v1/platform-keys" "administration" new_key(admin: Admin) -> "Made": admin.new_platform_key();
}
