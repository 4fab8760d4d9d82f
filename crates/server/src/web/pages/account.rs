//! The home page with a person's courses, and the page with their tokens.
use super::{
    super::{
        api::TokenName,
        input::{AddressParts, Fields},
    },
    Page, PageFrame,
    course::{Row, rows},
    redirect_to, show, text,
};
use crate::{
    domain::{Course, CourseMembership, Member, Person, TokenInfo},
    problem::Problem,
};
use askama::Template;
use axum::response::Redirect;

/// The number of courses above which an administrator sees only the assignments of their own.
const MAX_COURSES: usize = 5;

#[derive(Template)]
#[template(path = "home.html")]
struct Home {
    frame: PageFrame,
    name: String,
    courses: Vec<HomeCourse>,
    /// The courses that an administrator is not a member of.
    others: Vec<Course>,
    /// Whether the server has the page that checks traces.
    checks_traces: bool,
}

/// A course of the person.
struct HomeCourse {
    member: Member,
    /// The assignments that accept submissions.
    assignments: Vec<Row>,
    /// The number of assignments that are not listed.
    rest: usize,
}

#[derive(Template)]
#[template(path = "account.html")]
struct AccountPage<'a> {
    frame: PageFrame,
    person: &'a Person,
    is_connected: bool,
    courses: Vec<CourseMembership>,
    tokens: Vec<TokenInfo>,
    new: Option<String>,
}

pub(super) async fn home(person: Person) -> Page {
    let frame = PageFrame::for_account(&person.account);
    let (mut courses, mut others) = (Vec::new(), Vec::new());
    for course in person.courses().await? {
        if course.role == "admin" && courses.len() >= MAX_COURSES {
            others.push(course.course);
            continue;
        }
        let member = person.clone().member_of(&course.course.slug).await?;
        let (assignments, closed): (Vec<Row>, Vec<Row>) = rows(&member).await?.into_iter().partition(Row::is_open);
        courses.push(HomeCourse { member, assignments, rest: closed.len() });
    }
    let checks_traces = person.app.checker.is_some();
    show(&Home { frame, name: person.account.name, courses, others, checks_traces })
}

async fn page(person: &Person, new: Option<String>) -> Page {
    let frame = PageFrame::for_account(&person.account).with_parent("/account".to_owned(), "Account");
    let (is_connected, courses, tokens) =
        (person.is_connected().await?, person.courses().await?, person.tokens().await?);
    show(&AccountPage { frame, person, is_connected, courses, tokens, new })
}

pub(super) async fn account(person: Person) -> Page {
    page(&person, None).await
}

/// Creates a token, whose secret is shown only in this answer.
pub(super) async fn new_token(person: Person, Fields(form): Fields<TokenName>) -> Page {
    let token = person.new_token(form.name.trim()).await?.token;
    page(&person, Some(token)).await
}

deeds! {
    revoke_token(person: Person, { id }): person.revoke_token(id) => "/account";
}
