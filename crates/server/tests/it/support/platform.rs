//! A learning platform for tests: its keys, its messages, and its services, with the faults of real platforms.
use super::server::{Answer, Client, Server};
use axum::{
    Json, Router,
    extract::{Path, Query, State},
    http::{HeaderMap, StatusCode},
    response::{IntoResponse, Response},
    routing::{get, post},
};
use base64::{Engine as _, engine::general_purpose::URL_SAFE_NO_PAD};
use ring::{
    hmac,
    rand::SystemRandom,
    signature::{RSA_PKCS1_2048_8192_SHA256, RSA_PKCS1_SHA256, RsaKeyPair, RsaPublicKeyComponents},
};
use rsa::{RsaPrivateKey, pkcs1::EncodeRsaPrivateKey, rand_core::OsRng, traits::PublicKeyParts};
use serde_json::{Value, json};
use std::{
    collections::{BTreeMap, HashMap, VecDeque},
    sync::{Arc, LazyLock, Mutex, MutexGuard},
    time::{Duration, Instant, SystemTime, UNIX_EPOCH},
};

pub(crate) const CLIENT: &str = "client-1";
pub(crate) const DEPLOYMENT: &str = "deployment-1";
const SCORE: &str = "https://purl.imsglobal.org/spec/lti-ags/scope/score";
const LINE_ITEM: &str = "https://purl.imsglobal.org/spec/lti-ags/scope/lineitem";
const MEMBERS: &str = "https://purl.imsglobal.org/spec/lti-nrps/scope/contextmembership.readonly";
pub(crate) const INSTRUCTOR: &str = "http://purl.imsglobal.org/vocab/lis/v2/membership#Instructor";
pub(crate) const LEARNER: &str = "http://purl.imsglobal.org/vocab/lis/v2/membership#Learner";

/// A key that signs messages.
pub(crate) struct Key {
    pub(crate) kid: &'static str,
    pair: RsaKeyPair,
    n: Vec<u8>,
    e: Vec<u8>,
}

impl Key {
    fn make(kid: &'static str) -> Self {
        let key = RsaPrivateKey::new(&mut OsRng, 2048).expect("a key");
        let pair = RsaKeyPair::from_der(key.to_pkcs1_der().expect("DER").as_bytes()).expect("a pair");
        Self { kid, pair, n: key.n().to_bytes_be(), e: key.e().to_bytes_be() }
    }

    pub(crate) fn public(&self) -> Value {
        json!({"kty": "RSA", "use": "sig", "alg": "RS256", "kid": self.kid,
            "n": URL_SAFE_NO_PAD.encode(&self.n), "e": URL_SAFE_NO_PAD.encode(&self.e)})
    }

    /// Signs a token with the given header.
    pub(crate) fn sign_as(&self, header: &Value, claims: &Value) -> String {
        let text = unsigned(header, claims);
        let mut signed = vec![0; self.pair.public().modulus_len()];
        self.pair.sign(&RSA_PKCS1_SHA256, &SystemRandom::new(), text.as_bytes(), &mut signed).expect("signed");
        format!("{text}.{}", URL_SAFE_NO_PAD.encode(signed))
    }

    pub(crate) fn sign(&self, claims: &Value) -> String {
        self.sign_as(&json!({"alg": "RS256", "typ": "JWT", "kid": self.kid}), claims)
    }

    /// Signs a token with the public key, misused as a shared secret.
    pub(crate) fn sign_by_public(&self, claims: &Value) -> String {
        let text = unsigned(&json!({"alg": "HS256", "typ": "JWT", "kid": self.kid}), claims);
        let secret = hmac::Key::new(hmac::HMAC_SHA256, URL_SAFE_NO_PAD.encode(&self.n).as_bytes());
        format!("{text}.{}", URL_SAFE_NO_PAD.encode(hmac::sign(&secret, text.as_bytes())))
    }
}

/// Returns the header and the claims in the form that is signed.
pub(crate) fn unsigned(header: &Value, claims: &Value) -> String {
    let part = |value: &Value| URL_SAFE_NO_PAD.encode(value.to_string());
    format!("{}.{}", part(header), part(claims))
}

/// The platform's first and second key, and a foreign key with the name of the first.
pub(crate) static KEYS: LazyLock<[Key; 3]> =
    LazyLock::new(|| [Key::make("first"), Key::make("second"), Key::make("first")]);

/// The failure that a message to a service meets.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Trouble {
    Status(u16),
    /// The service asks the sender to wait for this number of seconds.
    Busy(u64),
    /// The service accepts the message, and the answer is lost.
    Lost,
    /// The service no longer knows the token.
    Forgets,
}

#[derive(Default)]
pub(crate) struct Inside {
    /// The indices of the published [`KEYS`].
    pub(crate) published: Vec<usize>,
    pub(crate) key_reads: usize,
    tokens: HashMap<String, String>,
    pub(crate) token_requests: usize,
    /// The failures that the next scores meet.
    pub(crate) troubles: VecDeque<Trouble>,
    /// All received scores, with their columns.
    pub(crate) scores: Vec<(String, Value)>,
    /// The grade book: the newest score of each column and person.
    pub(crate) grade_book: BTreeMap<(String, String), Value>,
    pub(crate) line_items: Vec<Value>,
    /// Whether the platform creates columns slowly.
    pub(crate) slow_columns: bool,
    pub(crate) members: Vec<Value>,
    tool: String,
    url: String,
}

#[derive(Clone)]
pub(crate) struct Platform {
    pub(crate) url: String,
    inside: Arc<Mutex<Inside>>,
}

impl Platform {
    /// Starts a platform, and registers it at the server as `lms`.
    pub(crate) async fn start(server: &Server, admin: &Client) -> Self {
        let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.expect("a port");
        let url = format!("http://{}", listener.local_addr().expect("an address"));
        let inside = Inside { published: vec![0], tool: server.url.clone(), url: url.clone(), ..Inside::default() };
        let platform = Self { url, inside: Arc::new(Mutex::new(inside)) };
        let router = Router::new()
            .route("/keys", get(keys))
            .route("/token", post(token))
            .route("/members", get(members))
            .route("/lineitems", get(find_line_items).post(new_line_item))
            .route("/lineitems/{id}/scores", post(score))
            .with_state(platform.clone());
        tokio::spawn(async move { axum::serve(listener, router).await });
        let wish = platform.registration().to_string();
        let json = [("Content-Type", "application/json")];
        admin.send("PUT", "/api/v1/platforms/lms", &json, wish.as_bytes()).expect(200);
        platform
    }

    pub(crate) fn registration(&self) -> Value {
        let at = |path: &str| format!("{}{path}", self.url);
        json!({"issuer": self.url, "client_id": CLIENT, "login_url": at("/auth?from=tool"), "token_url": at("/token"),
            "keys_url": at("/keys"), "deployments": [DEPLOYMENT]})
    }

    pub(crate) fn inside(&self) -> MutexGuard<'_, Inside> {
        self.inside.lock().expect("nobody panicked")
    }

    /// Returns the claims about a person who opens the link `link` in the course `physics`.
    pub(crate) fn claims(&self, nonce: &str, subject: &str, role: &str) -> Value {
        let now = now();
        json!({
            "iss": self.url, "aud": CLIENT, "sub": subject, "nonce": nonce, "iat": now, "exp": now + 300,
            "name": format!("The {subject}"), "email": format!("{subject}@example.org"),
            "https://purl.imsglobal.org/spec/lti/claim/message_type": "LtiResourceLinkRequest",
            "https://purl.imsglobal.org/spec/lti/claim/version": "1.3.0",
            "https://purl.imsglobal.org/spec/lti/claim/deployment_id": DEPLOYMENT,
            "https://purl.imsglobal.org/spec/lti/claim/target_link_uri": "https://grades.example.org/lti/launch",
            "https://purl.imsglobal.org/spec/lti/claim/roles": [role],
            "https://purl.imsglobal.org/spec/lti/claim/context":
                {"id": "c-1", "label": "Phys 1", "title": "Physics <1>"},
            "https://purl.imsglobal.org/spec/lti/claim/resource_link": {"id": "link", "title": "First milestone"},
            "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint": {
                "scope": [SCORE, LINE_ITEM], "lineitems": format!("{}/lineitems", self.url)},
            "https://purl.imsglobal.org/spec/lti-nrps/claim/namesroleservice": {
                "context_memberships_url": format!("{}/members", self.url), "service_versions": ["2.0"]},
        })
    }

    /// Waits until a person's entry in the grade book satisfies a condition.
    pub(crate) fn wait_for(&self, subject: &str, what: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        loop {
            let found =
                self.inside().grade_book.iter().find(|((_, who), _)| who == subject).map(|(_, score)| score.clone());
            if let Some(found) = &found
                && what(found)
            {
                return found.clone();
            }
            assert!(start.elapsed() < Duration::from_secs(120), "{subject}: {found:?}, {:?}", self.inside().scores);
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

pub(crate) fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).expect("a clock").as_secs()
}

async fn keys(State(platform): State<Platform>) -> Json<Value> {
    let mut inside = platform.inside();
    inside.key_reads += 1;
    let keys: Vec<Value> = inside.published.iter().map(|key| KEYS[*key].public()).collect();
    Json(json!({"keys": keys}))
}

/// Returns a token to a sender with an assertion that the tool signed for this address.
async fn token(State(platform): State<Platform>, body: String) -> Response {
    let fields: HashMap<String, String> = url::form_urlencoded::parse(body.as_bytes()).into_owned().collect();
    let tool = platform.inside().tool.clone();
    let url = platform.url.clone();
    let published = tokio::task::spawn_blocking(move || {
        Client { url: tool, headers: Vec::new() }.get("/lti/keys.json").expect(200).json()
    });
    let published = published.await.expect("the tool's keys");
    let claims = checked(&fields["client_assertion"], &published);
    let told = |name: &str| claims[name].as_str().unwrap_or_default().to_owned();
    assert_eq!([told("iss"), told("sub"), told("aud")], [CLIENT.to_owned(), CLIENT.to_owned(), format!("{url}/token")]);
    assert!(claims["exp"].as_u64() > Some(now()) && claims["jti"].is_string());
    assert_eq!(fields["grant_type"], "client_credentials");
    let mut inside = platform.inside();
    inside.token_requests += 1;
    let token = format!("token-{}", inside.token_requests);
    inside.tokens.insert(token.clone(), fields["scope"].clone());
    Json(json!({"access_token": token, "token_type": "Bearer", "expires_in": 3600, "scope": fields["scope"]}))
        .into_response()
}

/// Returns the claims of a token that one of the published keys signed.
pub(crate) fn checked(token: &str, published: &Value) -> Value {
    let decode = |part: &str| URL_SAFE_NO_PAD.decode(part).expect("base64");
    let (text, signed) = token.rsplit_once('.').expect("a signature");
    let (header, claims) = text.split_once('.').expect("claims");
    let header: Value = serde_json::from_slice(&decode(header)).expect("a header");
    assert_eq!(header["alg"], "RS256");
    let key =
        published["keys"].as_array().expect("keys").iter().find(|key| key["kid"] == header["kid"]).expect("a key");
    let part = |name: &str| decode(key[name].as_str().expect("a part"));
    RsaPublicKeyComponents { n: part("n"), e: part("e") }
        .verify(&RSA_PKCS1_2048_8192_SHA256, text.as_bytes(), &decode(signed))
        .expect("the tool's signature");
    serde_json::from_slice(&decode(claims)).expect("claims")
}

fn may(inside: &Inside, headers: &HeaderMap, scope: &str) -> bool {
    let shown = headers.get("authorization").and_then(|value| value.to_str().ok()).unwrap_or_default();
    shown.strip_prefix("Bearer ").and_then(|token| inside.tokens.get(token)).is_some_and(|known| known == scope)
}

/// Lists the members, two on each page.
async fn members(
    State(platform): State<Platform>,
    headers: HeaderMap,
    Query(asked): Query<HashMap<String, usize>>,
) -> Response {
    let inside = platform.inside();
    if !may(&inside, &headers, MEMBERS) {
        return StatusCode::UNAUTHORIZED.into_response();
    }
    let page = asked.get("page").copied().unwrap_or(0);
    let shown: Vec<&Value> = inside.members.iter().skip(2 * page).take(2).collect();
    let body = json!({"id": "x", "context": {"id": "c-1"}, "members": shown}).to_string();
    let mut response = body.into_response();
    if 2 * (page + 1) < inside.members.len() {
        let link = format!(
            "<{0}/members?page=0>; rel=\"first\", <{0}/members?page={1}>; rel=\"next\"",
            platform.url,
            page + 1
        );
        response.headers_mut().insert("link", link.parse().expect("a header"));
    }
    response
}

async fn find_line_items(
    State(platform): State<Platform>,
    headers: HeaderMap,
    Query(asked): Query<HashMap<String, String>>,
) -> Response {
    let inside = platform.inside();
    if !may(&inside, &headers, LINE_ITEM) {
        return StatusCode::FORBIDDEN.into_response();
    }
    let found: Vec<&Value> =
        inside.line_items.iter().filter(|item| item["resourceLinkId"] == asked["resource_link_id"].as_str()).collect();
    Json(json!(found)).into_response()
}

async fn new_line_item(State(platform): State<Platform>, headers: HeaderMap, body: String) -> Response {
    if platform.inside().slow_columns {
        tokio::time::sleep(Duration::from_millis(500)).await;
    }
    let mut inside = platform.inside();
    if !may(&inside, &headers, LINE_ITEM) {
        return StatusCode::FORBIDDEN.into_response();
    }
    let mut item: Value = serde_json::from_str(&body).expect("JSON");
    assert!(item["scoreMaximum"].as_f64() > Some(0.0) && item["label"].is_string(), "{item}");
    item["id"] = json!(format!("{}/lineitems/{}", inside.url, inside.line_items.len() + 1));
    inside.line_items.push(item.clone());
    (StatusCode::CREATED, Json(item)).into_response()
}

async fn score(State(platform): State<Platform>, Path(id): Path<String>, headers: HeaderMap, body: String) -> Response {
    let mut inside = platform.inside();
    if !may(&inside, &headers, SCORE) {
        return StatusCode::UNAUTHORIZED.into_response();
    }
    let trouble = inside.troubles.pop_front();
    match trouble {
        Some(Trouble::Status(status)) => {
            return (StatusCode::from_u16(status).expect("a status"), "not\u{1b}[31m now").into_response();
        }
        Some(Trouble::Busy(seconds)) => {
            return (StatusCode::TOO_MANY_REQUESTS, [("retry-after", seconds.to_string())]).into_response();
        }
        Some(Trouble::Forgets) => {
            inside.tokens.clear();
            return StatusCode::UNAUTHORIZED.into_response();
        }
        Some(Trouble::Lost) | None => {}
    }
    assert_eq!(headers["content-type"], "application/vnd.ims.lis.v1.score+json");
    let score: Value = serde_json::from_str(&body).expect("JSON");
    let who = score["userId"].as_str().expect("somebody").to_owned();
    inside.scores.push((id.clone(), score.clone()));
    // As the specification requires, only newer scores are stored.
    let newer = inside.grade_book.get(&(id.clone(), who.clone())).is_none_or(|known| {
        known["timestamp"].as_str().expect("a time") < score["timestamp"].as_str().expect("a time")
    });
    if newer {
        inside.grade_book.insert((id, who), score);
    }
    if matches!(trouble, Some(Trouble::Lost)) {
        return StatusCode::BAD_GATEWAY.into_response();
    }
    StatusCode::NO_CONTENT.into_response()
}

/// A sign-in that a browser has begun.
pub(crate) struct Begun {
    pub(crate) state: String,
    pub(crate) nonce: String,
    pub(crate) cookie: String,
}

/// Begins a sign-in, as a browser does that comes from the platform.
pub(crate) fn begin(server: &Server, platform: &Platform) -> Begun {
    let query = url::form_urlencoded::Serializer::new(String::new())
        .append_pair("iss", &platform.url)
        .append_pair("login_hint", "hint &1")
        .append_pair("lti_message_hint", "message")
        .append_pair("target_link_uri", "https://grades.example.org/lti/launch")
        .append_pair("client_id", CLIENT)
        .finish();
    let answer = server.visitor().get(&format!("/lti/login?{query}")).expect(303);
    let to = url::Url::parse(answer.header("location").expect("an address")).expect("an address");
    assert!(to.as_str().starts_with(&format!("{}/auth?from=tool&", platform.url)), "{to}");
    let asked: HashMap<String, String> = to.query_pairs().into_owned().collect();
    for (name, value) in [
        ("scope", "openid"),
        ("response_type", "id_token"),
        ("response_mode", "form_post"),
        ("prompt", "none"),
        ("client_id", CLIENT),
        ("redirect_uri", "https://grades.example.org/lti/launch"),
        ("login_hint", "hint &1"),
        ("lti_message_hint", "message"),
    ] {
        assert_eq!(asked[name], value, "{to}");
    }
    let cookie = answer.header("set-cookie").expect("a cookie").to_owned();
    Begun { state: asked["state"].clone(), nonce: asked["nonce"].clone(), cookie }
}

/// Returns from the platform with a token.
pub(crate) fn come(server: &Server, begun: &Begun, token: &str) -> Answer {
    let body = url::form_urlencoded::Serializer::new(String::new())
        .append_pair("state", &begun.state)
        .append_pair("id_token", token)
        .finish();
    let cookie = begun.cookie.split(';').next().expect("a value");
    let headers = [
        ("Content-Type", "application/x-www-form-urlencoded"),
        ("Sec-Fetch-Site", "cross-site"),
        ("Origin", "https://lms.example.org"),
        ("Cookie", cookie),
    ];
    server.visitor().send("POST", "/lti/launch", &headers, body.as_bytes())
}

/// Arrives from the platform as a person, with changed claims. Returns the person's client and the address of the page.
pub(crate) fn arrive(
    server: &Server,
    platform: &Platform,
    (subject, role): (&str, &str),
    change: impl FnOnce(&mut Value),
) -> (Client, String) {
    let begun = begin(server, platform);
    let mut claims = platform.claims(&begun.nonce, subject, role);
    change(&mut claims);
    let key = *platform.inside().published.last().expect("a key");
    let answer = come(server, &begun, &KEYS[key].sign(&claims)).expect(303);
    let cookie = answer.header("set-cookie").expect("a session").split(';').next().expect("a value").to_owned();
    let headers = vec![("Cookie".to_owned(), cookie), ("Sec-Fetch-Site".to_owned(), "same-origin".to_owned())];
    (Client { url: server.url.clone(), headers }, answer.header("location").expect("a place").to_owned())
}
