//! Requests to the services of learning platforms, and for the tokens that these services require. The size of answers
//! and the time to wait for them are limited, and redirections are not followed.
use super::{Platform, keys};
use crate::{
    db::{Database, DbError},
    net, secret,
};
use serde::{Deserialize, de::DeserializeOwned};
use serde_json::json;
use std::{
    collections::HashMap,
    fmt,
    sync::{Mutex, PoisonError},
    time::{Duration, Instant, SystemTime, UNIX_EPOCH},
};
use thiserror::Error;
use ureq::{Agent, http::Request};
use url::Url;

/// The scopes that tokens can have (AGS 3.1, NRPS 2.1).
pub(crate) mod scope {
    pub(crate) const SCORE_SCOPE: &str = "https://purl.imsglobal.org/spec/lti-ags/scope/score";
    pub(crate) const LINE_ITEM: &str = "https://purl.imsglobal.org/spec/lti-ags/scope/lineitem";
    pub(crate) const MEMBERS_SCOPE: &str = "https://purl.imsglobal.org/spec/lti-nrps/scope/contextmembership.readonly";
}

/// The maximum time to wait for a platform's answer.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(20);

/// The maximum size of an answer, in bytes.
const MAX_ANSWER_BYTES: u64 = 8 << 20;

/// The lifetime of the assertions with which this service requests tokens, in seconds.
const ASSERTION_LIFETIME: u64 = 300;

/// The time before a token's expiry at which it is renewed.
const RENEWAL_MARGIN: Duration = Duration::from_secs(30);

/// The maximum pause between requests that a platform can impose.
const MAX_WAIT: Duration = Duration::from_secs(3600);

/// The reason why a request to a platform failed.
#[derive(Debug, Clone, Error)]
pub enum ServiceFault {
    /// The platform does not answer, or is overloaded; a later request may succeed.
    #[error("the platform does not answer correctly: {reason}")]
    Unavailable {
        /// The platform's message, or a description of the error.
        reason: String,
        /// The pause that the platform requests; `None` if it requests no particular pause.
        retry_after: Option<Duration>,
    },
    /// The platform rejects the request, for the given reason.
    #[error("the platform rejects the request: {0}")]
    Rejected(String),
}

impl ServiceFault {
    pub(super) fn from_outage(reason: impl fmt::Display) -> Self {
        Self::Unavailable { reason: reason.to_string(), retry_after: None }
    }
}

impl From<DbError> for ServiceFault {
    fn from(error: DbError) -> Self {
        Self::from_outage(error)
    }
}

/// The answer to a request, or the reason why it failed.
type ServiceResult = Result<ServiceAnswer, ServiceFault>;

/// A platform's answer to a request.
#[derive(Debug)]
pub(super) struct ServiceAnswer {
    pub(super) status: u16,
    body: Vec<u8>,
    /// The value of the header `Link`, which leads to further pages.
    pub(super) link: Option<String>,
    retry_after: Option<Duration>,
}

impl ServiceAnswer {
    /// Parses the answer's content. `what` names the content in error messages.
    pub(super) fn read<T: DeserializeOwned>(&self, what: &str) -> Result<T, ServiceFault> {
        let read = serde_json::from_slice(&self.body);
        read.map_err(|error| ServiceFault::Rejected(format!("{what} can't be read: {error}")))
    }

    /// Returns the answer if it reports success.
    pub(super) fn ensure_success(self) -> Result<Self, ServiceFault> {
        // The message contains the beginning of the platform's text, on one line.
        let excerpt: String = String::from_utf8_lossy(&self.body).chars().take(200).collect();
        let excerpt: String = excerpt.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        let text = format!("{} {excerpt}", self.status);
        match self.status {
            200..=299 => Ok(self),
            // Redirections are not followed: only the URL that an administrator registered is called.
            300..=399 => Err(ServiceFault::Rejected(format!("{} redirects elsewhere", self.status))),
            408 | 425 | 429 | 500.. => Err(ServiceFault::Unavailable { reason: text, retry_after: self.retry_after }),
            _ => Err(ServiceFault::Rejected(text)),
        }
    }
}

/// A request to a platform's service.
#[derive(Debug, Clone)]
pub(super) struct ServiceRequest {
    pub(super) url: String,
    pub(super) accept: &'static str,
    /// The media type and the content of a POST request; `None` for a GET request.
    pub(super) body: Option<(&'static str, Vec<u8>)>,
}

/// The tokens and their expiry times, by platform and scope.
type Tokens = HashMap<(i64, String), (String, Instant)>;

/// The client for requests to platforms.
pub struct Client {
    agent: Agent,
    pub(super) allows_http: bool,
    tokens: Mutex<Tokens>,
}

impl fmt::Debug for Client {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Client(...)")
    }
}

#[derive(Deserialize)]
struct Token {
    access_token: String,
    #[serde(default)]
    expires_in: Option<u64>,
}

impl Client {
    pub(super) fn new(allows_http: bool) -> Self {
        Self { agent: net::new_agent(allows_http, ANSWER_TIMEOUT), allows_http, tokens: Mutex::default() }
    }

    /// Downloads a public file of a platform.
    pub(super) async fn get(&self, platform: &Platform, url: &str) -> Result<ServiceAnswer, ServiceFault> {
        let request = ServiceRequest { url: url.to_owned(), accept: "application/json", body: None };
        self.send(platform, &request, None).await?.ensure_success()
    }

    async fn send(&self, platform: &Platform, request: &ServiceRequest, token: Option<&str>) -> ServiceResult {
        let Some(url) = platform.parse_registered_url(&request.url, self.allows_http) else {
            let host = Url::parse(&request.url).ok().and_then(|url| url.host_str().map(str::to_owned));
            let host = host.unwrap_or_else(|| "another host".to_owned());
            return Err(ServiceFault::Rejected(format!(
                "the service is on {host}, which is not one of the platform's hosts; an administrator can add it"
            )));
        };
        let (agent, request) = (self.agent.clone(), request.clone());
        let authorization = token.map(|token| format!("Bearer {token}"));
        let answer =
            tokio::task::spawn_blocking(move || send_blocking(&agent, &url, &request, authorization.as_deref())).await;
        answer.map_err(ServiceFault::from_outage)?
    }

    /// Calls a service with a token for a scope. If the platform rejects the token, the call is repeated with a new
    /// one.
    pub(super) async fn call(
        &self,
        database: &Database,
        platform: &Platform,
        scope: &str,
        request: &ServiceRequest,
    ) -> Result<ServiceAnswer, ServiceFault> {
        let token = self.fetch_token(database, platform, scope).await?;
        let answer = self.send(platform, request, Some(&token)).await?;
        if answer.status != 401 {
            return answer.ensure_success();
        }
        self.tokens.lock().unwrap_or_else(PoisonError::into_inner).remove(&(platform.id, scope.to_owned()));
        let token = self.fetch_token(database, platform, scope).await?;
        self.send(platform, request, Some(&token)).await?.ensure_success()
    }

    /// Returns a token for a scope, from the cache if it is still valid. To get a new one, this service sends an
    /// assertion that it signed (SEC 4.1, RFC 7523).
    async fn fetch_token(&self, database: &Database, platform: &Platform, scope: &str) -> Result<String, ServiceFault> {
        let key = (platform.id, scope.to_owned());
        if let Some((token, ends)) = self.tokens.lock().unwrap_or_else(PoisonError::into_inner).get(&key)
            && *ends > Instant::now()
        {
            return Ok(token.clone());
        }
        let settings = &platform.settings;
        let now = now_seconds();
        let assertion = keys::signing_key(database).await?.sign(&json!({
            "iss": settings.client_id,
            "sub": settings.client_id,
            "aud": settings.audience.as_ref().unwrap_or(&settings.token_url),
            "iat": now,
            "exp": now + ASSERTION_LIFETIME,
            "jti": secret::random_hex(),
        }))?;
        let body = url::form_urlencoded::Serializer::new(String::new())
            .append_pair("grant_type", "client_credentials")
            .append_pair("client_assertion_type", "urn:ietf:params:oauth:client-assertion-type:jwt-bearer")
            .append_pair("client_assertion", &assertion)
            .append_pair("scope", scope)
            .finish();
        let request = ServiceRequest {
            url: settings.token_url.clone(),
            accept: "application/json",
            body: Some(("application/x-www-form-urlencoded", body.into_bytes())),
        };
        let answer = self.send(platform, &request, None).await?.ensure_success()?;
        let token: Token = answer.read("the platform's token")?;
        if token.access_token.is_empty() || token.access_token.bytes().any(|c| !c.is_ascii_graphic()) {
            return Err(ServiceFault::Rejected("the platform's token is invalid".to_owned()));
        }
        let lifetime = Duration::from_secs(token.expires_in.unwrap_or(0).min(24 * 3600)).saturating_sub(RENEWAL_MARGIN);
        let cached = (token.access_token.clone(), Instant::now() + lifetime);
        self.tokens.lock().unwrap_or_else(PoisonError::into_inner).insert(key, cached);
        Ok(token.access_token)
    }
}

/// Returns the present time in seconds since 1970.
pub(super) fn now_seconds() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |now| now.as_secs())
}

fn send_blocking(
    agent: &Agent,
    url: &Url,
    service_request: &ServiceRequest,
    authorization: Option<&str>,
) -> Result<ServiceAnswer, ServiceFault> {
    let mut request = Request::builder().uri(url.as_str()).header("Accept", service_request.accept);
    if let Some(authorization) = authorization {
        request = request.header("Authorization", authorization);
    }
    let answer = match &service_request.body {
        None => agent.run(request.body(()).map_err(ServiceFault::from_outage)?),
        Some((kind, body)) => {
            let request = request.method("POST").header("Content-Type", *kind).body(body);
            agent.run(request.map_err(ServiceFault::from_outage)?)
        }
    };
    let mut answer = answer.map_err(ServiceFault::from_outage)?;
    let header = |name: &str| answer.headers().get(name).and_then(|value| value.to_str().ok()).map(str::to_owned);
    let link = header("link");
    // Only a value in seconds is used. If the header contains a date, the queue's own delay applies.
    let retry_after = header("retry-after").and_then(|text| text.trim().parse().ok()).map(Duration::from_secs);
    let status = answer.status().as_u16();
    let body =
        answer.body_mut().with_config().limit(MAX_ANSWER_BYTES).read_to_vec().map_err(ServiceFault::from_outage)?;
    Ok(ServiceAnswer { status, body, link, retry_after: retry_after.map(|wait| wait.min(MAX_WAIT)) })
}
