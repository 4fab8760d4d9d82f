//! Tests who owns an account: the actions on it that staff, its person and a token may perform.
use crate::support::{
    engines::{Fresh, on_both_engines},
    server::{Client, JSON, Server},
};

on_both_engines!(
    being_in_two_courses_takes_nothing_away,
    a_name_is_changed_by_staff_of_its_course_alone,
    what_staff_could_have_planted_ends_when_rights_grow,
    ways_in_are_counted_by_network_and_bounded,
    tokens_make_no_further_ways_in,
    a_session_lasts_from_the_last_visit
);

/// Makes a person a member, and returns the answer with the link.
fn add(by: &Client, course: &str, login: &str, role: &str) -> serde_json::Value {
    let wish = format!(r#"{{"name": "The {login}", "role": "{role}"}}"#);
    by.send("PUT", &format!("/api/v1/courses/{course}/members/{login}"), JSON, wish.as_bytes()).expect(200).json()
}

fn secret(link: &serde_json::Value) -> String {
    link.as_str().expect("a link").rsplit('/').next().expect("a secret").to_owned()
}

fn new_link(by: &Client, course: &str, login: &str) -> crate::support::server::Answer {
    by.post_json(&format!("/api/v1/courses/{course}/members/{login}/link"), "{}")
}

fn new_token(server: &Server, session: &Client) -> Client {
    let token = session.post_json("/api/v1/tokens", r#"{"name": "tests"}"#).expect(201).json();
    server.with_token(token["token"].as_str().expect("a token"))
}

fn courses(person: &Client) -> usize {
    person.get("/api/v1/courses").expect(200).json().as_array().expect("a list").len()
}

async fn being_in_two_courses_takes_nothing_away(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    server.course(&admin, "other");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let colleague = server.member(&admin, "other", "colleague", "staff");
    let ada = server.visitor().welcome(&secret(&add(&teacher, "physics", "ada", "student")["link"]));
    // Her account belongs to physics, whose staff may sign in as her. Therefore the other course does not accept it.
    let wish = br#"{"name": "Ada", "role": "student"}"#;
    let refused = colleague.send("PUT", "/api/v1/courses/other/members/ada", JSON, wish).expect(403).json();
    assert!(
        refused["detail"].as_str().is_some_and(|said| said.contains("ask an administrator to add it")),
        "{refused}"
    );
    // A table names the person in her line, and adds nobody.
    let table = b"Zoe,zoe\nAda,ada\nBob,bob\n";
    for question in ["?preview=true", ""] {
        let csv = [("Content-Type", "text/csv"), ("Sec-Fetch-Site", "same-origin")];
        let path = format!("/api/v1/courses/other/members{question}");
        let lines = colleague.send("POST", &path, &csv, table).expect(200).json();
        let error = lines[1]["error"].as_str().expect("an error");
        assert!(error.contains("ask an administrator") && lines[0]["link"].is_null(), "{lines}");
    }
    assert_eq!(colleague.get("/api/v1/courses/other/members").expect(200).json().as_array().map(Vec::len), Some(1));
    ada.get("/api/v1/me").expect(200);
    assert_eq!(courses(&ada), 1);
    new_link(&colleague, "other", "ada").expect(404);
    new_link(&teacher, "physics", "ada").expect(200);
    // The administrator adds her. From then on, no staff can sign in as her or sign her out.
    let ada = server.visitor().welcome(&secret(&add(&admin, "other", "ada", "student")["link"]));
    assert_eq!(courses(&ada), 2);
    for (staff, course) in [(&teacher, "physics"), (&colleague, "other")] {
        new_link(staff, course, "ada").expect(403);
        assert!(add(staff, course, "ada", "staff")["link"].is_null());
        add(staff, course, "ada", "student");
    }
    ada.get("/api/v1/me").expect(200);
    // Further courses can add her immediately.
    server.course(&admin, "third");
    let third = server.member(&admin, "third", "third-teacher", "staff");
    assert!(add(&third, "third", "ada", "student")["link"].is_null());
    assert_eq!(courses(&ada), 3);
}

async fn a_name_is_changed_by_staff_of_its_course_alone(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    server.course(&admin, "other");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    add(&teacher, "physics", "ada", "student");
    let rename = |by: &Client, name: &str| {
        by.post_form("/c/physics/members", &format!("login=ada&name={name}&role=student")).expect(200);
        let members = admin.get("/api/v1/courses/physics/members").expect(200).json();
        members[0]["name"].as_str().expect("a name").to_owned()
    };
    assert_eq!(rename(&teacher, "Ada+King"), "Ada King");
    assert!(teacher.get("/c/physics/audit").expect(200).text().contains("ada was renamed"));
    // In two courses, she has one name, which the staff of neither may change.
    add(&admin, "other", "ada", "student");
    assert_eq!(rename(&teacher, "Eve"), "Ada King");
    assert!(!teacher.get("/c/physics/members").expect(200).text().contains("Name of ada"));
    assert_eq!(rename(&admin, "Ada+Lovelace"), "Ada Lovelace");
    let people = admin.get("/admin/people").expect(200).text();
    assert!(people.contains("/accounts/ada/remove") && !people.contains("/accounts/admin/remove"), "{people}");
    assert!(people.contains("other, physics") && people.contains("physics (staff)"), "{people}");
}

async fn what_staff_could_have_planted_ends_when_rights_grow(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    server.course(&admin, "other");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    {
        let login = "ada";
        let link = |made: serde_json::Value| server.visitor().welcome(&secret(&made["link"]));
        let student = link(add(&teacher, "physics", login, "student"));
        // The teacher signs in as the student, plants a token, and by that another session.
        let planted = link(new_link(&teacher, "physics", login).expect(200).json());
        let token = new_token(&server, &planted);
        let bearer = token.headers[0].1.strip_prefix("Bearer ").expect("a token").to_owned();
        let cookie = server.visitor().post_form("/sign-in", &format!("token={bearer}")).expect(303);
        let cookie = cookie.header("set-cookie").expect("a cookie").split(';').next().expect("a value").to_owned();
        let by_token = Client { url: server.url.clone(), headers: vec![("Cookie".to_owned(), cookie)] };
        let unused = secret(&new_link(&teacher, "physics", login).expect(200).json()["link"]);
        by_token.get("/api/v1/me").expect(200);
        // The account's owner is not proven, so the administrator's link must be used.
        let added = add(&admin, "other", login, "student");
        student.get("/api/v1/me").expect(401);
        let student = link(added);
        assert_eq!(courses(&student), 2);
        for planted in [&planted, &token, &by_token] {
            planted.get("/api/v1/me").expect(401);
        }
        server.visitor().post_form(&format!("/welcome/{unused}"), "").expect(401);
    }
}

async fn tokens_make_no_further_ways_in(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let session = server.visitor().welcome(&secret(&add(&admin, "physics", "ada", "student")["link"]));
    let made = session.post_json("/api/v1/tokens", r#"{"name": "leaked"}"#).expect(201).json();
    // Two tokens of a person differ in their names.
    let problem = session.post_json("/api/v1/tokens", r#"{"name": "leaked"}"#).expect(409).json();
    assert!(problem["detail"] == "you already have a token with this name", "{problem}");
    let bearer = made["token"].as_str().expect("a token");
    let token = server.with_token(bearer);
    let cookie = server.visitor().post_form("/sign-in", &format!("token={bearer}")).expect(303);
    let cookie = cookie.header("set-cookie").expect("a cookie").split(';').next().expect("a value").to_owned();
    let headers = [("Cookie".to_owned(), cookie), ("Sec-Fetch-Site".to_owned(), "same-origin".to_owned())];
    let by_token = Client { url: server.url.clone(), headers: headers.into() };
    for leaked in [&token, &by_token] {
        leaked.get("/api/v1/me").expect(200);
        leaked.post_json("/api/v1/tokens", r#"{"name": "more"}"#).expect(403);
        leaked.post_form("/account/tokens", "name=more").expect(403);
    }
    // When the token is revoked, the session that it began ends, too.
    session.send("DELETE", &format!("/api/v1/tokens/{}", made["id"]), &[], b"").expect(204);
    token.get("/api/v1/me").expect(401);
    by_token.get("/api/v1/me").expect(401);
    // A browser that was left open cannot create tokens either.
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    transaction.execute("UPDATE session SET created_at = created_at - 50000000", &[]).await.expect("older");
    transaction.commit().await.expect("a commit");
    session.get("/api/v1/me").expect(200);
    let problem = session.post_json("/api/v1/tokens", r#"{"name": "more"}"#).expect(403).json();
    assert_eq!(problem["type"], "urn:fosssim:sign-in-again", "{problem}");
}

async fn a_session_lasts_from_the_last_visit(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let link = server.first_link();
    let session = server.visitor().welcome(&link);
    assert!(session.get("/").expect(200).header("set-cookie").is_none(), "seen a moment ago");
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    transaction.execute("UPDATE session SET seen_at = seen_at - 600000", &[]).await.expect("older");
    transaction.commit().await.expect("a commit");
    let cookie = session.get("/").expect(200).header("set-cookie").expect("a cookie").to_owned();
    let kept = &session.headers[0].1;
    assert!(cookie.starts_with(kept.as_str()) && cookie.contains("Max-Age=1209600"), "{cookie}");
    // A request without a sign-in, and one from another site, are rejected with different reasons.
    let json = [JSON[0]];
    server.visitor().send("POST", "/api/v1/tokens", &json, br#"{"name": "x"}"#).expect(401);
    let headers = [JSON[0], ("Sec-Fetch-Site", "cross-site"), ("Cookie", kept.as_str())];
    server.visitor().send("POST", "/api/v1/tokens", &headers, br#"{"name": "x"}"#).expect(403);
}

async fn ways_in_are_counted_by_network_and_bounded(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0", "--client-address", "XRealIp"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.visitor().welcome(&secret(&add(&admin, "physics", "ada", "student")["link"]));
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
    // A person who signs in often has a limited number of sessions: the oldest one ends.
    for _ in 0..51 {
        assert_eq!(sign_in("192.0.2.1", &token), 303);
    }
    ada.get("/api/v1/me").expect(401);
    server.with_token(&token).get("/api/v1/me").expect(200);
    // A network that tries too often is blocked, and no other network is.
    let tried = (0..3000).map(|_| sign_in("2001:db8::1", "fso_none")).find(|status| *status != 401);
    assert_eq!(tried, Some(429));
    assert_eq!(sign_in("2001:db8::2", &token), 429);
    assert_eq!(sign_in("2001:db8:0:1::2", &token), 303);
}
