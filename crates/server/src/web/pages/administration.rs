//! The pages for administrators, one per subject.
use super::{
    super::{
        api::{CourseInput, WorkerTokenName},
        input::{Fields, QueryInput, UrlPathParts},
    },
    Page, PageFrame,
    course::People,
    render, text,
};
use crate::{
    domain::{Admin, App, CourseSize, Event, EventQuery, ListedAccount, Queue, TokenInfo},
    lti::Platform,
    problem::Problem,
};
use askama::Template;
use axum::{http::Uri, response::Redirect};
use serde::Deserialize;

/// The subjects of the pages. Each has the end of its page's URL, and its title.
const SECTIONS: [(&str, &str); 5] = [
    ("", "Courses"),
    ("/people", "People"),
    ("/platforms", "Learning platforms"),
    ("/workers", "Queue and workers"),
    ("/log", "Log"),
];

#[derive(Template)]
#[template(path = "admin.html")]
struct AdminPage<'a> {
    frame: PageFrame,
    /// The subject that this page shows.
    section: (&'static str, &'static str),
    courses: Vec<CourseSize>,
    accounts: Vec<ListedAccount>,
    filter: People,
    /// The URL of the next page of accounts; `None` on the last page.
    after: Option<String>,
    workers: Vec<TokenInfo>,
    platforms: Vec<Platform>,
    app: &'a App,
    queue: Queue,
    events: Vec<Event>,
    query: EventQuery,
    /// A new sign-in link or a new token for workers. It is shown only once.
    secret: Option<String>,
}

#[derive(Deserialize)]
pub(super) struct NewAccount {
    login: String,
    name: String,
    is_admin: Option<String>,
}

async fn make_page(admin: &Admin, end: &str, (filter, query): (People, EventQuery), secret: Option<String>) -> Page {
    let section = SECTIONS.into_iter().find(|section| section.0 == end).unwrap_or(SECTIONS[0]);
    let frame = PageFrame::for_account(&admin.account)
        .with_parent("/admin".to_owned(), "Administration")
        .with_pages("/admin", &SECTIONS);
    let frame = frame.with_parent(format!("/admin{}", section.0), section.1);
    let (accounts, has_more) = admin.accounts_page(&filter.q, &filter.after).await?;
    let after = filter.next(accounts.last().filter(|_| has_more).map(|last| last.login.as_str()));
    let (courses, platforms) = (admin.course_sizes().await?, admin.platforms().await?);
    let (workers, queue, events) = (admin.worker_tokens().await?, admin.queue().await?, admin.audit(&query).await?);
    let app = &admin.app;
    render(&AdminPage {
        frame,
        section,
        courses,
        accounts,
        filter,
        after,
        workers,
        platforms,
        app,
        queue,
        events,
        query,
        secret,
    })
}

pub(super) async fn show_page(
    admin: Admin,
    uri: Uri,
    QueryInput(filter): QueryInput<People>,
    QueryInput(query): QueryInput<EventQuery>,
) -> Page {
    make_page(&admin, uri.path().trim_start_matches("/admin"), (filter, query), None).await
}

pub(super) async fn set_account(admin: Admin, Fields(form): Fields<NewAccount>) -> Page {
    let link = admin.set_account(form.login.trim(), form.name.trim(), form.is_admin.is_some()).await?.link;
    make_page(&admin, "/people", Default::default(), link).await
}

pub(super) async fn new_worker(admin: Admin, Fields(form): Fields<WorkerTokenName>) -> Page {
    let token = admin.new_worker_token(form.name.trim()).await?.token;
    make_page(&admin, "/workers", Default::default(), Some(token)).await
}

actions! {
    new_course(admin: Admin, form: CourseInput):
        admin.new_course(form.slug.trim(), form.title.trim()) => "/c/{}", form.slug.trim();
    revoke_worker(admin: Admin, { id }): admin.revoke_worker_token(id) => "/admin/workers";
}
