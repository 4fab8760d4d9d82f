//! Where the reference may be wrong.
use super::super::input::At;
use crate::{
    access::{Staff, Suspicion},
    problem::Problem,
};
use axum::{Json, http::StatusCode};

answers! {
    /// Scenes in which more than a third of the students who are right otherwise answer the same, and not what the
    /// reference does.
    get "/api/v1/courses/{course}/assignments/{assignment}/suspicions" "assignments"
        suspicions(staff: Staff, { assignment }) -> Vec<Suspicion>: staff.suspicions(&assignment);
}

deeds! {
    /// The reference is right there.
    post "/api/v1/courses/{course}/assignments/{assignment}/suspicions/{id}/dismiss" "assignments"
        dismiss(staff: Staff, { assignment, id }) -> "Noted": staff.decide_suspicion(&assignment, id, false);
    /// Tells the students whose submissions answer so that the reference may be wrong.
    post "/api/v1/courses/{course}/assignments/{assignment}/suspicions/{id}/tell" "assignments"
        tell(staff: Staff, { assignment, id }) -> "Noted": staff.decide_suspicion(&assignment, id, true);
}
