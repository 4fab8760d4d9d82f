//! Tests forged and valid messages of learning platforms.
use super::platforms::{CONTEXT, RESOURCE, connect, start};
use crate::support::{
    engines::{Fresh, run},
    platform::{self, CLIENT, KEYS, LEARNER, Platform, begin, come, now, unsigned},
    server::Server,
};
use base64::{Engine as _, engine::general_purpose::URL_SAFE_NO_PAD};
use ring::hmac;
use serde_json::{Value, json};

/// The beginning of the names of LTI claims.
const CLAIM: &str = "https://purl.imsglobal.org/spec/lti/claim";

type Change<'a> = &'a dyn Fn(&mut Value);
type Sign<'a> = &'a dyn Fn(&Value) -> String;

/// Sends forged messages. Each has a name, a change of the claims, a signature, and the expected text of the rejection.
fn assert_refused(server: &Server, platform: &Platform, attacks: &[(&str, Change<'_>, Sign<'_>, &str)]) {
    for (name, change, sign, said) in attacks {
        let begun = begin(server, platform);
        let mut claims = platform.claims(&begun.nonce, "ada", LEARNER);
        change(&mut claims);
        let answer = come(server, &begun, &sign(&claims)).expect(403);
        assert!(answer.text().contains(said), "{name}: {}", answer.text());
        assert!(answer.header("set-cookie").is_none(), "{name}");
    }
}

#[test]
fn a_message_that_the_platform_did_not_sign_is_refused() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite");
        let (server, _, platform) = start(&fresh, &[]).await;
        let teacher = connect(&server, &platform);
        let valid = |claims: &mut Value| claims["name"] = json!("Ada");
        let attacks: &[(&str, Change, Sign, &str)] = &[
            ("somebody else's key", &valid, &|claims| KEYS[2].sign(claims), "not signed by the platform"),
            ("a key of no platform", &valid, &|claims| KEYS[1].sign(claims), "no key with the ID"),
            (
                "no key's name",
                &valid,
                &|claims| KEYS[0].sign_as(&json!({"alg": "RS256"}), claims),
                "RS256 with a named key",
            ),
            (
                "no signature",
                &valid,
                &|claims| unsigned(&json!({"alg": "none", "kid": "first"}), claims) + ".",
                "RS256",
            ),
            (
                "a signature that is not looked at",
                &valid,
                &|claims| KEYS[0].sign_as(&json!({"alg": "none", "kid": "first"}), claims),
                "RS256",
            ),
            ("the public key as a secret", &valid, &|claims| KEYS[0].sign_by_public(claims), "RS256"),
            (
                "another algorithm of the family",
                &valid,
                &|claims| KEYS[0].sign_as(&json!({"alg": "RS512", "kid": "first"}), claims),
                "RS256",
            ),
            (
                "claims changed after signing",
                &valid,
                &|claims| {
                    let signed = KEYS[0].sign(claims);
                    let mut other = claims.clone();
                    other["sub"] = json!("teacher");
                    let signature = signed.rsplit('.').next().expect("a signature");
                    unsigned(&json!({"alg": "RS256", "typ": "JWT", "kid": "first"}), &other) + "." + signature
                },
                "not signed by the platform",
            ),
            ("no token", &valid, &|_| "a.b.c".to_owned(), "RS256"),
        ];
        assert_refused(&server, &platform, attacks);
        let members = teacher.get("/api/v1/courses/physics/members").expect(200).json();
        assert_eq!(members.as_array().expect("a list").len(), 1, "nobody came in by any of these");
    });
}

#[test]
fn what_a_platform_did_not_say_is_refused() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite");
        let (server, _, platform) = start(&fresh, &[]).await;
        let teacher = connect(&server, &platform);
        let sign = |claims: &Value| KEYS[0].sign(claims);
        let set = |name: &'static str, value: Value| move |claims: &mut Value| claims[name] = value.clone();
        let drop_claim =
            |name: &'static str| move |claims: &mut Value| drop(claims.as_object_mut().expect("claims").remove(name));
        let attacks: &[(&str, Change, Sign, &str)] = &[
            ("another issuer", &set("iss", json!("https://evil.example")), &sign, "the issuer differs"),
            ("another audience", &set("aud", json!("client-2")), &sign, "the audience differs"),
            ("no audience", &drop_claim("aud"), &sign, "aud"),
            ("several audiences", &set("aud", json!([CLIENT, "client-2"])), &sign, "the authorized party differs"),
            ("another party", &set("azp", json!("client-2")), &sign, "the authorized party differs"),
            ("another nonce", &set("nonce", json!("0".repeat(64))), &sign, "the nonce differs"),
            ("expired", &set("exp", json!(now() - 120)), &sign, "too old"),
            ("no end", &drop_claim("exp"), &sign, "exp"),
            ("made in the future", &set("iat", json!(now() + 600)), &sign, "too old, or a clock"),
            ("made long ago", &set("iat", json!(now() - 10_000)), &sign, "too old, or a clock"),
            ("not valid yet", &set("nbf", json!(now() + 600)), &sign, "too old, or a clock"),
            (
                "another deployment",
                &|claims| claims[format!("{CLAIM}/deployment_id")] = json!("d<2>"),
                &sign,
                "deployment d&#60;2&#62; is not registered",
            ),
            (
                "another version",
                &|claims| claims[format!("{CLAIM}/version")] = json!("1.1"),
                &sign,
                "the LTI version must be 1.3.0",
            ),
            (
                "another message",
                &|claims| claims[format!("{CLAIM}/message_type")] = json!("X"),
                &sign,
                "this message type is not supported",
            ),
            ("nobody", &set("sub", json!("")), &sign, "sub"),
            ("no subject", &drop_claim("sub"), &sign, "sub"),
            ("no course", &drop_claim(CONTEXT), &sign, "context is missing"),
            ("no link", &drop_claim(RESOURCE), &sign, "resource_link is missing"),
            ("no role", &|claims| claims[format!("{CLAIM}/roles")] = json!([]), &sign, "neither learn nor teach"),
            (
                "a role of elsewhere",
                &|claims| claims[format!("{CLAIM}/roles")] = json!(["https://evil.example/membership#Instructor"]),
                &sign,
                "neither learn nor teach",
            ),
        ];
        assert_refused(&server, &platform, attacks);
        let members = teacher.get("/api/v1/courses/physics/members").expect(200).json();
        assert_eq!(members.as_array().expect("a list").len(), 1, "nobody came in by any of these");
    });
}

#[test]
fn a_message_is_believed_once_and_in_the_browser_that_asked() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite");
        let (server, _, platform) = start(&fresh, &[]).await;
        connect(&server, &platform);
        // The same claims with several audiences are accepted if the authorized party is this service.
        let begun = begin(&server, &platform);
        let mut claims = platform.claims(&begun.nonce, "ada", LEARNER);
        claims["aud"] = json!([CLIENT, "client-2"]);
        claims["azp"] = json!(CLIENT);
        let token = KEYS[0].sign(&claims);
        let answer = come(&server, &begun, &token).expect(303);
        assert_eq!(answer.header("location"), Some("/c/physics/a/m1"), "whatever the message says it wanted");
        // A message is accepted once, only in the browser that started the sign-in, and only if a sign-in was started.
        let again = come(&server, &begun, &token).expect(403).text();
        assert!(again.contains("unknown, used or too old"), "{again}");
        let (mine, other) = (begin(&server, &platform), begin(&server, &platform));
        let token = KEYS[0].sign(&platform.claims(&mine.nonce, "ada", LEARNER));
        let stolen = platform::Begun { cookie: other.cookie.clone(), state: mine.state.clone(), nonce: String::new() };
        assert!(come(&server, &stolen, &token).expect(403).text().contains("began in another browser"));
        let bare = platform::Begun { cookie: "x=y".to_owned(), state: mine.state.clone(), nonce: String::new() };
        assert!(come(&server, &bare, &token).expect(403).text().contains("did not send the cookie"));
        let mixed = platform::Begun { cookie: other.cookie, state: other.state, nonce: String::new() };
        assert!(come(&server, &mixed, &token).expect(403).text().contains("the nonce differs"));
        let forged = platform::Begun { cookie: mine.cookie.clone(), state: "0".repeat(64), nonce: String::new() };
        come(&server, &forged, &token).expect(403);
        come(&server, &mine, &token).expect(303);
        // A message that arrives too late.
        let late = begin(&server, &platform);
        let mut transaction = fresh.database.read().await.expect("a transaction");
        let secret = transaction.one("SELECT value FROM server_secret", &[]).await.expect("a row");
        let key = hmac::Key::new(hmac::HMAC_SHA256, secret.text("value").expect("a text").as_bytes());
        let words: Vec<&str> = late.state.split('.').collect();
        for (expires_at, status) in [(words[1], 303), ("1000", 403)] {
            let state = format!("{}.{expires_at}.{}.0..again", words[0], words[2]);
            let state = format!("{state}.{}", URL_SAFE_NO_PAD.encode(hmac::sign(&key, state.as_bytes())));
            let nonce = hmac::sign(&key, format!("nonce {state}").as_bytes());
            let nonce: String = nonce.as_ref().iter().map(|byte| format!("{byte:02x}")).collect();
            let token = KEYS[0].sign(&platform.claims(&nonce, "ada", LEARNER));
            let begun = platform::Begun { state, cookie: late.cookie.clone(), nonce };
            come(&server, &begun, &token).expect(status);
        }
        // A platform that is not registered is rejected.
        let unknown = server.visitor().get("/lti/login?iss=https%3A%2F%2Fevil.example&login_hint=x").expect(403);
        assert!(unknown.header("location").is_none() && unknown.text().contains("has registered this platform"));
        // A failure of the platform is shown.
        let form = "state=x&error=login_required&error_description=%3Cb%3Enot%20signed%20in";
        let answer = server.visitor().post_form("/lti/launch", form).expect(403).text();
        assert!(answer.contains("login_required: &#60;b&#62;not signed in"), "{answer}");
    });
}
