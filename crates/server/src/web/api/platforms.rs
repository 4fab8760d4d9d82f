//! The API of learning platforms.
use super::super::input::{Body, QueryInput, UrlPathParts};
use crate::{
    domain::{Admin, RosterMode, RosterRead, ScoreInfo, Staff},
    lti::{Platform, PlatformSettings},
    problem::Problem,
};
use axum::{Json, http::StatusCode};
use serde::Deserialize;
use utoipa::IntoParams;

/// Whether the changes to the course's members are only shown, and whether they are applied even if many members would
/// leave.
#[derive(Default, Deserialize, IntoParams)]
#[serde(default)]
#[into_params(parameter_in = Query)]
pub(super) struct RosterParameters {
    /// Only report who would be added and removed.
    preview: bool,
    /// Change the members even if more than a third would be removed.
    confirm: bool,
}

impl RosterParameters {
    fn mode(&self) -> RosterMode {
        match self {
            Self { preview: true, .. } => RosterMode::Preview,
            Self { confirm: true, .. } => RosterMode::Confirmed,
            Self { .. } => RosterMode::Apply,
        }
    }
}

answers! { OK:
    /// Reads the members of the course from the connected platforms, and changes the course's members accordingly.
    post "/api/v1/courses/{course}/roster" "courses"
        roster(staff: Staff, ?query: RosterParameters) -> RosterRead: staff.read_roster(query.mode());
    /// Registers a platform, or changes it.
    put "/api/v1/platforms/{name}" "administration"
        set_platform(admin: Admin, { name }, input: PlatformSettings) -> Platform: admin.set_platform(&name, &input);
    /// Lists the registered platforms.
    get "/api/v1/platforms" "administration" platforms(admin: Admin) -> Vec<Platform>: admin.platforms();
    /// Lists the messages to platforms about an assignment's scores.
    get "/api/v1/courses/{course}/assignments/{assignment}/scores" "assignments"
        scores(staff: Staff, { assignment }) -> Vec<ScoreInfo>: staff.scores(&assignment);
}

actions! { ACCEPTED:
    /// Sends all scores of an assignment again, even those that platforms have accepted.
    post "/api/v1/courses/{course}/assignments/{assignment}/scores" "assignments"
        send_scores(staff: Staff, { assignment }) -> "The scores are being sent": staff.send_scores(&assignment);
}

actions! { NO_CONTENT:
    /// Closes a platform: people can no longer launch from it, and no scores are sent to it.
    delete "/api/v1/platforms/{name}" "administration"
        shut_platform(admin: Admin, { name }) -> "Shut": admin.close_platform(&name);
    /// Creates a new key with which the service signs messages to platforms. The key is used after an hour.
    post "/api/v1/platform-keys" "administration" new_key(admin: Admin) -> "Made": admin.new_platform_key();
}
