//! Passwords, where a server allows them.
use crate::support::{
    engines::{Fresh, on_sqlite},
    server::{Client, JSON, Server},
};

on_sqlite!(
    a_password_signs_in_until_it_is_changed,
    nobody_signs_in_by_guessing,
    without_the_option_there_are_none,
    ways_in_are_counted_by_network_and_bounded
);

fn set(person: &Client, old: &str, new: &str) -> u16 {
    let wish = format!(r#"{{"old": "{old}", "new": "{new}"}}"#);
    person.send("PUT", "/api/v1/password", JSON, wish.as_bytes()).status
}

/// A member with a browser.
fn member(server: &Server, admin: &Client, login: &str) -> Client {
    let wish = br#"{"name": "X", "role": "student"}"#;
    let made = admin.send("PUT", &format!("/api/v1/courses/physics/members/{login}"), JSON, wish).expect(200).json();
    server.visitor().welcome(made["link"].as_str().expect("a link").rsplit('/').next().expect("a secret"))
}

fn sign_in(server: &Server, login: &str, password: &str) -> crate::support::server::Answer {
    server.visitor().post_form("/sign-in/password", &format!("login={login}&password={password}"))
}

async fn a_password_signs_in_until_it_is_changed(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0", "--passwords"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = member(&server, &admin, "ada");
    assert!(server.visitor().get("/sign-in").expect(200).text().contains("Sign in with the password"));
    assert!(ada.get("/account").expect(200).text().contains("New password"));
    for bad in ["short", "123456789", &"x".repeat(201)] {
        assert_eq!(set(&ada, "", bad), 400);
    }
    assert_eq!(set(&ada, "", "correct horse"), 204);
    let cookie =
        sign_in(&server, "ada", "correct+horse").expect(303).header("set-cookie").expect("a cookie").to_owned();
    let cookie = cookie.split(';').next().expect("a value").to_owned();
    let headers = [("Cookie".to_owned(), cookie), ("Sec-Fetch-Site".to_owned(), "same-origin".to_owned())];
    let session = Client { url: server.url.clone(), headers: headers.into() };
    session.get("/api/v1/me").expect(200);
    // Anybody who changes it shows the old one, and who signed in by that is out.
    assert_eq!(set(&ada, "correct horse", "another horse"), 401, "she is out, too");
    assert_eq!(set(&session, "wrong horse!", "another horse"), 401);
    assert_eq!(set(&session, "correct horse", "another horse"), 204);
    session.get("/api/v1/me").expect(401);
    sign_in(&server, "ada", "correct+horse").expect(401);
    sign_in(&server, "ada", "another+horse").expect(303);
    // A link makes it void: who needs one has forgotten it.
    let link = admin.post_json("/api/v1/courses/physics/members/ada/link", "{}").expect(200).json();
    let ada = server.visitor().welcome(link["link"].as_str().expect("a link").rsplit('/').next().expect("a secret"));
    sign_in(&server, "ada", "another+horse").expect(401);
    // So does becoming more than a student: anybody who set it could sign in as staff.
    assert_eq!(set(&ada, "", "third horse !"), 204);
    let wish = br#"{"name": "Ada", "role": "staff"}"#;
    admin.send("PUT", "/api/v1/courses/physics/members/ada", JSON, wish).expect(200);
    sign_in(&server, "ada", "third+horse+!").expect(401);
    // The database has a digest, and the log neither.
    let mut transaction = fresh.database.read().await.expect("a transaction");
    let rows = transaction.rows("SELECT password FROM account WHERE password IS NOT NULL", &[]).await.expect("rows");
    assert!(rows.is_empty());
    assert!(!server.log().contains("horse"));
}

async fn nobody_signs_in_by_guessing(fresh: Fresh) {
    let mut server =
        Server::start(&fresh, &["--workers", "0", "--passwords", "--client-address", "RightmostXForwardedFor"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = member(&server, &admin, "ada");
    let eve = member(&server, &admin, "eve");
    assert_eq!(set(&ada, "", "correct horse"), 204);
    let mut transaction = fresh.database.read().await.expect("a transaction");
    let kept = transaction.one("SELECT password FROM account WHERE login = 'ada'", &[]).await.expect("a row");
    assert!(kept.text("password").expect("a digest").starts_with("argon2id$"));
    drop(transaction);
    // An account without a password, and one that does not exist, are told alike.
    let (nobody, without) = (sign_in(&server, "nobody", "whatever+it"), sign_in(&server, "admin", "whatever+it"));
    assert_eq!((nobody.status, nobody.body), (401, without.body));
    // Right ones are not counted, however many.
    assert!((0..12).all(|_| sign_in(&server, "ada", "correct+horse").status == 303));
    let statuses: Vec<u16> = (0..14).map(|_| sign_in(&server, "ada", "wrong+horse+!").status).collect();
    assert!(statuses.starts_with(&[401]) && statuses.contains(&429), "{statuses:?}");
    // From another site nothing is even tried.
    let other = server.visitor().send(
        "POST",
        "/sign-in/password",
        &[("Content-Type", "application/x-www-form-urlencoded"), ("Sec-Fetch-Site", "cross-site")],
        b"login=ada&password=correct+horse",
    );
    other.expect(403);
    eve.get("/api/v1/me").expect(200);
    // Anybody who guesses shuts their own address out, and nobody else: from another one the right password goes on
    // working.
    sign_in(&server, "ada", "correct+horse").expect(429);
    let headers = [
        ("Content-Type", "application/x-www-form-urlencoded"),
        ("Sec-Fetch-Site", "same-origin"),
        // The last word is the proxy's; anybody may write what is before it.
        ("X-Forwarded-For", "127.0.0.1, 2001:db8::7"),
    ];
    let body = b"login=ada&password=correct+horse";
    server.visitor().send("POST", "/sign-in/password", &headers, body).expect(303);
}

async fn without_the_option_there_are_none(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    assert_eq!(set(&admin, "", "correct horse"), 403);
    sign_in(&server, "admin", "correct+horse").expect(403);
    assert!(!server.visitor().get("/sign-in").expect(200).text().contains("Sign in with the password"));
}

async fn ways_in_are_counted_by_network_and_bounded(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0", "--client-address", "XRealIp"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = member(&server, &admin, "ada");
    let made = ada.post_json("/api/v1/tokens", r#"{"name": "mine"}"#).expect(201).json();
    let token = made["token"].as_str().expect("a token").to_owned();
    let sign_in = |address: &str, token: &str| {
        let headers = [
            ("Content-Type", "application/x-www-form-urlencoded"),
            ("Sec-Fetch-Site", "same-origin"),
            ("X-Real-Ip", address),
        ];
        server.visitor().send("POST", "/sign-in", &headers, format!("token={token}").as_bytes()).status
    };
    // However often somebody signs in, they have few sessions: the first one ends.
    for _ in 0..51 {
        assert_eq!(sign_in("192.0.2.1", &token), 303);
    }
    ada.get("/api/v1/me").expect(401);
    server.with_token(&token).get("/api/v1/me").expect(200);
    // A network that tries too much shuts itself out, and nobody else.
    let tried = (0..3000).map(|_| sign_in("2001:db8::1", "fso_none")).find(|status| *status != 401);
    assert_eq!(tried, Some(429));
    assert_eq!(sign_in("2001:db8::2", &token), 429);
    assert_eq!(sign_in("2001:db8:0:1::2", &token), 303);
}
