//! The API of courses and their members.
use super::super::input::{Body, QueryInput, SeenEvent, TextBody, UrlPathParts};
use crate::{
    domain::{Admin, Course, CourseMembership, Event, EventQuery, Link, MemberInfo, MemberLine, Person, Staff},
    problem::{Problem, ensure},
    schema::{Slug, Title},
};
use axum::{Json, http::StatusCode};
use serde::Deserialize;
use utoipa::{IntoParams, ToSchema};

/// The name and title of a new course.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(as = CourseWish)]
pub(in crate::web) struct CourseInput {
    #[schema(value_type = Slug)]
    pub(in crate::web) slug: String,
    #[schema(value_type = Title)]
    pub(in crate::web) title: String,
}

/// The name and the role that a member should have.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(as = MemberWish)]
pub(super) struct MemberInput {
    /// The member's name. It is used only if the account is new.
    #[schema(value_type = Title)]
    name: String,
    /// The member's role: `student` or `staff`.
    #[schema(pattern = "^(student|staff)$")]
    role: String,
    /// The ID of the newest event of the audit log that the sender has seen. If this member was changed after
    /// it, the request is rejected. Without this field, nothing is checked.
    #[schema(minimum = 0, maximum = 9_007_199_254_740_991_i64)]
    #[serde(rename = "seen")]
    seen_event: Option<i64>,
}

/// The confirmation that a removal requires.
#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct RemovalConfirmation {
    /// The short name of the course that is removed, as confirmation.
    confirm: String,
}

/// Whether the table is only checked, without adding members.
#[derive(Deserialize)]
pub(super) struct Preview {
    #[serde(default)]
    preview: bool,
}

/// Adds all members in a table. The columns are `name,login,email,role`, or those that its first line names. If any
/// line has an error, nothing is changed.
#[utoipa::path(post, path = "/api/v1/courses/{course}/members", tag = "courses",
    params(("preview" = Option<bool>, Query, description = "Only check the table"), SeenEvent),
    request_body(content = String, content_type = "text/csv"),
    responses((status = 200, body = Vec<MemberLine>)))]
pub(super) async fn import(
    staff: Staff,
    QueryInput(query): QueryInput<Preview>,
    QueryInput(seen): QueryInput<SeenEvent>,
    TextBody(table): TextBody,
) -> Result<Json<Vec<MemberLine>>, Problem> {
    Ok(Json(staff.import(&table, query.preview, seen.event()).await?))
}

answers! { CREATED:
    /// Creates a course.
    post "/api/v1/courses" "administration"
        new_course(admin: Admin, input: CourseInput) -> Course: admin.new_course(&input.slug, &input.title);
}

answers! { OK:
    /// Makes a person a member of the course. If the person has no account, it is created, and the answer contains a
    /// sign-in link, which works once.
    put "/api/v1/courses/{course}/members/{login}" "courses"
        set_member(staff: Staff, { login }, input: MemberInput) -> Link:
            staff.set_member(&login, &input.name, &input.role, input.seen_event);
    /// Creates a sign-in link for a student of the course. It works once.
    post "/api/v1/courses/{course}/members/{login}/link" "courses"
        member_link(staff: Staff, { login }) -> Link: staff.new_link(&login);
    /// Lists the courses of the person who is signed in.
    get "/api/v1/courses" "courses" courses(person: Person) -> Vec<CourseMembership>: person.courses();
    /// Lists the members of a course.
    get "/api/v1/courses/{course}/members" "courses" members(staff: Staff) -> Vec<MemberInfo>: staff.members();
    /// Returns the events of the course, newest first, 200 at a time.
    get "/api/v1/courses/{course}/audit" "courses"
        course_audit(staff: Staff, ?query: EventQuery) -> Vec<Event>: staff.audit(&query);
}

actions! { NO_CONTENT:
    /// Removes a course with its assignments, submissions and log. Accounts are kept. This cannot be undone.
    delete "/api/v1/courses/{course}" "administration"
        remove_course(admin: Admin, { course }, ?query: RemovalConfirmation) -> "Removed": async {
            let other =
                Problem::conflict("the parameter `confirm` must be the course's name", "add `confirm=NAME` to the URL");
            ensure(query.confirm == course, other)?;
            admin.remove_course(&course).await
        };
    /// Removes a person from the course. Their submissions are kept.
    delete "/api/v1/courses/{course}/members/{login}" "courses"
        remove_member(staff: Staff, { login }, ?query: SeenEvent) -> "The member is removed":
            staff.remove_member(&login, query.event());
}
