//! Finds the role of a request's sender. The type of a handler's argument names the role that the handler serves;
//! requests of other senders do not reach the handler.
use super::input::SignedIn;
use crate::{
    domain::{Admin, App, Member, Person, RemoteWorker, Secrets, Staff, Visitor},
    problem::Problem,
};
use axum::{
    extract::{ConnectInfo, FromRequestParts, Path},
    http::{HeaderMap, HeaderValue, header, request::Parts},
};
use axum_client_ip::ClientIp;
use serde::Deserialize;
use std::{
    net::SocketAddr,
    sync::{Arc, OnceLock},
};

/// The session whose cookie must be sent again, because this request extended it.
#[derive(Debug, Clone, Default)]
pub(super) struct RenewedSession(Arc<OnceLock<String>>);

impl RenewedSession {
    /// Returns the secret of the session if the cookie must be sent again.
    pub(super) fn session(&self) -> Option<&str> {
        self.0.get().map(String::as_str)
    }
}

/// Returns the name of the session's cookie. Over HTTPS it has a prefix that prevents other hosts from setting the
/// cookie.
pub(super) fn cookie_name(secure: bool) -> &'static str {
    if secure { "__Host-fosssim" } else { "fosssim" }
}

/// Returns the name of the cookie that recognizes a browser during a sign-in from a learning platform.
pub(super) fn browser_cookie(secure: bool) -> &'static str {
    if secure { "__Host-fosssim-lti" } else { "fosssim-lti" }
}

/// Returns the name of the cookie that recognizes a browser during a sign-in at a provider.
pub(super) fn provider_cookie(secure: bool) -> &'static str {
    if secure { "__Host-fosssim-provider" } else { "fosssim-provider" }
}

/// Returns the secrets in a request's headers.
pub(super) fn secrets(headers: &HeaderMap, secure: bool) -> Secrets {
    let text = |name| headers.get(name).and_then(|value: &HeaderValue| value.to_str().ok());
    let bearer = text(header::AUTHORIZATION)
        .and_then(|value| value.split_once(' '))
        .filter(|(scheme, _)| scheme.eq_ignore_ascii_case("bearer"))
        .map(|(_, token)| token.trim().to_owned());
    let cookie = |name: &str| {
        let texts = headers.get_all(header::COOKIE).iter().filter_map(|value| value.to_str().ok());
        let mut pairs = texts.flat_map(|value| value.split(';')).filter_map(|pair| pair.trim().split_once('='));
        pairs.find(|(cookie_name, _)| *cookie_name == name).map(|(_, value)| value.to_owned())
    };
    let (session, platform_secret) = (cookie(cookie_name(secure)), cookie(browser_cookie(secure)));
    Secrets { bearer, session, platform_secret, provider_secret: cookie(provider_cookie(secure)), address: None }
}

async fn read_secrets(parts: &mut Parts, app: &App) -> Secrets {
    let address_in_header = ClientIp::from_request_parts(parts, app).await.ok().map(|ClientIp(address)| address);
    // If the proxy's header is missing, the request bypassed the proxy.
    let peer = || parts.extensions.get::<ConnectInfo<SocketAddr>>().map(|ConnectInfo(peer)| peer.ip());
    let address = address_in_header.or_else(peer).map(|address| address.to_canonical());
    Secrets { address, ..secrets(&parts.headers, app.is_secure()) }
}

/// The course in a request's URL. Other parts of the URL are ignored.
#[derive(Deserialize)]
struct CourseAddress {
    course: String,
}

/// Declares the roles that handlers can take as arguments, and how each is extracted from a request's head.
macro_rules! roles {
    ($($role:ty: |$parts:ident, $app:ident| $tell:expr;)*) => {
        $(impl FromRequestParts<App> for $role {
            type Rejection = Problem;

            async fn from_request_parts($parts: &mut Parts, $app: &App) -> Result<Self, Problem> {
                $tell
            }
        })*
    };
}

roles! {
    Visitor: |parts, app| Ok(app.visitor(read_secrets(parts, app).await));
    Person: |parts, app| {
        let secrets = read_secrets(parts, app).await;
        let person = app.person(&secrets).await?;
        parts.extensions.insert(SignedIn);
        if let (true, Some(secret), Some(renewed)) =
            (person.is_renewed(), secrets.session, parts.extensions.get::<RenewedSession>())
        {
            // Another argument of the same handler may have stored the session already.
            drop(renewed.0.set(secret));
        }
        Ok(person)
    };
    Member: |parts, app| {
        let person = Person::from_request_parts(parts, app).await?;
        let address = Path::<CourseAddress>::from_request_parts(parts, app).await;
        person.into_member(&address.map(|Path(at)| at.course).unwrap_or_default()).await
    };
    Staff: |parts, app| Member::from_request_parts(parts, app).await?.into_staff();
    Admin: |parts, app| Person::from_request_parts(parts, app).await?.admin();
    RemoteWorker: |parts, app| {
        let token = read_secrets(parts, app).await.bearer.ok_or_else(Problem::not_signed_in)?;
        let name = parts.headers.get("fosssim-worker").and_then(|name| name.to_str().ok()).unwrap_or("worker");
        let worker = app.authenticate_worker(&token, name).await?;
        parts.extensions.insert(SignedIn);
        Ok(worker)
    };
}
