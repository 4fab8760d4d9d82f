//! The pages for signing in at an OpenID Connect provider.
use super::{
    super::{identification::provider_cookie, input::QueryInput},
    sign_in::{self, Answer, NextPage},
};
use crate::{
    domain::{App, LoginAnswer, Person, Visitor},
    problem::Problem,
};
use axum::{
    http::StatusCode,
    response::{IntoResponse, Redirect, Response},
};

/// Redirects to the provider, and sets a cookie by which the browser is recognized when it returns. The browser then
/// opens a page of this server, so a cookie with `SameSite=Lax` is sent.
fn redirect(app: &App, login: &LoginAnswer) -> Response {
    let secure = if app.is_secure() { "; Secure" } else { "" };
    let (name, value) = (provider_cookie(app.is_secure()), &login.browser);
    let cookie = format!("{name}={value}; Path=/; HttpOnly; SameSite=Lax; Max-Age=600{secure}");
    sign_in::with_cookie(&cookie, &login.address)
}

/// Begins a sign-in. If the provider does not answer, the sign-in page reports this and offers the other ways.
pub(super) async fn begin_sign_in(
    visitor: Visitor,
    QueryInput(NextPage { path: to }): QueryInput<NextPage>,
) -> Result<Response, Problem> {
    match visitor.begin_at_provider(sign_in::local_path(&to), None).await {
        Ok(answer) => Ok(redirect(&visitor.app, &answer)),
        Err(problem) if problem.status() == StatusCode::SERVICE_UNAVAILABLE => {
            let page = sign_in::render_ways(&visitor, to, problem.detail)?;
            Ok((StatusCode::SERVICE_UNAVAILABLE, page).into_response())
        }
        Err(problem) => Err(problem),
    }
}

pub(super) async fn begin_connection(visitor: Visitor, person: Person) -> Result<Response, Problem> {
    let login = visitor.begin_at_provider("/account", Some(&person)).await?;
    Ok(redirect(&visitor.app, &login))
}

pub(super) async fn accept(visitor: Visitor, QueryInput(answer): QueryInput<Answer>) -> Result<Response, Problem> {
    let (state, code) = answer.read("provider", Problem::rejected_sign_in)?;
    let signed_in = visitor.sign_in_by_provider(&state, &code).await?;
    Ok(sign_in::start_session(&visitor.app, &signed_in.session, sign_in::local_path(&signed_in.path)))
}

actions! {
    disconnect(person: Person): person.disconnect() => "/account";
}
