//! Tests displayed texts: the files that an assignment accepts, the time of the next try, and links to other pages.
use crate::support::{
    engines::{Fresh, on_sqlite},
    server::{Answer, Client, JSON, Server, program},
};

on_sqlite!(
    a_refusal_names_what_is_taken,
    the_hourly_limit_says_until_when,
    a_browser_gets_pages_and_goes_on_where_it_wanted,
    numbers_and_staff_are_kept,
    own_work_on_a_hidden_assignment_stays,
);

const ASSIGNMENT: &str = "/api/v1/courses/physics/assignments/m1";

/// Saves the assignment of the course.
fn set(by: &Client, visible: bool, settings: &str) {
    let wish = format!(r#"{{"title": "Milestone one", "visible": {visible}, "settings": {settings}}}"#);
    by.send("PUT", ASSIGNMENT, JSON, wish.as_bytes()).expect(200);
}

/// Sends a file in a form, as a browser does.
fn post_file(by: &Client, path: &str, name: &str, bytes: &[u8]) -> Answer {
    let head =
        format!("--x\r\nContent-Disposition: form-data; name=\"file\"; filename=\"{name}\"\r\n\r\n").into_bytes();
    let headers = [("Content-Type", "multipart/form-data; boundary=x"), ("Sec-Fetch-Site", "same-origin")];
    by.send("POST", path, &headers, &[&head, bytes, b"\r\n--x--\r\n"].concat())
}

/// Returns an archive with one file.
fn archive(name: &str) -> Vec<u8> {
    let mut archive = tar::Builder::new(Vec::new());
    let mut header = tar::Header::new_ustar();
    header.set_size(1);
    header.set_mode(0o644);
    archive.append_data(&mut header, name, &b"x"[..]).expect("an entry");
    archive.into_inner().expect("an archive")
}

async fn a_refusal_names_what_is_taken(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let detail = |bytes: &[u8]| {
        let answer = ada.send("POST", &format!("{ASSIGNMENT}/submissions"), &[], bytes).expect(422).json();
        answer["detail"].as_str().expect("words").to_owned()
    };
    assert!(detail(b"text").contains("or an archive of sources or traces ("), "{}", detail(b"text"));
    set(&admin, true, r#"{"forms": ["program"]}"#);
    assert_eq!(detail(b"text"), "expected a program for Linux (ELF, or a script that begins with #!), but found text");
    assert_eq!(
        detail(&archive("main.cpp")),
        "this assignment accepts a program for Linux, but the file is an archive of sources"
    );
    set(&admin, true, r#"{"forms": ["traces"]}"#);
    assert!(detail(b"text").starts_with("expected an archive of traces (.zip"), "{}", detail(b"text"));
    let page = post_file(&ada, "/c/physics/a/m1", "", b"").expect(400).text();
    assert!(page.contains("no file was chosen"), "{page}");
    // A suite is not a submission.
    let problem = admin.send("PUT", &format!("{ASSIGNMENT}/suite"), &[], b"").expect(422).json();
    assert_eq!([&problem["title"], &problem["detail"]], ["This is not a suite", "the file is empty"]);
    let page = post_file(&admin, "/c/physics/a/m1/suite", "suite.zip", b"text").expect(422).text();
    assert!(page.contains("the assignment keeps its suite"), "{page}");
}

async fn the_hourly_limit_says_until_when(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    set(&admin, true, r#"{"per_hour": 2}"#);
    let page = ada.get("/c/physics/a/m1").expect(200).text();
    assert!(page.contains("at most 2 uploads in an hour.") && page.contains("at most 128 MiB"), "{page}");
    let first = ada.submit("physics", &program("AC", 1));
    ada.submit("physics", &program("AC", 2));
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    let earlier = "UPDATE submission SET created_at = created_at - 3000000 WHERE id = ?";
    transaction.execute(earlier, &[first.into()]).await.expect("earlier");
    transaction.commit().await.expect("a commit");
    let refused = ada.send("POST", &format!("{ASSIGNMENT}/submissions"), &[], &program("AC", 3)).expect(429);
    let wait: u64 = refused.header("retry-after").and_then(|wait| wait.parse().ok()).expect("seconds");
    assert!((400..=600).contains(&wait), "ten minutes are left of the hour: {wait}");
    assert!(refused.text().contains("the next one is possible from 20"), "{}", refused.text());
    // The limits apply to students.
    let page = admin.get("/c/physics/a/m1").expect(200).text();
    assert!(!page.contains("in an hour"), "{page}");
}

async fn a_browser_gets_pages_and_goes_on_where_it_wanted(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let link = server.first_link();
    let visitor = server.visitor();
    let session = visitor.welcome(&link);
    let page = visitor.get(&format!("/welcome/{link}")).expect(200).text();
    assert!(page.contains("used or too old") && page.contains("Ask the course") && !page.contains("<button"), "{page}");
    let page = session.get(&format!("/welcome/{link}")).expect(200).text();
    assert!(page.contains("You are signed in as admin") && !page.contains("Ask the course"), "{page}");
    let made = session.post_json("/api/v1/tokens", r#"{"name": "tests"}"#).expect(201).json();
    let token = made["token"].as_str().expect("a token");
    let admin = server.with_token(token);
    server.course(&admin, "physics");
    // The sign-in page leads to the requested page, and never to another server.
    let way = visitor.get("/c/physics/a/m1?x=1").expect(303).header("location").expect("a place").to_owned();
    assert_eq!(way, "/sign-in?to=%2Fc%2Fphysics%2Fa%2Fm1%3Fx%3D1");
    let page = visitor.get(&way).expect(200).text();
    assert!(page.contains("name=\"to\" value=\"/c/physics/a/m1?x=1\""), "{page}");
    for (to, place) in [("/c/physics/a/m1?x=1", "/c/physics/a/m1?x=1"), ("//evil.example", "/"), ("", "/")] {
        let answer = visitor.post_form("/sign-in", &format!("to={to}&token={token}")).expect(303);
        assert_eq!(answer.header("location"), Some(place));
    }
    // Forms that a session from a token may not send are not shown.
    let page = admin.get("/account").expect(200).text();
    assert!(page.contains("You signed in with a token") && !page.contains("Create a token"), "{page}");
    assert!(session.get("/account").expect(200).text().contains("Create a token"));
    // Rejections are pages for browsers, and JSON for programs.
    let html = ("Accept", "text/html,*/*;q=0.8");
    let page = visitor.send("POST", "/sign-out", &[html, ("Sec-Fetch-Site", "cross-site")], b"").expect(403).text();
    assert!(page.contains("<h1>Sent from another site"), "{page}");
    let answer = admin.send("PATCH", ASSIGNMENT, JSON, b"{}").expect(405);
    assert_eq!(answer.json()["type"], "urn:fosssim:wrong-method");
    assert!(answer.header("allow").is_some_and(|allow| allow.contains("PUT")), "{:?}", answer.headers);
    for number in ["abc", "999999999999999999999999"] {
        assert!(admin.get(&format!("/c/physics/s/{number}")).expect(404).text().contains("no such submission"));
    }
    let export = admin.get(&format!("{ASSIGNMENT}/export?format=jsonl")).expect(200);
    assert_eq!(export.header("content-disposition"), Some("attachment; filename=\"physics-m1.jsonl\""));
    let long = visitor.post_form("/sign-in", &format!("token={}", "x".repeat(100_000))).expect(413).text();
    assert!(!long.contains("build folders"), "{long}");
}

async fn numbers_and_staff_are_kept(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let ada = server.member(&admin, "physics", "ada", "student");
    ada.submit("physics", &program("AC", 1));
    let second = ada.submit("physics", &program("AC", 2));
    let place = |id: i64| format!("/api/v1/courses/physics/submissions/{id}");
    teacher.send("DELETE", &place(second), &[], b"").expect(204);
    let third = ada.submit("physics", &program("AC", 3));
    assert_eq!(ada.get(&place(third)).expect(200).json()["number"], 3, "a number is given out once");
    // Only an administrator can remove the last member of staff.
    let members = "/api/v1/courses/physics/members";
    let wish = |name: &str, role: &str| format!(r#"{{"name": "{name}", "role": "{role}"}}"#);
    let change = |by: &Client, body: &str| by.send("PUT", &format!("{members}/teacher"), JSON, body.as_bytes());
    change(&teacher, &wish("T", "student")).expect(409);
    let csv = [("Content-Type", "text/csv")];
    let imported = teacher.send("POST", members, &csv, b"name,login,role\nT,teacher,student\n").expect(200);
    assert!(imported.json()[0]["error"].is_string(), "the line says why nobody was imported");
    teacher.send("DELETE", &format!("{members}/teacher"), &[], b"").expect(409);
    teacher.get("/c/physics/members").expect(200);
    let colleague = server.member(&admin, "physics", "colleague", "staff");
    change(&teacher, &wish("T", "student")).expect(200);
    colleague.send("DELETE", &format!("{members}/colleague"), &[], b"").expect(409);
    admin.send("DELETE", &format!("{members}/colleague"), &[], b"").expect(204);
    // Names with characters that change the direction of the text.
    for name in ["a\u{202e}b", "a\u{2066}b", "a\u{200b}b", "ab\u{feff}"] {
        admin.send("PUT", &format!("{members}/eve"), JSON, wish(name, "student").as_bytes()).expect(400);
    }
    admin.send("DELETE", "/api/v1/accounts/ada/data", &[], b"").expect(204);
}

async fn own_work_on_a_hidden_assignment_stays(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let id = ada.submit("physics", &program("WA", 40));
    ada.wait_for_grade("physics", id);
    set(&admin, false, "{}");
    ada.get("/c/physics/a/m1").expect(404);
    ada.get(&format!("/api/v1/courses/physics/submissions/{id}")).expect(200);
    let page = ada.get(&format!("/c/physics/s/{id}")).expect(200).text();
    assert!(page.contains("40 of 100 points") && !page.contains("/c/physics/a/m1"), "{page}");
}
