//! An OpenID Connect provider for tests: its configuration, and a token for each code.
use super::{
    platform::{KEYS, now},
    server::{Answer, Client, Server},
};
use axum::{
    Json, Router,
    extract::State,
    http::{HeaderMap, StatusCode},
    response::{IntoResponse, Response},
    routing::get,
};
use base64::{
    Engine as _,
    engine::general_purpose::{STANDARD, URL_SAFE_NO_PAD},
};
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};
use std::{
    collections::HashMap,
    sync::{Arc, Mutex, MutexGuard},
};

pub(crate) const SECRET: &str = "the-client's-secret";
const ANSWER: &str = "https://grades.example.org/sign-in/provider/answer";

#[derive(Default)]
pub(crate) struct Inside {
    url: String,
    /// The index of the published one of [`KEYS`].
    pub(crate) published: usize,
    /// For each code, the challenge of the sign-in and the token. Each is returned once.
    codes: HashMap<String, (String, String)>,
    count: usize,
    /// The claims that the provider returns for the access token.
    pub(crate) more: Value,
    pub(crate) is_away: bool,
}

#[derive(Clone)]
pub(crate) struct Provider {
    pub(crate) url: String,
    inside: Arc<Mutex<Inside>>,
}

/// A sign-in that a browser has begun.
pub(crate) struct Begun {
    pub(crate) asked: HashMap<String, String>,
    pub(crate) cookie: String,
}

impl Provider {
    pub(crate) async fn start() -> Self {
        let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.expect("a port");
        let url = format!("http://{}", listener.local_addr().expect("an address"));
        let provider = Self { url: url.clone(), inside: Arc::new(Mutex::new(Inside { url, ..Inside::default() })) };
        let router = Router::new()
            .route("/.well-known/openid-configuration", get(configuration))
            .route("/keys", get(keys))
            .route("/token", axum::routing::post(token))
            .route("/more", get(more))
            .with_state(provider.clone());
        tokio::spawn(async move { axum::serve(listener, router).await });
        provider
    }

    pub(crate) fn inside(&self) -> MutexGuard<'_, Inside> {
        self.inside.lock().expect("nobody panicked")
    }

    /// Returns the claims about a person, as an answer to a sign-in.
    pub(crate) fn claims(&self, begun: &Begun, subject: &str) -> Value {
        json!({"iss": self.url, "aud": "grades", "sub": subject, "nonce": begun.asked["nonce"], "iat": now(),
            "exp": now() + 300, "name": format!("The {subject}"), "email": format!("{subject}@uni.example"),
            "email_verified": true})
    }

    /// Returns a code for which the provider returns this token.
    pub(crate) fn code(&self, begun: &Begun, token: &str) -> String {
        let mut inside = self.inside();
        inside.count += 1;
        let code = format!("code-{}", inside.count);
        inside.codes.insert(code.clone(), (begun.asked["code_challenge"].clone(), token.to_owned()));
        code
    }
}

/// Begins a sign-in at a path of the server, as a browser does.
pub(crate) fn begin(client: &Client, path: &str) -> Begun {
    let answer = client.send("GET", path, &[("Sec-Fetch-Site", "same-origin")], b"").expect(303);
    let to = url::Url::parse(answer.header("location").expect("an address")).expect("an address");
    let asked: HashMap<String, String> = to.query_pairs().into_owned().collect();
    assert_eq!(to.path(), "/authorize");
    for (name, value) in [
        ("response_type", "code"),
        ("client_id", "grades"),
        ("redirect_uri", ANSWER),
        ("scope", "openid profile email"),
        ("code_challenge_method", "S256"),
    ] {
        assert_eq!(asked[name], value, "{to}");
    }
    let cookie = answer.header("set-cookie").expect("a cookie");
    assert!(cookie.ends_with("; Path=/; HttpOnly; SameSite=Lax; Max-Age=600; Secure"), "{cookie}");
    Begun { asked, cookie: cookie.split(';').next().expect("a value").to_owned() }
}

/// Returns from the provider, with the browser's cookies.
pub(crate) fn come(server: &Server, (state, code): (&str, &str), cookies: &str) -> Answer {
    let query = url::form_urlencoded::Serializer::new(String::new())
        .append_pair("state", state)
        .append_pair("code", code)
        .append_pair("session_state", "x")
        .finish();
    let headers = [("Sec-Fetch-Site", "cross-site"), ("Cookie", cookies)];
    server.visitor().send("GET", &format!("/sign-in/provider/answer?{query}"), &headers, b"")
}

/// Returns from the provider as a person, with changed claims.
pub(crate) fn come_as(server: &Server, provider: &Provider, subject: &str, change: impl FnOnce(&mut Value)) -> Answer {
    let begun = begin(&server.visitor(), "/sign-in/provider?to=%2Fc%2Fphysics");
    let mut claims = provider.claims(&begun, subject);
    change(&mut claims);
    let key = provider.inside().published;
    let code = provider.code(&begun, &KEYS[key].sign(&claims));
    come(server, (&begun.asked["state"], &code), &begun.cookie)
}

/// Signs a person in. Returns the person's client and the address of the page.
pub(crate) fn sign_in(
    server: &Server,
    provider: &Provider,
    subject: &str,
    change: impl FnOnce(&mut Value),
) -> (Client, String) {
    entered(server, &come_as(server, provider, subject, change).expect(303))
}

/// Returns the client of a person who has just signed in, and the address of the page.
pub(crate) fn entered(server: &Server, answer: &Answer) -> (Client, String) {
    let cookie = answer.header("set-cookie").expect("a session").split(';').next().expect("a value").to_owned();
    let headers = vec![("Cookie".to_owned(), cookie), ("Sec-Fetch-Site".to_owned(), "same-origin".to_owned())];
    (Client { url: server.url.clone(), headers }, answer.header("location").expect("a place").to_owned())
}

async fn configuration(State(provider): State<Provider>) -> Response {
    let inside = provider.inside();
    if inside.is_away {
        return StatusCode::BAD_GATEWAY.into_response();
    }
    let at = |path: &str| format!("{}{path}", inside.url);
    Json(json!({"issuer": inside.url, "authorization_endpoint": at("/authorize"), "token_endpoint": at("/token"),
        "userinfo_endpoint": at("/more"), "jwks_uri": at("/keys"), "response_types_supported": ["code"],
        "subject_types_supported": ["public"],
        "id_token_signing_alg_values_supported": ["RS256", "HS256", "none", "new"]}))
    .into_response()
}

async fn keys(State(provider): State<Provider>) -> Json<Value> {
    Json(json!({"keys": [KEYS[provider.inside().published].public(), {"kty": "new", "kid": "other"}]}))
}

async fn token(State(provider): State<Provider>, headers: HeaderMap, body: String) -> Response {
    let fields: HashMap<String, String> = url::form_urlencoded::parse(body.as_bytes()).into_owned().collect();
    let secret = url::form_urlencoded::byte_serialize(SECRET.as_bytes()).collect::<String>();
    assert_eq!(headers["authorization"], format!("Basic {}", STANDARD.encode(format!("grades:{secret}"))));
    assert_eq!([&fields["grant_type"], &fields["redirect_uri"]], ["authorization_code", ANSWER]);
    let given = provider.inside().codes.remove(&fields["code"]);
    let shown = URL_SAFE_NO_PAD.encode(Sha256::digest(&fields["code_verifier"]));
    match given {
        Some((challenge, token)) if challenge == shown => {
            Json(json!({"access_token": "access", "token_type": "Bearer", "id_token": token})).into_response()
        }
        _ => (StatusCode::BAD_REQUEST, Json(json!({"error": "invalid_grant"}))).into_response(),
    }
}

async fn more(State(provider): State<Provider>, headers: HeaderMap) -> Json<Value> {
    assert_eq!(headers["authorization"], "Bearer access");
    Json(provider.inside().more.clone())
}
