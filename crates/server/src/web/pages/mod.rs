//! The pages for browsers. They work without JavaScript. With it, the state of a submission is updated, and files can
//! be dropped onto the page.

/// Declares handlers that perform an action and then redirect to a page, one per row. A row has the name, the role, the
/// parts of the URL and the form; then the action; and last the next page.
macro_rules! actions {
    ($($(#[doc = $doc:literal])*
        $name:ident($sender:ident: $role:ty $(, { $($at:ident),* })? $(, $form:ident: $fields:ty)?):
            $do:expr => $to:literal $(, $part:expr)*;)*) => {
        $($(#[doc = $doc])*
        pub(super) async fn $name(
            $sender: $role $(, UrlPathParts { $($at,)* .. }: UrlPathParts)? $(, Fields($form): Fields<$fields>)?
        ) -> Result<Redirect, Problem> {
            $do.await?;
            Ok(Redirect::to(&format!($to $(, $part)*)))
        })*
    };
}

mod account;
mod administration;
mod checker;
mod comparison;
mod course;
mod grades;
mod platform;
mod provider;
mod removal;
mod report;
mod scenes;
mod settings;
mod sign_in;
mod statistics;
mod student;
mod submission;
mod text;

use super::input::UrlPathParts;
use crate::{
    domain::{Account, App, Assignment, Member, Person},
    problem::Problem,
};
use askama::Template;
use axum::{
    Router,
    extract::{FromRequestParts, Request, State},
    http::{HeaderValue, Method, StatusCode, header, request::Parts, uri::PathAndQuery},
    middleware::Next,
    response::{Html, IntoResponse, Redirect, Response},
    routing,
};
use url::{Url, form_urlencoded::byte_serialize};

/// Builds the router for pages, and the list of all pages.
macro_rules! pages {
    ($($method:ident $path:literal => $handler:path,)*) => {
        /// The method and the path of every page.
        pub const PAGES: &[(&str, &str)] = &[$((stringify!($method), $path)),*];

        pub(super) fn router() -> Router<App> {
            Router::new()$(.route($path, routing::$method($handler)))*
        }
    };
}

pages! {
    get "/" => account::show_home,
    get "/check" => checker::show_page,
    get "/sign-in" => sign_in::show_page,
    post "/sign-in" => sign_in::sign_in_by_token,
    get "/sign-in/provider" => provider::begin_sign_in,
    get "/sign-in/provider/answer" => provider::accept,
    get "/welcome/{secret}" => sign_in::show_welcome,
    post "/welcome/{secret}" => sign_in::use_link,
    post "/sign-out" => sign_in::sign_out,
    get "/account" => account::show_account,
    get "/account/provider" => provider::begin_connection,
    post "/account/provider/remove" => provider::disconnect,
    post "/account/tokens" => account::new_token,
    post "/account/tokens/{id}/revoke" => account::revoke_token,
    get "/admin" => administration::show_page,
    get "/admin/people" => administration::show_page,
    get "/admin/platforms" => administration::show_page,
    get "/admin/workers" => administration::show_page,
    get "/admin/log" => administration::show_page,
    post "/admin/courses" => administration::new_course,
    post "/admin/accounts" => administration::set_account,
    post "/admin/accounts/{login}/remove" => removal::remove_person,
    post "/admin/accounts/{login}/shut" => removal::shut_account,
    post "/admin/workers" => administration::new_worker,
    post "/admin/workers/{id}/revoke" => administration::revoke_worker,
    post "/admin/platforms" => platform::set_platform,
    post "/admin/platforms/{name}/shut" => platform::shut_platform,
    post "/admin/platform-keys" => platform::new_key,
    get "/lti/login" => platform::begin_login,
    post "/lti/login" => platform::begin_login,
    post "/lti/launch" => platform::accept,
    get "/lti/keys.json" => platform::send_keys,
    get "/lti/configuration.json" => platform::send_configuration,
    get "/lti/choose/{secret}" => platform::show_choice,
    post "/lti/choose/{secret}/course" => platform::choose_course,
    post "/lti/choose/{secret}/assignment" => platform::choose_assignment,
    get "/c/{course}" => course::show_course,
    post "/c/{course}/assignments" => course::new_assignment,
    post "/c/{course}/remove" => removal::remove_course,
    get "/c/{course}/members" => course::show_members,
    post "/c/{course}/members" => course::set_member,
    get "/c/{course}/members/import" => student::show_import,
    post "/c/{course}/members/import" => student::import_table,
    post "/c/{course}/members/table" => student::import_file,
    post "/c/{course}/members/{login}/remove" => course::remove_member,
    post "/c/{course}/members/{login}/link" => course::member_link,
    post "/c/{course}/members/roster" => platform::read_roster,
    get "/c/{course}/audit" => course::show_audit,
    get "/c/{course}/queue" => course::show_queue,
    get "/c/{course}/a/{assignment}" => submission::show_assignment,
    post "/c/{course}/a/{assignment}" => submission::submit,
    post "/c/{course}/a/{assignment}/remove" => removal::remove_assignment,
    get "/c/{course}/a/{assignment}/settings" => settings::show_page,
    post "/c/{course}/a/{assignment}/settings" => settings::save,
    post "/c/{course}/a/{assignment}/suite" => settings::set_suite,
    get "/c/{course}/a/{assignment}/class" => grades::show_class,
    post "/c/{course}/a/{assignment}/publish" => grades::publish,
    post "/c/{course}/a/{assignment}/withhold" => grades::withhold,
    post "/c/{course}/a/{assignment}/scores" => platform::send_scores,
    post "/c/{course}/a/{assignment}/judge-errors" => grades::grade_errors_again,
    post "/c/{course}/s/{id}/again" => submission::grade_again,
    post "/c/{course}/a/{assignment}/regrades" => grades::begin_regrade,
    get "/c/{course}/a/{assignment}/regrades/{id}" => grades::show_regrade,
    post "/c/{course}/a/{assignment}/regrades/{id}/newcomers" => grades::regrade_newcomers,
    post "/c/{course}/a/{assignment}/regrades/{id}/apply" => grades::apply,
    post "/c/{course}/a/{assignment}/regrades/{id}/discard" => grades::discard,
    get "/c/{course}/s/{id}" => submission::show_submission,
    get "/c/{course}/s/{id}/beside" => comparison::show_page,
    get "/c/{course}/a/{assignment}/students/{login}" => student::show,
    post "/c/{course}/a/{assignment}/students/{login}/extension" => student::extend,
    post "/c/{course}/s/{id}/mark" => student::mark,
    post "/c/{course}/s/{id}/request" => student::request,
    post "/c/{course}/s/{id}/remove" => removal::remove_submission,
    get "/static/style.css" => send_style,
    get "/static/page.js" => send_script,
    get "/static/report.js" => send_report_script,
}

async fn send_style() -> Response {
    // Pages use the style sheet of reports, followed by rules for pages only.
    static_response(
        "text/css; charset=utf-8",
        concat!(
            include!("../../../../render/src/plot/style.in"),
            include_str!("../../../../report/src/page/style.css"),
            include_str!("static/style.css")
        ),
    )
}

/// Returns the script of reports, for reports that are shown on pages.
async fn send_report_script() -> Response {
    static_response("text/javascript; charset=utf-8", include!("../../../../report/src/page/viewer/viewer.in"))
}

async fn send_script() -> Response {
    static_response("text/javascript; charset=utf-8", include_str!("static/page.js"))
}

fn static_response(media_type: &'static str, text: &'static str) -> Response {
    ([(header::CONTENT_TYPE, media_type), (header::CACHE_CONTROL, "max-age=300")], text).into_response()
}

/// The parts that every page has around its content. The default is the frame for a visitor.
#[derive(Default)]
pub(super) struct PageFrame {
    /// The login of the person who is signed in.
    login: Option<String>,
    is_admin: bool,
    /// The pages above this one in the hierarchy, by URL and title.
    parents: Vec<(String, String)>,
    /// The pages about the same subject, by URL and title.
    tabs: Vec<(String, &'static str)>,
    /// The URL of the shown page among `tabs`.
    tab: String,
    /// The URL of the shown page, if the frame names the page.
    address: String,
}

impl PageFrame {
    fn for_account(account: &Account) -> Self {
        Self { login: Some(account.login.clone()), is_admin: account.is_admin, ..Self::default() }
    }

    fn course(member: &Member) -> Self {
        let address = format!("/c/{}", member.slug);
        let frame = Self::for_account(&member.account).with_parent(address.clone(), &member.title);
        let pages = [("", "Assignments"), ("/members", "Members"), ("/queue", "Queue"), ("/audit", "Audit log")];
        if member.is_staff { frame.with_pages(&address, &pages) } else { frame }
    }

    /// Returns the frame for the page of an assignment.
    fn assignment(member: &Member, assignment: &Assignment) -> Self {
        let address = format!("/c/{}/a/{}", member.slug, assignment.slug);
        let pages = [("/class", "Class"), ("", "Submit"), ("/settings", "Settings")];
        let frame = Self::course(member);
        match member.is_staff {
            true => frame.with_parent(format!("{address}/class"), &assignment.title).with_pages(&address, &pages),
            false => frame.with_parent(address, &assignment.title),
        }
    }

    /// Adds the pages about the same subject. `base` is the beginning of their URLs, and `pages` has the rest of
    /// each URL and the title.
    fn with_pages(mut self, base: &str, pages: &[(&str, &'static str)]) -> Self {
        self.tabs = pages.iter().map(|(end, title)| (format!("{base}{end}"), *title)).collect();
        self
    }

    /// Returns the frame with another page above this one.
    fn with_parent(mut self, address: String, title: &str) -> Self {
        self.address.clone_from(&address);
        if self.tabs.iter().any(|(tab, _)| *tab == address) {
            self.tab = address;
        } else if self.parents.last().is_none_or(|(last, _)| *last != address) {
            self.parents.push((address, title.to_owned()));
        }
        self
    }
}

/// A page as HTML, or the reason why it cannot be shown.
type Page = Result<Html<String>, Problem>;

/// Renders a template.
fn render(template: &impl Template) -> Page {
    template.render().map(Html).map_err(|error| {
        tracing::error!(%error, "a page could not be rendered");
        Problem::fault()
    })
}

#[derive(Template)]
#[template(path = "problem.html")]
struct ProblemPage {
    frame: PageFrame,
    problem: Problem,
    /// The path of the page from which the request came.
    back: Option<String>,
}

/// Turns rejections of pages into pages. A person who is not signed in gets the sign-in page.
pub(super) async fn show_problems(State(app): State<App>, request: Request, next: Next) -> Response {
    let (head, body) = request.into_parts();
    let parts = head.clone();
    rejection_page(next.run(Request::from_parts(head, body)).await, parts, &app).await
}

/// Turns rejections of other URLs into pages if the request comes from a browser.
pub(super) async fn show_other_problems(State(app): State<App>, request: Request, next: Next) -> Response {
    let accepted = request.headers().get(header::ACCEPT).and_then(|value| value.to_str().ok());
    let is_browser = accepted.is_some_and(|accepted| accepted.contains("text/html"));
    if !is_browser || request.uri().path().starts_with("/api/") {
        return next.run(request).await;
    }
    show_problems(State(app), request, next).await
}

/// Returns the answer for URLs without a page.
pub(super) async fn missing_page() -> Problem {
    Problem::not_found("page")
}

/// Returns the answer to a method that a URL does not support.
pub(super) async fn wrong_method(method: Method) -> Problem {
    Problem::wrong_method(method.as_str())
}

/// Returns the frame for a rejected request. It is the frame of the assignment or course in the URL, if the person
/// may see that.
async fn find_frame(head: &mut Parts, app: &App) -> Option<PageFrame> {
    let person = Person::from_request_parts(head, app).await.ok()?;
    let frame = PageFrame::for_account(&person.account);
    let Ok(at) = UrlPathParts::from_request_parts(head, app).await else { return Some(frame) };
    let Ok(member) = person.into_member(&at.course).await else { return Some(frame) };
    let assignment = member.assignment(&at.assignment).await;
    Some(assignment.map_or_else(|_| PageFrame::course(&member), |found| PageFrame::assignment(&member, &found)))
}

/// Returns a rejection as a page; other answers do not change. A person who is not signed in is redirected to the
/// sign-in page, and from there back to the page.
async fn rejection_page(mut response: Response, mut head: Parts, app: &App) -> Response {
    let Some(problem) = response.extensions_mut().remove::<Problem>() else { return response };
    let status = problem.status();
    if head.method == Method::GET && status == StatusCode::UNAUTHORIZED {
        let to = head.uri.path_and_query().map_or("/", PathAndQuery::as_str);
        let query = byte_serialize(to.as_bytes()).collect::<String>();
        let address = if to == "/" { "/sign-in".to_owned() } else { format!("/sign-in?to={query}") };
        return Redirect::to(&address).into_response();
    }
    // Use the URL in this header only if it is a page of this server.
    let from = head.headers.get(header::REFERER).and_then(|from| Url::parse(from.to_str().ok()?).ok());
    let back = from.map(|from| sign_in::local_path(&from[url::Position::BeforePath..]).to_owned());
    // If the server fails, the error page reads nothing from the database.
    let frame = if status.is_server_error() { None } else { find_frame(&mut head, app).await };
    match render(&ProblemPage { frame: frame.unwrap_or_default(), problem, back }) {
        Ok(page) => {
            let mut answer = (status, page).into_response();
            if let Some(after) = response.headers_mut().remove(header::RETRY_AFTER) {
                answer.headers_mut().insert(header::RETRY_AFTER, after);
            }
            answer.headers_mut().insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
            answer
        }
        Err(_) => response,
    }
}
