//! Passwords, where a server allows them.
use crate::support::{
    engines::{Fresh, on_both_engines},
    server::{Client, JSON, Server},
};

on_both_engines!(
    a_password_signs_in_until_it_is_changed,
    nobody_signs_in_by_guessing,
    without_the_option_there_are_none
);

fn set(person: &Client, old: &str, new: &str) -> u16 {
    let wish = format!(r#"{{"old": "{old}", "new": "{new}"}}"#);
    person.send("PUT", "/api/v1/password", JSON, wish.as_bytes()).status
}

fn sign_in(server: &Server, login: &str, password: &str) -> crate::support::server::Answer {
    server.visitor().post_form("/sign-in/password", &format!("login={login}&password={password}"))
}

async fn a_password_signs_in_until_it_is_changed(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0", "--passwords"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    assert!(server.visitor().get("/sign-in").expect(200).text().contains("With a password"));
    assert!(ada.get("/account").expect(200).text().contains("New password"));
    for bad in ["short", "123456789", &"x".repeat(201)] {
        assert_eq!(set(&ada, "", bad), 400);
    }
    assert_eq!(set(&ada, "", "correct horse"), 204);
    let cookie =
        sign_in(&server, "ada", "correct+horse").expect(303).header("set-cookie").expect("a cookie").to_owned();
    let cookie = cookie.split(';').next().expect("a value").to_owned();
    let session = Client { url: server.url.clone(), headers: vec![("Cookie".to_owned(), cookie)] };
    session.get("/api/v1/me").expect(200);
    // Whoever changes it shows the old one, and who signed in by that is out.
    assert_eq!(set(&ada, "wrong horse!", "another horse"), 401);
    assert_eq!(set(&ada, "correct horse", "another horse"), 204);
    session.get("/api/v1/me").expect(401);
    sign_in(&server, "ada", "correct+horse").expect(401);
    sign_in(&server, "ada", "another+horse").expect(303);
    // A link makes it void: who needs one has forgotten it.
    let link = admin.post_json("/api/v1/courses/physics/members/ada/link", "{}").expect(200).json();
    server.visitor().welcome(link["link"].as_str().expect("a link").rsplit('/').next().expect("a secret"));
    sign_in(&server, "ada", "another+horse").expect(401);
    // So does becoming more than a student: whoever set it could sign in as staff.
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
    let mut server = Server::start(&fresh, &["--workers", "0", "--passwords"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    assert_eq!(set(&ada, "", "correct horse"), 204);
    let mut transaction = fresh.database.read().await.expect("a transaction");
    let kept = transaction.one("SELECT password FROM account WHERE login = 'ada'", &[]).await.expect("a row");
    assert!(kept.text("password").expect("a digest").starts_with("argon2id$"));
    drop(transaction);
    // Who has no password, and who does not exist, are told alike.
    let (nobody, without) = (sign_in(&server, "nobody", "whatever+it"), sign_in(&server, "admin", "whatever+it"));
    assert_eq!((nobody.status, nobody.body), (401, without.body));
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
    ada.get("/api/v1/me").expect(200);
}

async fn without_the_option_there_are_none(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    assert_eq!(set(&admin, "", "correct horse"), 403);
    sign_in(&server, "admin", "correct+horse").expect(403);
    assert!(!server.visitor().get("/sign-in").expect(200).text().contains("With a password"));
}
