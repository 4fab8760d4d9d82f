//! The home page, which shows a person's courses, and the page of a person's account and tokens.
use super::{
    super::{
        api::TokenName,
        input::{Fields, UrlPathParts},
    },
    Page, PageFrame,
    course::{AssignmentRow, read_rows},
    render, text,
};
use crate::{
    domain::{Course, CourseMembership, Member, Person, TokenInfo},
    problem::Problem,
};
use askama::Template;
use axum::response::Redirect;

/// The number of listed courses after which an administrator sees only the names of courses in which they are not a
/// member.
const MAX_COURSES: usize = 5;

#[derive(Template)]
#[template(path = "home.html")]
struct HomePage {
    frame: PageFrame,
    name: String,
    courses: Vec<HomeCourse>,
    /// Courses in which the administrator is not a member, which are listed without their assignments.
    others: Vec<Course>,
    /// Whether the server offers the page that checks traces.
    checks_traces: bool,
}

/// A course of the person on the home page.
struct HomeCourse {
    member: Member,
    /// Whether the person sees the course as administrator, without being a member.
    is_guest: bool,
    /// The course's assignments that accept submissions at present.
    assignments: Vec<AssignmentRow>,
    /// The number of the course's assignments that are not listed.
    unlisted: usize,
}

#[derive(Template)]
#[template(path = "account.html")]
struct AccountPage<'a> {
    frame: PageFrame,
    person: &'a Person,
    is_connected: bool,
    courses: Vec<CourseMembership>,
    tokens: Vec<TokenInfo>,
    new_token: Option<String>,
}

pub(super) async fn show_home(person: Person) -> Page {
    let frame = PageFrame::for_account(&person.account);
    let (mut courses, mut others) = (Vec::new(), Vec::new());
    for course in person.courses().await? {
        if course.role == "admin" && courses.len() >= MAX_COURSES {
            others.push(course.course);
            continue;
        }
        let member = person.clone().into_member(&course.course.slug).await?;
        let (assignments, rest): (Vec<_>, _) = read_rows(&member).await?.into_iter().partition(AssignmentRow::is_open);
        let is_guest = course.role == "admin";
        courses.push(HomeCourse { member, is_guest, assignments, unlisted: rest.len() });
    }
    let checks_traces = person.app.checker.is_some();
    render(&HomePage { frame, name: person.account.name, courses, others, checks_traces })
}

async fn render_account(person: &Person, new_token: Option<String>) -> Page {
    let frame = PageFrame::for_account(&person.account).with_parent("/account".to_owned(), "Account");
    let (is_connected, courses, tokens) =
        (person.is_connected().await?, person.courses().await?, person.tokens().await?);
    render(&AccountPage { frame, person, is_connected, courses, tokens, new_token })
}

pub(super) async fn show_account(person: Person) -> Page {
    render_account(&person, None).await
}

/// Creates a token, and shows its secret. The secret cannot be shown again.
pub(super) async fn new_token(person: Person, Fields(form): Fields<TokenName>) -> Page {
    let token = person.new_token(form.name.trim()).await?.token;
    render_account(&person, Some(token)).await
}

actions! {
    revoke_token(person: Person, { id }): person.revoke_token(id) => "/account";
}
