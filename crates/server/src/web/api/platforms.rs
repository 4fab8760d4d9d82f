//! The API of learning platforms.
use super::super::input::{AddressParts, Body, QueryInput};
use crate::{
    domain::{Admin, RosterRead, RosterWish, ScoreInfo, Staff},
    lti::{Platform, PlatformWish},
    problem::Problem,
};
use axum::{Json, http::StatusCode};
use serde::Deserialize;

/// The parameters for reading a roster.
#[derive(Deserialize)]
pub(super) struct RosterParameters {
    #[serde(default)]
    preview: bool,
    #[serde(default)]
    confirm: bool,
}

/// Reads the members of the course from the connected platforms.
#[utoipa::path(post, path = "/api/v1/courses/{course}/roster", tag = "courses",
    params(("preview" = Option<bool>, Query, description = "Only report who would be added and removed"),
        ("confirm" = Option<bool>, Query, description = "Proceed even if more than a third would be removed")),
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
    /// Lists the registered platforms.
    get "/api/v1/platforms" "administration" platforms(admin: Admin) -> Vec<Platform>: admin.platforms();
    /// Lists the messages to platforms about an assignment's scores.
    get "/api/v1/courses/{course}/assignments/{assignment}/scores" "assignments"
        scores(staff: Staff, { assignment }) -> Vec<ScoreInfo>: staff.scores(&assignment);
}

deeds! { ACCEPTED:
    /// Sends all scores of an assignment again, even those that platforms have accepted.
    post "/api/v1/courses/{course}/assignments/{assignment}/scores" "assignments"
        send_scores(staff: Staff, { assignment }) -> "The scores are being sent": staff.send_scores(&assignment);
}

deeds! { NO_CONTENT:
    /// Closes a platform: people cannot launch from it, and no scores are sent.
    delete "/api/v1/platforms/{name}" "administration"
        shut_platform(admin: Admin, { name }) -> "Shut": admin.shut_platform(&name);
    /// Creates a new key of the service for platforms, which signs after an hour.
    post "/api/v1/platform-keys" "administration" new_key(admin: Admin) -> "Made": admin.new_platform_key();
}
