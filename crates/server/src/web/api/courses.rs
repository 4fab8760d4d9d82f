//! Courses and their members.
use super::{
    super::input::{Asked, At, Body, Text},
    accounts::{Before, Link, link},
};
use crate::{
    access::{Admin, Course, CourseOf, Event, MemberInfo, Person, Staff},
    problem::Problem,
    schema::{Slug, Title},
};
use axum::{Json, http::StatusCode};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A course as it is to be.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::web) struct CourseWish {
    #[schema(value_type = Slug)]
    pub(in crate::web) slug: String,
    #[schema(value_type = Title)]
    pub(in crate::web) title: String,
}

/// A member as they are to be.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MemberWish {
    /// Used when the account is new.
    #[schema(value_type = Title)]
    name: String,
    /// `student` or `staff`.
    #[schema(pattern = "^(student|staff)$")]
    role: String,
}

/// The links that are to be handed on to a new member.
#[derive(Serialize, ToSchema)]
pub(super) struct MemberLinks {
    /// A link that signs in once, good for a week; nothing where the account was there before.
    link: Option<String>,
    /// A link to accept by, for anybody who has an account of their own: they open it, signed in as ever.
    invitation: Option<String>,
}

/// Makes a course.
#[utoipa::path(post, path = "/api/v1/courses", tag = "administration", request_body = CourseWish,
    responses((status = 201, body = Course)))]
pub(super) async fn new_course(
    admin: Admin,
    Body(wish): Body<CourseWish>,
) -> Result<(StatusCode, Json<Course>), Problem> {
    Ok((StatusCode::CREATED, Json(admin.new_course(&wish.slug, &wish.title).await?)))
}

/// Removes a course with its assignments, submissions and log, for ever. Accounts stay.
#[utoipa::path(delete, path = "/api/v1/courses/{course}", tag = "administration",
    params(("confirm" = String, Query, description = "The course's name once more")),
    responses((status = 204, description = "Removed")))]
pub(super) async fn remove_course(
    admin: Admin,
    At { course, .. }: At,
    Asked(asked): Asked<Confirm>,
) -> Result<StatusCode, Problem> {
    if asked.confirm != course {
        return Err(Problem::conflict(
            "confirm is another name than the course's",
            "name the course once more in confirm",
        ));
    }
    admin.remove_course(&course).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// That it is meant.
#[derive(Deserialize)]
pub(super) struct Confirm {
    confirm: String,
}

/// Makes somebody a member, and their account when there is none; a new account gets a link that signs in once. Anybody
/// who has an account of their own is invited, and nothing changes until they accept.
#[utoipa::path(put, path = "/api/v1/courses/{course}/members/{login}", tag = "courses", request_body = MemberWish,
    responses((status = 200, body = MemberLinks)))]
pub(super) async fn set_member(
    staff: Staff,
    At { login, .. }: At,
    Body(wish): Body<MemberWish>,
) -> Result<Json<MemberLinks>, Problem> {
    let added = staff.set_member(&login, &wish.name, &wish.role).await?;
    let app = &staff.app;
    let invitation = added.invitation.map(|secret| app.invitation_address(&secret));
    Ok(Json(MemberLinks { link: link(app, added.link).link, invitation }))
}

/// A line of a table of members, and what became of it.
#[derive(Serialize, ToSchema)]
pub(super) struct MemberLine {
    line: u64,
    name: String,
    login: String,
    email: String,
    role: String,
    /// The error in the line; then nothing was done about any.
    error: Option<String>,
    #[serde(flatten)]
    links: MemberLinks,
}

/// Whether only to look.
#[derive(Deserialize)]
pub(super) struct Preview {
    #[serde(default)]
    preview: bool,
}

/// Makes all members of a table: `name,login,email,role`, or as its first line names them. If anything is wrong with a
/// line, nothing is done.
#[utoipa::path(post, path = "/api/v1/courses/{course}/members", tag = "courses",
    params(("preview" = Option<bool>, Query, description = "Only look at the table")),
    request_body(content = String, content_type = "text/csv"),
    responses((status = 200, body = Vec<MemberLine>)))]
pub(super) async fn import(
    staff: Staff,
    Asked(asked): Asked<Preview>,
    Text(table): Text,
) -> Result<Json<Vec<MemberLine>>, Problem> {
    let lines = staff.import(&table, asked.preview).await?;
    let app = &staff.app;
    let told = lines.into_iter().map(|one| MemberLine {
        links: MemberLinks {
            link: one.link.map(|secret| app.welcome_address(&secret)),
            invitation: one.invitation.map(|secret| app.invitation_address(&secret)),
        },
        line: one.line,
        name: one.name,
        login: one.login,
        email: one.email,
        role: one.role,
        error: one.error,
    });
    Ok(Json(told.collect()))
}

/// A new link that signs a student of this course in once.
#[utoipa::path(post, path = "/api/v1/courses/{course}/members/{login}/link", tag = "courses",
    responses((status = 200, body = Link)))]
pub(super) async fn member_link(staff: Staff, At { login, .. }: At) -> Result<Json<Link>, Problem> {
    let secret = staff.new_link(&login).await?;
    Ok(Json(link(&staff.app, Some(secret))))
}

/// The events of the course, latest first, 200 at a time.
#[utoipa::path(get, path = "/api/v1/courses/{course}/audit", operation_id = "course_audit", tag = "courses",
    params(("before" = Option<i64>, Query, description = "Only events before this one")),
    responses((status = 200, body = Vec<Event>)))]
pub(super) async fn audit(staff: Staff, Asked(asked): Asked<Before>) -> Result<Json<Vec<Event>>, Problem> {
    Ok(Json(staff.audit(asked.before).await?))
}

answers! {
    /// The courses that one is in.
    get "/api/v1/courses" "courses" courses(person: Person) -> Vec<CourseOf>: person.courses();
    /// The members of a course.
    get "/api/v1/courses/{course}/members" "courses" members(staff: Staff) -> Vec<MemberInfo>: staff.members();
}

deeds! {
    /// Puts a course away: nobody hands in any more, and everything stays to be read.
    put "/api/v1/courses/{course}/archived" "administration"
        archive(admin: Admin, { course }) -> "Archived": admin.archive_course(&course, true);
    /// Takes it out again.
    delete "/api/v1/courses/{course}/archived" "administration"
        reopen(admin: Admin, { course }) -> "Open again": admin.archive_course(&course, false);
    /// Takes somebody out of the course; what they handed in stays.
    delete "/api/v1/courses/{course}/members/{login}" "courses"
        remove_member(staff: Staff, { login }) -> "They are out": staff.remove_member(&login);
}
