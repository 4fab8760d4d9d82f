//! Rules for every request: which sites may send it, the headers of its answer, and its entry in the log.
use super::identification::{self, secrets};
use super::input::ArrivalTime;
use crate::{domain::App, problem::Problem};
use axum::{
    extract::{MatchedPath, Request, State},
    http::{HeaderMap, HeaderName, HeaderValue, Method, header},
    middleware::Next,
    response::{IntoResponse, Response},
};
use std::time::Instant;

/// The content security policy of pages. They use only files of this server, and cannot be shown in a frame.
const PAGE_POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; \
                      media-src blob:; connect-src 'self'; form-action 'self'; base-uri 'none'; \
                      frame-ancestors 'none'";

/// The URLs to which learning platforms send people, always from the platform's site. The secret of the sign-in
/// proves that the request comes from the browser in which it began.
const PLATFORM_ADDRESSES: [&str; 2] = ["/lti/login", "/lti/launch"];

/// The page that connects an account to a provider. Requests from other sites are rejected, because another site could
/// have signed this browser in at the provider.
const CONNECT_ADDRESS: &str = "/account/provider";

/// Rejects requests that another site made a browser send. Another site can't send a token in a header, so requests
/// with a token are accepted. All other requests that change something must come from this site. The browser confirms
/// this in the header `Sec-Fetch-Site` (older browsers use `Origin`).
pub(super) async fn check_site(State(app): State<App>, request: Request, next: Next) -> Response {
    if (is_safe_method(request.method()) && request.uri().path() != CONNECT_ADDRESS)
        || PLATFORM_ADDRESSES.contains(&request.uri().path())
        || secrets(request.headers(), app.is_secure()).bearer.is_some()
        || is_same_site(request.headers(), &app)
    {
        return next.run(request).await;
    }
    // A request without any of these headers comes from a program, which needs a token.
    if request.uri().path().starts_with("/api/") && secrets(request.headers(), app.is_secure()).session.is_none() {
        return Problem::not_signed_in().into_response();
    }
    Problem::cross_site().into_response()
}

/// Sends a session's cookie again if the session was extended.
pub(super) async fn renew_cookie(State(app): State<App>, mut request: Request, next: Next) -> Response {
    let renewed = identification::RenewedSession::default();
    request.extensions_mut().insert(renewed.clone());
    let mut response = next.run(request).await;
    if let Some(session) = renewed.session()
        && !response.headers().contains_key(header::SET_COOKIE)
        && let Ok(cookie) = HeaderValue::from_str(&session_cookie(&app, session, SESSION_SECONDS))
    {
        response.headers_mut().append(header::SET_COOKIE, cookie);
    }
    response
}

/// The lifetime of a session, in seconds.
pub(super) const SESSION_SECONDS: u32 = 1_209_600;

/// Returns the cookie for a session, with a lifetime in seconds.
pub(super) fn session_cookie(app: &App, session: &str, lifetime: u32) -> String {
    let (name, secure) = (identification::cookie_name(app.is_secure()), if app.is_secure() { "; Secure" } else { "" });
    format!("{name}={session}; Path=/; HttpOnly; SameSite=Lax; Max-Age={lifetime}{secure}")
}

fn is_safe_method(method: &Method) -> bool {
    matches!(*method, Method::GET | Method::HEAD | Method::OPTIONS)
}

fn is_same_site(headers: &HeaderMap, app: &App) -> bool {
    let text = |name: HeaderName| headers.get(name).and_then(|value| value.to_str().ok());
    if let Some(site) = text(HeaderName::from_static("sec-fetch-site")) {
        return matches!(site, "same-origin" | "none");
    }
    let Some(origin) = text(header::ORIGIN) else { return false };
    origin == app.public
        || text(header::HOST)
            .is_some_and(|host| origin.split_once("://").is_some_and(|(_, authority)| authority == host))
}

/// Adds the headers that every answer has.
pub(super) async fn add_headers(State(app): State<App>, request: Request, next: Next) -> Response {
    let mut response = next.run(request).await;
    let headers = response.headers_mut();
    let mut set = |name: HeaderName, value: &'static str| {
        headers.entry(name).or_insert(HeaderValue::from_static(value));
    };
    set(header::CONTENT_SECURITY_POLICY, PAGE_POLICY);
    set(header::X_CONTENT_TYPE_OPTIONS, "nosniff");
    set(header::REFERRER_POLICY, "same-origin");
    set(HeaderName::from_static("cross-origin-opener-policy"), "same-origin");
    set(HeaderName::from_static("cross-origin-resource-policy"), "same-origin");
    set(header::CACHE_CONTROL, "no-store");
    if app.is_secure() {
        set(header::STRICT_TRANSPORT_SECURITY, "max-age=31536000");
    }
    response
}

/// Logs and counts a request by its route, never by its URL, which may contain secrets.
pub(super) async fn log_request(State(app): State<App>, mut request: Request, next: Next) -> Response {
    let start = Instant::now();
    request.extensions_mut().insert(ArrivalTime(start));
    let in_flight = app.instruments().begin();
    let method = request.method().clone();
    let route = request.extensions().get::<MatchedPath>().map_or("none", MatchedPath::as_str).to_owned();
    let response = next.run(request).await;
    drop(in_flight);
    let (status, took) = (response.status().as_u16(), start.elapsed());
    let usual = [Method::GET, Method::HEAD, Method::POST, Method::PUT, Method::DELETE, Method::OPTIONS, Method::PATCH];
    // Clients can invent methods, and each method would add a series to the metrics.
    let method_label = if usual.contains(&method) { method.as_str() } else { "other" };
    app.instruments().count_answer(method_label, &route, status, took);
    let took = took.as_millis();
    if response.status().is_server_error() {
        tracing::warn!(%method, route, status, took, "answered");
    } else {
        tracing::debug!(%method, route, status, took, "answered");
    }
    response
}
