//! Courses and their members.
use super::{
    super::input::{Asked, Body, Params, Text},
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
pub(super) struct CourseWish {
    #[schema(value_type = Slug)]
    slug: String,
    #[schema(value_type = Title)]
    title: String,
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

/// What is to be handed on to a new member.
#[derive(Serialize, ToSchema)]
pub(super) struct MemberLinks {
    /// A link that signs in once, good for a week; nothing where the account was there before.
    link: Option<String>,
    /// A link to accept by, for whoever has an account of their own: they open it, signed in as ever.
    invitation: Option<String>,
}

/// The courses that one is in.
#[utoipa::path(get, path = "/api/v1/courses", tag = "courses",
    responses((status = 200, body = Vec<CourseOf>), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn courses(person: Person) -> Result<Json<Vec<CourseOf>>, Problem> {
    Ok(Json(person.courses().await?))
}

/// Makes a course.
#[utoipa::path(post, path = "/api/v1/courses", tag = "administration", request_body = CourseWish,
    responses((status = 201, body = Course), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn new_course(
    admin: Admin,
    Body(wish): Body<CourseWish>,
) -> Result<(StatusCode, Json<Course>), Problem> {
    Ok((StatusCode::CREATED, Json(admin.new_course(&wish.slug, &wish.title).await?)))
}

/// Puts a course away: nobody hands in any more, and everything stays to be read.
#[utoipa::path(put, path = "/api/v1/courses/{course}/archived", tag = "administration", params(("course" = String, Path)),
    responses((status = 204, description = "Archived"), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn archive(admin: Admin, Params(course): Params<String>) -> Result<StatusCode, Problem> {
    admin.archive_course(&course, true).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Takes it out again.
#[utoipa::path(delete, path = "/api/v1/courses/{course}/archived", tag = "administration",
    params(("course" = String, Path)),
    responses((status = 204, description = "Open again"), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn reopen(admin: Admin, Params(course): Params<String>) -> Result<StatusCode, Problem> {
    admin.archive_course(&course, false).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// Removes a course with its assignments, submissions and log, for ever. Accounts stay.
#[utoipa::path(delete, path = "/api/v1/courses/{course}", tag = "administration",
    params(("course" = String, Path), ("confirm" = String, Query, description = "The course's name once more")),
    responses((status = 204, description = "Removed"), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn remove_course(
    admin: Admin,
    Params(course): Params<String>,
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

/// The members of a course.
#[utoipa::path(get, path = "/api/v1/courses/{course}/members", tag = "courses", params(("course" = String, Path)),
    responses((status = 200, body = Vec<MemberInfo>), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn members(staff: Staff) -> Result<Json<Vec<MemberInfo>>, Problem> {
    Ok(Json(staff.members().await?))
}

/// Makes somebody a member, and their account when there is none; a new account gets a link that signs in once. Whoever
/// has an account of their own is invited, and nothing changes until they accept.
#[utoipa::path(put, path = "/api/v1/courses/{course}/members/{login}", tag = "courses",
    params(("course" = String, Path), ("login" = String, Path)), request_body = MemberWish,
    responses((status = 200, body = MemberLinks), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn set_member(
    staff: Staff,
    Params((_, login)): Params<(String, String)>,
    Body(wish): Body<MemberWish>,
) -> Result<Json<MemberLinks>, Problem> {
    let added = staff.set_member(&login, &wish.name, &wish.role).await?;
    let house = staff.member().house();
    let invitation = added.invitation.map(|secret| house.invitation_address(&secret));
    Ok(Json(MemberLinks { link: link(house, added.link).link, invitation }))
}

/// A line of a table of members, and what became of it.
#[derive(Serialize, ToSchema)]
pub(super) struct MemberLine {
    line: u64,
    name: String,
    login: String,
    email: String,
    role: String,
    /// What is wrong with the line; then nothing was done about any.
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
    params(("course" = String, Path), ("preview" = Option<bool>, Query, description = "Only look at the table")),
    request_body(content = String, content_type = "text/csv"),
    responses((status = 200, body = Vec<MemberLine>), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn import(
    staff: Staff,
    Asked(asked): Asked<Preview>,
    Text(table): Text,
) -> Result<Json<Vec<MemberLine>>, Problem> {
    let lines = staff.import(&table, asked.preview).await?;
    let house = staff.member().house();
    let told = lines.into_iter().map(|one| MemberLine {
        links: MemberLinks {
            link: one.link.map(|secret| house.welcome_address(&secret)),
            invitation: one.invitation.map(|secret| house.invitation_address(&secret)),
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

/// Takes somebody out of the course; what they handed in stays.
#[utoipa::path(delete, path = "/api/v1/courses/{course}/members/{login}", tag = "courses",
    params(("course" = String, Path), ("login" = String, Path)),
    responses((status = 204, description = "They are out"), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn remove_member(
    staff: Staff,
    Params((_, login)): Params<(String, String)>,
) -> Result<StatusCode, Problem> {
    staff.remove_member(&login).await?;
    Ok(StatusCode::NO_CONTENT)
}

/// A new link that signs a student of this course in once.
#[utoipa::path(post, path = "/api/v1/courses/{course}/members/{login}/link", tag = "courses",
    params(("course" = String, Path), ("login" = String, Path)),
    responses((status = 200, body = Link), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn member_link(
    staff: Staff,
    Params((_, login)): Params<(String, String)>,
) -> Result<Json<Link>, Problem> {
    let secret = staff.new_link(&login).await?;
    Ok(Json(link(staff.member().house(), Some(secret))))
}

/// What happened in the course, latest first, 200 at a time.
#[utoipa::path(get, path = "/api/v1/courses/{course}/audit", operation_id = "course_audit", tag = "courses",
    params(("course" = String, Path), ("before" = Option<i64>, Query, description = "Only events before this one")),
    responses((status = 200, body = Vec<Event>), (status = "default", body = Problem, content_type = "application/problem+json")))]
pub(super) async fn audit(staff: Staff, Asked(asked): Asked<Before>) -> Result<Json<Vec<Event>>, Problem> {
    Ok(Json(staff.audit(asked.before).await?))
}
