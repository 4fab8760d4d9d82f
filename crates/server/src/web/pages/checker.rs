//! The page that checks traces in a browser. The grader provides it, and it contains no personal data, so any visitor
//! may read it.
use crate::{domain::App, problem::Problem};
use axum::{
    extract::State,
    http::{HeaderValue, header},
    response::{Html, IntoResponse, Response},
};

/// Returns the page. Its own policy is stricter than that of other pages: it allows only the page's WebAssembly module.
pub(super) async fn show_page(State(app): State<App>) -> Result<Response, Problem> {
    let missing = || Problem {
        detail: "this server was installed without the page that checks traces".to_owned(),
        remedy: "ask the server's administrator".to_owned(),
        ..Problem::not_found("")
    };
    // The page is also used without a server, so only this copy has a link to one.
    let page = app.checker.as_ref().ok_or_else(missing)?;
    let page = page.replacen("<strong class=\"brand\">fosssim-oracle</strong>", "<a href=\"/\">Courses</a>", 1);
    let policy = find_policy(&page).and_then(|policy| HeaderValue::from_str(policy).ok());
    let mut answer = Html(page).into_response();
    if let Some(policy) = policy {
        answer.headers_mut().insert(header::CONTENT_SECURITY_POLICY, policy);
    }
    answer.headers_mut().insert(header::CACHE_CONTROL, HeaderValue::from_static("public, max-age=3600"));
    Ok(answer)
}

/// Returns the content security policy from the head of a page.
fn find_policy(page: &str) -> Option<&str> {
    let (_, rest) = page.split_once("http-equiv=\"Content-Security-Policy\" content=\"")?;
    Some(rest.split_once('"')?.0)
}
