//! An OpenID Connect provider, by which the people of an organization sign in: it uses the authorization code flow with
//! PKCE. The crate `openidconnect` writes the requests and checks the answers. This module sends them, caches the
//! provider's configuration, and returns what the provider reports about a person. `domain` finds the person's account.
use crate::{net, problem::ensure};
use anyhow::{Context as _, anyhow};
use openidconnect::{
    AccessToken, AuthType, AuthorizationCode, ClaimsVerificationError, ClientId, ClientSecret, CsrfToken,
    EmptyAdditionalClaims, EndpointMaybeSet, EndpointNotSet, EndpointSet, HttpRequest, HttpResponse, IssuerUrl, Nonce,
    OAuth2TokenResponse as _, PkceCodeChallenge, PkceCodeVerifier, RedirectUrl, RequestTokenError, Scope,
    SignatureVerificationError, SubjectIdentifier, TokenResponse as _, UserInfoClaims,
    core::{
        CoreAuthenticationFlow, CoreClient, CoreClientAuthMethod, CoreGenderClaim, CoreIdToken, CoreIdTokenClaims,
        CoreJwsSigningAlgorithm, CoreProviderMetadata,
    },
};
use std::time::{Duration, Instant};
use thiserror::Error;
use tokio::sync::Mutex;
use ureq::Agent;
use url::Url;

/// The time for which the provider's configuration is used before it is read again.
const CONFIGURATION_LIFETIME: Duration = Duration::from_secs(3600);

/// The minimum time between two requests for the configuration, after an unknown key or a failure.
const MIN_PAUSE: Duration = Duration::from_secs(1);

/// The maximum time to wait for the provider's answer.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(10);

/// The maximum size of an answer, in bytes.
const MAX_ANSWER_BYTES: u64 = 1 << 20;

/// The accepted algorithms for signatures of tokens. With these, only the provider has the private key.
const ALGORITHMS: [CoreJwsSigningAlgorithm; 9] = [
    CoreJwsSigningAlgorithm::RsaSsaPkcs1V15Sha256,
    CoreJwsSigningAlgorithm::RsaSsaPkcs1V15Sha384,
    CoreJwsSigningAlgorithm::RsaSsaPkcs1V15Sha512,
    CoreJwsSigningAlgorithm::RsaSsaPssSha256,
    CoreJwsSigningAlgorithm::RsaSsaPssSha384,
    CoreJwsSigningAlgorithm::RsaSsaPssSha512,
    CoreJwsSigningAlgorithm::EcdsaP256Sha256,
    CoreJwsSigningAlgorithm::EcdsaP384Sha384,
    CoreJwsSigningAlgorithm::EdDsa,
];

/// The client's type, after the provider's URLs are known.
type Client =
    CoreClient<EndpointSet, EndpointNotSet, EndpointNotSet, EndpointNotSet, EndpointMaybeSet, EndpointMaybeSet>;

/// The reason why a sign-in failed.
#[derive(Debug, Clone, Error)]
pub enum ProviderFault {
    /// The provider does not answer; a later request may succeed.
    #[error("{0}")]
    Unavailable(String),
    /// The provider rejects the sign-in, or its answer is not trusted.
    #[error("{0}")]
    Rejected(String),
}

/// A person, as the provider describes them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ProviderPerson {
    /// The provider's identifier of the person, which never changes.
    pub subject: String,
    /// The person's full name; `None` if the provider does not report it.
    pub name: Option<String>,
    /// The person's short name at the provider, from which a new account's login is made.
    pub nickname: Option<String>,
    /// The part of the person's e-mail address before the @. The provider has confirmed the address, and it is in the
    /// allowed domain.
    pub mailbox: Option<String>,
}

/// The secrets of one sign-in.
#[derive(Debug, Clone)]
pub struct SignInSecrets {
    /// The state, which the provider returns unchanged.
    pub state: String,
    /// The nonce, which the provider's token must contain.
    pub nonce: String,
    /// The secret by which this service proves that it requested the code. It has at least 43 characters.
    pub verifier: String,
}

/// The facts that a provider reports about a person and that this service uses.
struct PersonClaims {
    name: Option<String>,
    nickname: Option<String>,
    email: Option<String>,
    is_confirmed: bool,
}

/// Reads the claims from a token, or from the answer to a further request. The types of both have the same methods, but
/// no common trait.
macro_rules! read_claims {
    ($claims:ident) => {
        PersonClaims {
            name: $claims.name().and_then(|name| name.get(None)).map(|name| name.to_string()),
            nickname: $claims.preferred_username().map(|name| name.to_string()),
            email: $claims.email().map(|email| email.to_string()),
            is_confirmed: $claims.email_verified() == Some(true),
        }
    };
}

/// The provider's configuration, and the time when it was read.
#[derive(Debug)]
struct KnownConfiguration {
    requested_at: Instant,
    metadata: Result<CoreProviderMetadata, ProviderFault>,
}

/// A provider at which people sign in, and this service's registration there.
#[derive(Debug)]
pub struct Provider {
    issuer: IssuerUrl,
    client: ClientId,
    secret: ClientSecret,
    /// The provider's name as pages show it.
    pub label: String,
    domain: Option<String>,
    agent: Agent,
    published: Mutex<Option<KnownConfiguration>>,
}

impl Provider {
    /// Creates a provider. If a domain is given, only people with a confirmed e-mail address in that domain may sign
    /// in.
    ///
    /// # Errors
    ///
    /// Fails if the issuer is not an HTTPS URL. For tests, HTTP is accepted if the provider is on this machine.
    pub fn new(
        issuer: String,
        client: String,
        secret: String,
        label: Option<String>,
        domain: Option<String>,
    ) -> anyhow::Result<Self> {
        let address = Url::parse(&issuer).with_context(|| format!("{issuer} is not a URL"))?;
        let host = address.host_str().unwrap_or_default();
        let allows_http = address.scheme() == "http" && matches!(host, "127.0.0.1" | "[::1]" | "localhost");
        ensure(allows_http || address.scheme() == "https", anyhow!("the issuer must be https://..., not {issuer}"))?;
        Ok(Self {
            label: label.unwrap_or_else(|| host.to_owned()),
            issuer: IssuerUrl::new(issuer)?,
            client: ClientId::new(client),
            secret: ClientSecret::new(secret),
            domain: domain.map(|domain| domain.to_ascii_lowercase()),
            agent: net::new_agent(allows_http, ANSWER_TIMEOUT),
            published: Mutex::default(),
        })
    }

    /// Returns the provider's issuer. Together with a subject, it identifies a person.
    pub fn issuer(&self) -> &str {
        &self.issuer
    }

    /// Returns the provider's configuration, which was read at most `age` ago.
    async fn request_metadata(&self, age: Duration) -> Result<CoreProviderMetadata, ProviderFault> {
        let mut published = self.published.lock().await;
        if let Some(KnownConfiguration { requested_at, metadata }) = &*published
            && requested_at.elapsed() < if metadata.is_ok() { age } else { MIN_PAUSE }
        {
            return metadata.clone();
        }
        let http = |request| send(self.agent.clone(), request);
        let configuration = CoreProviderMetadata::discover_async(self.issuer.clone(), &http).await;
        let metadata = configuration.map_err(|error| {
            let error = format!("{:#}", anyhow!(error));
            tracing::warn!(issuer = %*self.issuer, error, "the provider's configuration can't be read");
            ProviderFault::Unavailable(format!("{} does not answer correctly", self.label))
        });
        *published = Some(KnownConfiguration { requested_at: Instant::now(), metadata: metadata.clone() });
        metadata
    }

    /// Returns a client with a configuration that was read at most `age` ago. The provider sends people back to the
    /// URL `redirect`.
    async fn create_client(&self, age: Duration, redirect: &str) -> Result<Client, ProviderFault> {
        let metadata = self.request_metadata(age).await?;
        let methods = metadata.token_endpoint_auth_methods_supported().cloned().unwrap_or_default();
        let uses_header = methods.is_empty() || methods.contains(&CoreClientAuthMethod::ClientSecretBasic);
        let redirect = RedirectUrl::new(redirect.to_owned()).map_err(untrusted_answer)?;
        Ok(CoreClient::from_provider_metadata(metadata, self.client.clone(), Some(self.secret.clone()))
            .set_redirect_uri(redirect)
            .set_auth_type(if uses_header { AuthType::BasicAuth } else { AuthType::RequestBody }))
    }

    /// Returns the provider's URL at which a person signs in.
    ///
    /// # Errors
    ///
    /// Fails if the provider does not answer.
    pub async fn sign_in_url(&self, redirect: &str, secrets: SignInSecrets) -> Result<Url, ProviderFault> {
        let client = self.create_client(CONFIGURATION_LIFETIME, redirect).await?;
        let SignInSecrets { state, nonce, verifier } = secrets;
        let challenge = PkceCodeChallenge::from_code_verifier_sha256(&PkceCodeVerifier::new(verifier));
        let flow = CoreAuthenticationFlow::AuthorizationCode;
        let (address, ..) = client
            .authorize_url(flow, || CsrfToken::new(state), || Nonce::new(nonce))
            .add_scopes(["profile", "email"].map(|scope| Scope::new(scope.to_owned())))
            .set_pkce_challenge(challenge)
            .url();
        Ok(address)
    }

    /// Returns the person for whom the provider issued a code.
    ///
    /// # Errors
    ///
    /// Fails if the provider does not answer or rejects the code, or its answer is not trusted.
    pub async fn person(
        &self,
        redirect: &str,
        code: String,
        secrets: SignInSecrets,
    ) -> Result<ProviderPerson, ProviderFault> {
        let client = self.create_client(CONFIGURATION_LIFETIME, redirect).await?;
        let http = |request| send(self.agent.clone(), request);
        let request = client.exchange_code(AuthorizationCode::new(code)).map_err(untrusted_answer)?;
        let answer = request.set_pkce_verifier(PkceCodeVerifier::new(secrets.verifier)).request_async(&http).await;
        let answer = answer.map_err(|error| match error {
            RequestTokenError::Request(_) => ProviderFault::Unavailable(format!("{} does not answer", self.label)),
            error => untrusted_answer(error),
        })?;
        let token = answer.id_token().ok_or_else(|| untrusted_answer(anyhow!("the provider returned no ID token")))?;
        let nonce = Nonce::new(secrets.nonce);
        let claims = match verify_token(&client, token, &nonce) {
            // The provider may have changed its keys, so its configuration is read again.
            Err(ClaimsVerificationError::SignatureVerification(SignatureVerificationError::NoMatchingKey)) => {
                verify_token(&self.create_client(MIN_PAUSE, redirect).await?, token, &nonce)
            }
            claims => claims,
        };
        let claims = claims.map_err(untrusted_answer)?;
        let claims_in_token = read_claims!(claims);
        // Some providers put the mail address into the token. Others return it only for a further request.
        let further = match claims_in_token.email {
            Some(_) => None,
            None => self.fetch_claims(&client, answer.access_token().clone(), claims.subject().clone()).await?,
        };
        self.read(claims.subject().to_string(), further.unwrap_or(claims_in_token))
    }

    /// Returns further claims about a person; `None` if the provider does not offer them.
    async fn fetch_claims(
        &self,
        client: &Client,
        token: AccessToken,
        subject: SubjectIdentifier,
    ) -> Result<Option<PersonClaims>, ProviderFault> {
        let Ok(request) = client.user_info(token, Some(subject)) else { return Ok(None) };
        let http = |request| send(self.agent.clone(), request);
        let claims: UserInfoClaims<EmptyAdditionalClaims, CoreGenderClaim> =
            request.request_async(&http).await.map_err(untrusted_answer)?;
        Ok(Some(read_claims!(claims)))
    }

    fn read(&self, subject: String, claims: PersonClaims) -> Result<ProviderPerson, ProviderFault> {
        ensure((1..=255).contains(&subject.len()), untrusted_answer(anyhow!("sub must have 1 to 255 characters")))?;
        let email = claims.email.map(|email| email.to_ascii_lowercase());
        let parts = email.as_deref().and_then(|email| email.rsplit_once('@'));
        let mailbox = parts.filter(|(_, domain)| claims.is_confirmed && self.domain.as_deref() == Some(domain));
        let mailbox = mailbox.map(|(mailbox, _)| mailbox.to_owned());
        if let (Some(domain), None) = (&self.domain, &mailbox) {
            let detail = format!("only people whose address in {domain} is confirmed by {} may sign in", self.label);
            return Err(ProviderFault::Rejected(detail));
        }
        let PersonClaims { name, nickname, .. } = claims;
        Ok(ProviderPerson { subject, name, nickname: mailbox.clone().or(nickname).or(email), mailbox })
    }
}

/// Checks a token: the provider must have signed it for this client and this sign-in, and it must not have expired.
fn verify_token<'a>(
    client: &Client,
    token: &'a CoreIdToken,
    nonce: &Nonce,
) -> Result<&'a CoreIdTokenClaims, ClaimsVerificationError> {
    token.claims(&client.id_token_verifier().set_allowed_algs(ALGORITHMS), nonce)
}

/// Returns the error for an answer that is not trusted. It lists all causes.
fn untrusted_answer(error: impl Into<anyhow::Error>) -> ProviderFault {
    let message: String = format!("{:#}", error.into()).chars().filter(|c| !c.is_control()).take(300).collect();
    ProviderFault::Rejected(format!("the provider's answer is not accepted: {message}"))
}

/// Sends a request in a thread that may block.
async fn send(agent: Agent, request: HttpRequest) -> Result<HttpResponse, std::io::Error> {
    let response = tokio::task::spawn_blocking(move || {
        let (head, mut body) = agent.run(request).map_err(std::io::Error::other)?.into_parts();
        let body = body.with_config().limit(MAX_ANSWER_BYTES).read_to_vec().map_err(std::io::Error::other)?;
        Ok(HttpResponse::from_parts(head, body))
    });
    response.await?
}
