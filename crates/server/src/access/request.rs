//! Who asks, told from a request.
use super::{
    Admin, House, Member, Person, Remote, Staff, Visitor,
    account::Account,
    identity::{self, Seen},
};
use crate::{net::ClientAddress, problem::Problem, values};
use axum::{
    extract::{FromRequestParts, RawPathParams},
    http::{HeaderMap, header, request::Parts},
};
use std::{
    net::IpAddr,
    sync::{Arc, OnceLock},
    time::Instant,
};

/// Where a request's session is noted when it lasts longer from now on: the browser is to keep its cookie as long.
#[derive(Debug, Clone, Default)]
pub struct Renewed(Arc<OnceLock<String>>);

impl Renewed {
    /// What the cookie holds, if it is to be sent again.
    #[must_use]
    pub fn session(&self) -> Option<&str> {
        self.0.get().map(String::as_str)
    }
}

/// Where a request comes from.
fn address(parts: &Parts) -> Option<IpAddr> {
    parts.extensions.get::<ClientAddress>().map(|ClientAddress(address)| *address)
}

/// Stands in a request once it is known who asks: whoever reads its body may then read more of it.
#[derive(Clone, Copy)]
pub struct SignedIn;

/// What a request shows.
#[derive(Clone, Default)]
pub struct Secrets {
    /// From `Authorization: Bearer`.
    pub bearer: Option<String>,
    /// From the session's cookie.
    pub session: Option<String>,
    /// From the cookie of a browser that comes from a learning platform.
    pub browser: Option<String>,
}

/// The session's cookie: by HTTPS one that no other host and no script can set or read.
#[must_use]
pub fn cookie_name(secure: bool) -> &'static str {
    if secure { "__Host-fosssim" } else { "fosssim" }
}

/// The cookie of a browser while it comes from a learning platform.
#[must_use]
pub fn browser_cookie(secure: bool) -> &'static str {
    if secure { "__Host-fosssim-lti" } else { "fosssim-lti" }
}

impl Secrets {
    /// The secrets in a request's headers.
    #[must_use]
    pub fn of(headers: &HeaderMap, secure: bool) -> Self {
        let text = |name| headers.get(name).and_then(|value: &header::HeaderValue| value.to_str().ok());
        let bearer = text(header::AUTHORIZATION)
            .and_then(|value| value.split_once(' '))
            .filter(|(scheme, _)| scheme.eq_ignore_ascii_case("bearer"))
            .map(|(_, token)| token.trim().to_owned());
        let cookie = |wanted: &str| {
            headers
                .get_all(header::COOKIE)
                .iter()
                .filter_map(|value| value.to_str().ok())
                .flat_map(|value| value.split(';'))
                .filter_map(|pair| pair.trim().split_once('='))
                .find(|(name, _)| *name == wanted)
                .map(|(_, value)| value.to_owned())
        };
        Self { bearer, session: cookie(cookie_name(secure)), browser: cookie(browser_cookie(secure)) }
    }
}

impl House {
    /// Who shows these secrets.
    async fn account(&self, secrets: &Secrets) -> Result<(Account, Option<Seen>), Problem> {
        let (account, seen) = match secrets {
            Secrets { bearer: Some(token), .. } => {
                let mut transaction = self.0.database.read().await?;
                (identity::account_of_token(&mut transaction, token).await?.0, None)
            }
            Secrets { session: Some(session), .. } => {
                let mut transaction = self.0.database.read().await?;
                let found = identity::account_of_session(&mut transaction, session).await?;
                drop(transaction);
                let (account, seen) = found.ok_or_else(|| Problem::unknown_secret("session"))?;
                if seen.is_stale {
                    let mut transaction = self.0.database.begin().await?;
                    identity::session_seen(&mut transaction, session).await?;
                    transaction.commit().await?;
                }
                (account, Some(seen))
            }
            _ => return Err(Problem::not_signed_in()),
        };
        if !self.0.throttle.pass(account.id, self.0.requests_per_minute, Instant::now()) {
            let most = self.0.requests_per_minute;
            return Err(Problem::too_many(format!("an account may send {most} requests in a minute")));
        }
        Ok((account, seen))
    }
}

impl FromRequestParts<House> for Visitor {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, house: &House) -> Result<Self, Problem> {
        let secrets = Secrets::of(&parts.headers, house.is_secure());
        let address = address(parts);
        Ok(Self { house: house.clone(), session: secrets.session, browser: secrets.browser, address })
    }
}

impl FromRequestParts<House> for Person {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, house: &House) -> Result<Self, Problem> {
        let secrets = Secrets::of(&parts.headers, house.is_secure());
        let (account, session) = house.account(&secrets).await?;
        parts.extensions.insert(SignedIn);
        if let (Some(true), Some(secret), Some(renewed)) =
            (session.as_ref().map(|seen| seen.is_stale), secrets.session, parts.extensions.get::<Renewed>())
        {
            // Another part of the same request may have noted it.
            drop(renewed.0.set(secret));
        }
        Ok(Self { account, session, address: address(parts), house: house.clone() })
    }
}

impl FromRequestParts<House> for Member {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, house: &House) -> Result<Self, Problem> {
        let person = Person::from_request_parts(parts, house).await?;
        let params = RawPathParams::from_request_parts(parts, house).await;
        let slug = params
            .ok()
            .and_then(|params| params.iter().find(|(name, _)| *name == "course").map(|(_, slug)| slug.to_owned()));
        let Some(slug) = slug else { return Err(Problem::not_found("course")) };
        let mut transaction = house.0.database.read().await?;
        let row = transaction
            .row(
                "SELECT course.id, course.slug, course.title, course.archived_at, member.role FROM course
                 LEFT JOIN member ON member.course = course.id AND member.account = ?
                 WHERE course.slug = ?",
                values![person.account.id, slug],
            )
            .await?;
        let Some(row) = row else { return Err(Problem::not_found("course")) };
        let role = row.maybe_text("role")?;
        // Whoever is not of the course does not learn that it exists.
        if role.is_none() && !person.account.is_admin {
            return Err(Problem::not_found("course"));
        }
        Ok(Self {
            is_staff: person.account.is_admin || role.as_deref() == Some("staff"),
            is_archived: row.maybe_int("archived_at")?.is_some(),
            course: row.int("id")?,
            slug: row.text("slug")?,
            title: row.text("title")?,
            account: person.account,
            house: person.house,
        })
    }
}

impl FromRequestParts<House> for Staff {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, house: &House) -> Result<Self, Problem> {
        let member = Member::from_request_parts(parts, house).await?;
        if !member.is_staff {
            return Err(Problem::not_allowed("this is for the course's staff"));
        }
        Ok(Self(member))
    }
}

impl FromRequestParts<House> for Admin {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, house: &House) -> Result<Self, Problem> {
        let person = Person::from_request_parts(parts, house).await?;
        if !person.account.is_admin {
            return Err(Problem::not_allowed("this is for administrators"));
        }
        Ok(Self { account: person.account, house: person.house })
    }
}

impl FromRequestParts<House> for Remote {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, house: &House) -> Result<Self, Problem> {
        let Some(token) = Secrets::of(&parts.headers, house.is_secure()).bearer else {
            return Err(Problem::not_signed_in());
        };
        let mut transaction = house.0.database.read().await?;
        let row = transaction
            .row(
                "SELECT id, name FROM token WHERE digest = ? AND account IS NULL AND revoked_at IS NULL",
                values![identity::digest(&token)],
            )
            .await?;
        let Some(row) = row else { return Err(Problem::unknown_secret("worker token")) };
        parts.extensions.insert(SignedIn);
        let name = parts.headers.get("fosssim-worker").and_then(|name| name.to_str().ok()).unwrap_or("worker");
        Ok(Self::new(house.clone(), row.int("id")?, &row.text("name")?, name))
    }
}
