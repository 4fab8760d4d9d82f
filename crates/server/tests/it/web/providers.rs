//! Tests that people sign in at an OpenID Connect provider.
use crate::support::{
    engines::{Fresh, on_both_engines, run},
    platform::{KEYS, now, unsigned},
    provider::{Provider, SECRET, begin, come, come_as, entered, sign_in},
    server::{Answer, Client, JSON, Server},
};
use base64::{Engine as _, engine::general_purpose::URL_SAFE_NO_PAD};
use fosssim_server::values;
use ring::hmac;
use serde_json::{Value, json};

on_both_engines!(people_sign_in, an_account_is_connected_by_its_person, only_people_of_the_domain_come_in);

/// Starts a provider, and a server that uses it, with further options. Also returns the administrator.
async fn start(fresh: &Fresh, more: &[&str]) -> (Server, Client, Provider) {
    let provider = Provider::start().await;
    let folder = tempfile::tempdir().expect("a folder");
    let secret = folder.path().join("secret");
    std::fs::write(&secret, format!("{SECRET}\n")).expect("a file");
    let secret = secret.to_str().expect("UTF-8");
    let options = ["--workers", "0", "--public-url", "https://grades.example.org", "--oidc-client", "grades"];
    let own = ["--oidc-issuer", &provider.url, "--oidc-secret-file", secret, "--oidc-label", "Uni"];
    let mut server = Server::start(fresh, &[&options, &own[..], more].concat());
    let admin = server.admin();
    server.course(&admin, "physics");
    (server, admin, provider)
}

/// Waits until a condition holds, because the server reads the provider's configuration again only after a second.
fn wait_until(holds: impl Fn() -> bool) {
    let start = std::time::Instant::now();
    while !holds() {
        assert!(start.elapsed() < std::time::Duration::from_secs(60));
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
}

fn login(person: &Client) -> String {
    person.get("/api/v1/me").expect(200).json()["login"].as_str().expect("a login").to_owned()
}

/// Creates a member, and signs the person in with the link.
fn member(server: &Server, by: &Client, login: &str, role: &str) -> Client {
    let wish = format!(r#"{{"name": "X", "role": "{role}"}}"#);
    let made = by.send("PUT", &format!("/api/v1/courses/physics/members/{login}"), JSON, wish.as_bytes());
    welcome(server, &made.expect(200))
}

fn welcome(server: &Server, made: &Answer) -> Client {
    server.visitor().welcome(made.json()["link"].as_str().expect("a link").rsplit('/').next().expect("a secret"))
}

async fn people_sign_in(fresh: Fresh) {
    let (server, admin, provider) = start(&fresh, &[]).await;
    let page = server.visitor().get("/sign-in?to=%2Fc%2Fphysics").expect(200).text();
    assert!(page.contains(r#"href="/sign-in/provider?to=%2Fc%2Fphysics">Sign in with Uni<"#), "{page}");
    let (ada, place) = sign_in(&server, &provider, "ada", |_| {});
    assert_eq!((login(&ada).as_str(), place.as_str()), ("ada", "/c/physics"));
    ada.get("/c/physics").expect(404);
    let wish = br#"{"name": "X", "role": "student"}"#;
    admin.send("PUT", "/api/v1/courses/physics/members/ada", JSON, wish).expect(200);
    ada.get("/c/physics").expect(200);
    // She is recognized only by the subject. Another subject is another person.
    let (again, _) = sign_in(&server, &provider, "ada", |claims| claims["preferred_username"] = json!("Countess"));
    assert_eq!(login(&again), "ada");
    let (other, _) = sign_in(&server, &provider, "x-1", |claims| claims["email"] = json!("ada@uni.example"));
    assert_eq!(login(&other), "ada-2");
    // Without a domain, nobody gets an account that staff created, and a platform's subject is not a subject of the
    // provider.
    member(&server, &admin, "eve", "student");
    assert_eq!(login(&sign_in(&server, &provider, "eve", |_| {}).0), "eve-2");
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    let statement = "INSERT INTO platform_account (issuer, subject, account, created_at)
        SELECT ?, 'root', id, {now} FROM account WHERE login = 'admin'";
    transaction.execute(statement, values![&provider.url]).await.expect("a row");
    transaction.commit().await.expect("a commit");
    assert_eq!(login(&sign_in(&server, &provider, "root", |_| {}).0), "root");
    // Some providers give data about people only on request.
    let quiet = |claims: &mut Value| {
        claims.as_object_mut().expect("claims").retain(|name, _| name != "email" && name != "name");
    };
    provider.inside().more = json!({"sub": "bob", "name": "Bob", "preferred_username": "b.o.b@uni.example"});
    assert_eq!(login(&sign_in(&server, &provider, "bob", quiet).0), "b.o.b");
    // The provider's keys change.
    provider.inside().published = 1;
    wait_until(|| come_as(&server, &provider, "ada", |_| {}).status == 303);
    assert_eq!(login(&sign_in(&server, &provider, "ada", |_| {}).0), "ada");
    again.post_form("/sign-out", "").expect(303);
    again.get("/api/v1/me").expect(401);
    // A closed account stays closed.
    admin.send("DELETE", "/api/v1/accounts/ada", &[], b"").expect(204);
    let closed = come_as(&server, &provider, "ada", |_| {}).expect(403).text();
    assert!(closed.contains("closed"), "{closed}");
}

async fn an_account_is_connected_by_its_person(fresh: Fresh) {
    let (server, admin, provider) = start(&fresh, &[]).await;
    let teacher = member(&server, &admin, "teacher", "staff");
    let ada = member(&server, &teacher, "ada", "student");
    let new_link = || teacher.post_json("/api/v1/courses/physics/members/ada/link", "{}");
    let planted = welcome(&server, &new_link().expect(200));
    let token = planted.post_json("/api/v1/tokens", r#"{"name": "planted"}"#).expect(201).json();
    let token = server.with_token(token["token"].as_str().expect("a token"));
    // Another site cannot begin a connection, because it could have signed this browser in at the provider. A token
    // cannot, either.
    let session = ("Cookie", ada.headers[0].1.as_str());
    server.visitor().send("GET", "/account/provider", &[session, ("Sec-Fetch-Site", "cross-site")], b"").expect(403);
    token.send("GET", "/account/provider", &[("Sec-Fetch-Site", "same-origin")], b"").expect(403);
    assert!(ada.get("/account").expect(200).text().contains("Connect with Uni"));
    let connect = |person: &Client, subject: &str| {
        let begun = begin(person, "/account/provider");
        let code = provider.code(&begun, &KEYS[0].sign(&provider.claims(&begun, subject)));
        let cookies = format!("{}; {}", begun.cookie, person.headers[0].1);
        (begun, code, cookies)
    };
    // Only the browser that began the connection can complete it.
    let (begun, code, _) = connect(&ada, "ada");
    come(&server, (&begun.asked["state"], &code), &begun.cookie).expect(403);
    let (begun, code, cookies) = connect(&ada, "ada");
    let (ada, place) = entered(&server, &come(&server, (&begun.asked["state"], &code), &cookies).expect(303));
    assert_eq!((login(&ada).as_str(), place.as_str()), ("ada", "/account"));
    assert!(ada.get("/account").expect(200).text().contains("You sign in with Uni"));
    // The account is now her own: sessions from staff links have ended, and staff can create no more links.
    planted.get("/api/v1/me").expect(401);
    token.get("/api/v1/me").expect(401);
    new_link().expect(403);
    assert_eq!(login(&sign_in(&server, &provider, "ada", |_| {}).0), "ada");
    let (begun, code, cookies) = connect(&ada, "other");
    come(&server, (&begun.asked["state"], &code), &cookies).expect(409);
    // Staff could have connected it in a session from a link. If it gets more rights, it must be connected again.
    let wish = br#"{"name": "Ada", "role": "staff"}"#;
    let link = admin.send("PUT", "/api/v1/courses/physics/members/ada", JSON, wish).expect(200);
    let (new, _) = sign_in(&server, &provider, "ada", |_| {});
    assert_eq!(login(&new), "ada-2");
    let ada = welcome(&server, &link);
    let (begun, code, cookies) = connect(&ada, "ada");
    let (ada, _) = entered(&server, &come(&server, (&begun.asked["state"], &code), &cookies).expect(303));
    assert_eq!([login(&ada), login(&sign_in(&server, &provider, "ada", |_| {}).0)], ["ada", "ada"]);
    // A connection that staff could have made by its own link ends also with the administrator's link.
    let planted = member(&server, &teacher, "eve", "student");
    let (begun, code, cookies) = connect(&planted, "mallory");
    come(&server, (&begun.asked["state"], &code), &cookies).expect(303);
    assert_eq!(login(&sign_in(&server, &provider, "mallory", |_| {}).0), "eve");
    welcome(&server, &admin.post_json("/api/v1/courses/physics/members/eve/link", "{}").expect(200));
    assert_eq!(login(&sign_in(&server, &provider, "mallory", |_| {}).0), "mallory");
    ada.post_form("/account/provider/remove", "").expect(303);
    assert!(ada.get("/account").expect(200).text().contains("Connect with Uni"));
}

#[test]
fn an_answer_that_the_provider_did_not_give_is_refused() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite").with_tables().await;
        attack(fresh).await;
    });
}

async fn attack(fresh: Fresh) {
    let (server, _, provider) = start(&fresh, &[]).await;
    let header = json!({"alg": "HS256", "kid": "first"});
    let by_secret = |claims: &Value| {
        let text = unsigned(&header, claims);
        let key = hmac::Key::new(hmac::HMAC_SHA256, SECRET.as_bytes());
        format!("{text}.{}", URL_SAFE_NO_PAD.encode(hmac::sign(&key, text.as_bytes())))
    };
    let valid = |_: &mut Value| {};
    let by_key = |claims: &Value| KEYS[0].sign(claims);
    type Change<'a> = &'a dyn Fn(&mut Value);
    type Sign<'a> = &'a dyn Fn(&Value) -> String;
    let attacks: &[(&str, Change<'_>, Sign<'_>, &str)] = &[
        ("another sign-in's", &|claims| claims["nonce"] = json!("0".repeat(64)), &by_key, "nonce"),
        ("another issuer's", &|claims| claims["iss"] = json!("https://other.example"), &by_key, "issuer"),
        ("another client's", &|claims| claims["aud"] = json!("other"), &by_key, "audience"),
        ("also another client's", &|claims| claims["aud"] = json!(["grades", "other"]), &by_key, "audience"),
        ("too old", &|claims| claims["exp"] = json!(now() - 1), &by_key, "expired"),
        ("no subject", &|claims| claims["sub"] = json!(""), &by_key, "sub must have"),
        ("somebody else's key", &valid, &|claims| KEYS[2].sign(claims), "ignature"),
        ("a key of nobody", &valid, &|claims| KEYS[1].sign(claims), "key"),
        ("unsigned", &valid, &|claims| unsigned(&json!({"alg": "none"}), claims) + ".", "ignature"),
        ("the public key as a secret", &valid, &|claims| KEYS[0].sign_by_public(claims), "ignature"),
        ("the client's secret as a key", &valid, &by_secret, "ignature"),
    ];
    let refused = |answer: Answer, said: &str, name: &str| {
        assert!(answer.status == 403 && answer.text().contains(said), "{name}: {} {}", answer.status, answer.text());
        assert!(answer.header("set-cookie").is_none(), "{name}");
    };
    for (name, change, sign, said) in attacks {
        let begun = begin(&server.visitor(), "/sign-in/provider");
        let mut claims = provider.claims(&begun, "ada");
        change(&mut claims);
        let code = provider.code(&begun, &sign(&claims));
        refused(come(&server, (&begun.asked["state"], &code), &begun.cookie), said, name);
    }
    // States that are invented, changed, of another browser, without a browser, or used. Codes of another sign-in, and
    // used codes.
    let (begun, other) = (begin(&server.visitor(), "/sign-in/provider"), begin(&server.visitor(), "/sign-in/provider"));
    let token = KEYS[0].sign(&provider.claims(&begun, "ada"));
    let (state, code) = (&begun.asked["state"], provider.code(&begun, &token));
    refused(come(&server, ("x", &code), &begun.cookie), "unknown, used or too old", "made up");
    let changed = state.replacen("provider.1", "provider.2", 1);
    assert_ne!(&changed, state);
    refused(come(&server, (&changed, &code), &begun.cookie), "unknown, used or too old", "changed");
    refused(come(&server, (state, &code), &other.cookie), "another browser", "another browser's");
    refused(come(&server, (state, &code), "x=y"), "did not send the cookie", "no cookie");
    refused(come(&server, (&other.asked["state"], &code), &other.cookie), "invalid_grant", "another's code");
    let code = provider.code(&begun, &token);
    come(&server, (state, &code), &begun.cookie).expect(303);
    refused(come(&server, (state, &code), &begun.cookie), "unknown, used or too old", "used");
    let answer = server.visitor().get("/sign-in/provider/answer?error=access_denied&state=x");
    refused(answer, "access_denied", "the person said no");
    // After the sign-in, only pages of this server are opened.
    for to in ["%2F%2Fevil.example", "https%3A%2F%2Fevil.example", "%2F%5Cevil.example"] {
        let begun = begin(&server.visitor(), &format!("/sign-in/provider?to={to}"));
        let code = provider.code(&begun, &KEYS[0].sign(&provider.claims(&begun, "ada")));
        let answer = come(&server, (&begun.asked["state"], &code), &begun.cookie).expect(303);
        assert_eq!(answer.header("location"), Some("/"), "{to}");
    }
    assert!(!server.log().contains(SECRET) && !server.log().contains(&token));
}

async fn only_people_of_the_domain_come_in(fresh: Fresh) {
    let (server, admin, provider) = start(&fresh, &["--oidc-domain", "Uni.Example"]).await;
    provider.inside().is_away = true;
    let teacher = member(&server, &admin, "teacher", "staff");
    let away = server.visitor().get("/sign-in/provider?to=%2Fc%2Fphysics").expect(503).text();
    assert!(away.contains("Uni does not answer") && away.contains("Open the link"), "{away}");
    provider.inside().is_away = false;
    wait_until(|| server.visitor().get("/sign-in/provider").status == 303);
    let refused =
        |change: &dyn Fn(&mut Value), subject: &str| come_as(&server, &provider, subject, change).expect(403).text();
    let made = member(&server, &teacher, "ada", "student");
    for email in ["ada@other.example", "ada@uni.example.evil.example", "ada@uni.example@evil.example", "uni.example"] {
        assert!(refused(&|claims| claims["email"] = json!(email), "ada").contains("address in uni.example"), "{email}");
    }
    assert!(refused(&|claims| claims["email_verified"] = json!(false), "ada").contains("is confirmed by Uni"));
    assert!(
        refused(&|claims| drop(claims.as_object_mut().expect("claims").remove("email_verified")), "ada")
            .contains("confirmed")
    );
    // She gets the account that staff created for this login, once. Sessions that staff could have started in it have
    // ended.
    let named = |claims: &mut Value| claims["email"] = json!("Ada@Uni.Example");
    let (ada, _) = sign_in(&server, &provider, "id-7", named);
    assert_eq!(login(&ada), "ada");
    ada.get("/c/physics").expect(200);
    made.get("/api/v1/me").expect(401);
    teacher.post_json("/api/v1/courses/physics/members/ada/link", "{}").expect(403);
    assert_eq!(login(&sign_in(&server, &provider, "id-8", named).0), "ada-2", "the address has another owner now");
    // Staff and administrators connect their accounts in a browser that is signed in.
    assert!(refused(&|_| {}, "teacher").contains("sign in with your link"));
    assert_eq!(login(&sign_in(&server, &provider, "admin", |_| {}).0), "admin-2");
}
