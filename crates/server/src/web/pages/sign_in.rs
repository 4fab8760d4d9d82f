//! The pages for signing in and out.
use super::{
    super::{
        guard::{SESSION_SECONDS, session_cookie},
        input::{Fields, QueryInput, UrlPathParts},
    },
    Page, PageFrame, render,
};
use crate::{
    domain::{App, NewSecret, Person, Visitor},
    problem::Problem,
};
use askama::Template;
use axum::{
    http::{HeaderValue, header},
    response::{IntoResponse, Redirect, Response},
};
use serde::Deserialize;
use url::form_urlencoded::byte_serialize;

#[derive(Template)]
#[template(path = "sign_in.html")]
struct SignInPage {
    frame: PageFrame,
    /// The provider's name, and the URL at which a sign-in at the provider begins.
    provider: Option<(String, String)>,
    /// The reason why the provider cannot be used at present.
    fault: String,
    /// The path of the page that opens after the sign-in.
    to: String,
}

#[derive(Template)]
#[template(path = "welcome.html")]
struct WelcomePage {
    frame: PageFrame,
    /// The name and the courses of the link's owner; `None` if the link can no longer be used.
    owner: Option<(String, Option<String>)>,
}

#[derive(Deserialize)]
pub(super) struct Token {
    token: String,
    #[serde(default)]
    to: String,
}

/// The page that a person requested before they signed in.
#[derive(Deserialize)]
pub(super) struct NextPage {
    #[serde(default, rename = "to")]
    pub(super) path: String,
}

/// Returns a path on this server. If the text is anything else, the path of the home page is returned. Browsers read
/// `//` and `/\` as the start of another host's name.
pub(super) fn local_path(path: &str) -> &str {
    let is_local =
        path.starts_with('/') && !path.starts_with("//") && path.bytes().all(|c| c.is_ascii_graphic() && c != b'\\');
    if is_local { path } else { "/" }
}

/// Returns a redirection that sets the cookie of a new session.
pub(super) fn start_session(app: &App, session: &NewSecret, path: &str) -> Response {
    with_cookie(&session_cookie(app, session.reveal(), SESSION_SECONDS), path)
}

/// The parameters with which another service answers a sign-in.
#[derive(Deserialize)]
pub(super) struct Answer {
    state: Option<String>,
    /// The provider's code, or the learning platform's token.
    #[serde(alias = "id_token")]
    code: Option<String>,
    error: Option<String>,
    error_description: Option<String>,
}

impl Answer {
    /// Returns the state and the code. If the service reports an error instead, the rejection contains it, shortened to
    /// one line.
    pub(super) fn read(self, service: &str, reject: fn(String) -> Problem) -> Result<(String, String), Problem> {
        if let (Some(state), Some(code)) = (self.state, self.code) {
            return Ok((state, code));
        }
        let fault = [self.error, self.error_description].into_iter().flatten().collect::<Vec<_>>().join(": ");
        let fault: String = fault.chars().filter(|c| !c.is_control()).take(300).collect();
        Err(match fault.as_str() {
            "" => Problem::invalid("the state, or the code or token, is missing"),
            fault if fault.starts_with("access_denied") => {
                reject(format!("the sign-in was stopped by you or by the {service} ({fault})"))
            }
            fault => reject(format!("the {service} reports: {fault}")),
        })
    }
}

pub(super) fn with_cookie(cookie: &str, path: &str) -> Response {
    let mut response = Redirect::to(path).into_response();
    if let Ok(value) = HeaderValue::from_str(cookie) {
        response.headers_mut().append(header::SET_COOKIE, value);
    }
    response
}

/// Returns the page that lists the ways to sign in.
pub(super) fn render_ways(visitor: &Visitor, to: String, fault: String) -> Page {
    let query = byte_serialize(to.as_bytes()).collect::<String>();
    let provider = visitor.app.provider.as_ref();
    let provider = provider.map(|provider| (provider.label.clone(), format!("/sign-in/provider?to={query}")));
    render(&SignInPage { frame: PageFrame::default(), provider, fault, to })
}

pub(super) async fn show_page(visitor: Visitor, QueryInput(NextPage { path: to }): QueryInput<NextPage>) -> Page {
    render_ways(&visitor, to, String::new())
}

pub(super) async fn sign_in_by_token(visitor: Visitor, Fields(form): Fields<Token>) -> Result<Response, Problem> {
    let session = visitor.sign_in_by_token(form.token.trim()).await?;
    Ok(start_session(&visitor.app, &session, local_path(&form.to)))
}

/// Shows the page of a sign-in link. Opening the link does not sign in yet, because mail programs also open links.
pub(super) async fn show_welcome(
    visitor: Visitor,
    person: Result<Person, Problem>,
    UrlPathParts { secret, .. }: UrlPathParts,
) -> Page {
    let frame = person.map_or_else(|_| PageFrame::default(), |person| PageFrame::for_account(&person.account));
    render(&WelcomePage { frame, owner: visitor.link_owner(&secret).await? })
}

pub(super) async fn use_link(visitor: Visitor, UrlPathParts { secret, .. }: UrlPathParts) -> Result<Response, Problem> {
    let session = visitor.sign_in_by_link(&secret).await?;
    Ok(start_session(&visitor.app, &session, "/"))
}

pub(super) async fn sign_out(visitor: Visitor) -> Result<Response, Problem> {
    visitor.sign_out().await?;
    Ok(with_cookie(&session_cookie(&visitor.app, "", 0), "/sign-in"))
}

#[cfg(test)]
mod tests {
    use super::local_path;

    #[test]
    fn the_way_on_leads_to_this_server_only() {
        assert_eq!(local_path("/c/physics/a/m1?q=x"), "/c/physics/a/m1?q=x");
        for other in
            ["", "c", "//evil.example", "/\\evil.example", "https://evil.example/", "/\r\nX: y", "/\t/evil.example"]
        {
            assert_eq!(local_path(other), "/", "{other:?}");
        }
    }
}
