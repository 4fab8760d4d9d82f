//! Learning platforms.
use super::super::input::{At, Body};
use crate::{
    access::{Admin, RosterRead, ScoreInfo, Staff},
    lti::{Platform, PlatformWish},
    problem::Problem,
};
use axum::{Json, http::StatusCode};

answers! { OK:
    /// Registers a platform, or changes it.
    put "/api/v1/platforms/{name}" "administration"
        set_platform(admin: Admin, { name }, wish: PlatformWish) -> Platform: admin.set_platform(&name, &wish);
    /// The registered platforms.
    get "/api/v1/platforms" "administration" platforms(admin: Admin) -> Vec<Platform>: admin.platforms();
    /// Reads who is in the course from the platforms that it is connected with.
    post "/api/v1/courses/{course}/roster" "courses" roster(staff: Staff) -> RosterRead: staff.read_roster();
    /// The messages to platforms about an assignment's scores.
    get "/api/v1/courses/{course}/assignments/{assignment}/scores" "assignments"
        scores(staff: Staff, { assignment }) -> Vec<ScoreInfo>: staff.scores(&assignment);
}

deeds! { ACCEPTED:
    /// Sends all scores of an assignment once more, also those that platforms took.
    post "/api/v1/courses/{course}/assignments/{assignment}/scores" "assignments"
        send_scores(staff: Staff, { assignment }) -> "They are on their way": staff.send_scores(&assignment);
}

deeds! { NO_CONTENT:
    /// Shuts a platform: nobody comes from it any more, and no scores go there.
    delete "/api/v1/platforms/{name}" "administration"
        shut_platform(admin: Admin, { name }) -> "Shut": admin.shut_platform(&name);
    /// Makes a new key of the service for platforms; it signs from an hour on.
    post "/api/v1/platform-keys" "administration" new_key(admin: Admin) -> "Made": admin.new_platform_key();
}
