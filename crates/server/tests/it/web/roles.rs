//! Tests every route with every role: which requests are accepted, and which status rejections have.
use crate::support::{
    engines::{Fresh, run},
    server::{Client, JSON, Server, program},
};
use fosssim_server::web;
use std::collections::BTreeSet;

/// The senders that a route serves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum For {
    /// All senders.
    All,
    /// All people who are signed in.
    People,
    /// Members of the course.
    Members,
    /// The owner of the submission and the course's staff.
    Owner,
    /// The course's staff.
    Staff,
    /// Administrators.
    Admins,
    /// Workers.
    Workers,
}
use For::{Admins, All, Members, Owner, People, Staff, Workers};

/// Every route, by its template. [`fill`] replaces the parts in braces.
pub(super) const ROUTES: &[(&str, &str, For)] = &[
    ("get", "/health", All),
    ("get", "/ready", All),
    ("get", "/metrics", All),
    ("get", "/api/openapi.json", All),
    ("get", "/api/v1/me", People),
    ("get", "/api/v1/tokens", People),
    ("post", "/api/v1/tokens", People),
    ("delete", "/api/v1/tokens/{id}", People),
    ("get", "/api/v1/accounts", Admins),
    ("put", "/api/v1/accounts/{login}", Admins),
    ("delete", "/api/v1/accounts/{login}", Admins),
    ("get", "/api/v1/worker-tokens", Admins),
    ("post", "/api/v1/worker-tokens", Admins),
    ("delete", "/api/v1/worker-tokens/{id}", Admins),
    ("get", "/api/v1/queue", Admins),
    ("get", "/api/v1/audit", Admins),
    ("get", "/api/v1/platforms", Admins),
    ("put", "/api/v1/platforms/{name}", Admins),
    ("delete", "/api/v1/platforms/{name}", Admins),
    ("post", "/api/v1/platform-keys", Admins),
    ("post", "/api/v1/courses/{course}/roster", Staff),
    ("get", "/api/v1/courses/{course}/assignments/{assignment}/scores", Staff),
    ("post", "/api/v1/courses/{course}/assignments/{assignment}/scores", Staff),
    ("get", "/api/v1/courses", People),
    ("post", "/api/v1/courses", Admins),
    ("get", "/api/v1/courses/{course}/members", Staff),
    ("put", "/api/v1/courses/{course}/members/{login}", Staff),
    ("delete", "/api/v1/courses/{course}/members/{login}", Staff),
    ("post", "/api/v1/courses/{course}/members/{login}/link", Staff),
    ("get", "/api/v1/courses/{course}/audit", Staff),
    ("get", "/api/v1/courses/{course}/assignments", Members),
    ("get", "/api/v1/courses/{course}/assignments/{assignment}", Members),
    ("put", "/api/v1/courses/{course}/assignments/{assignment}", Staff),
    ("put", "/api/v1/courses/{course}/assignments/{assignment}/suite", Staff),
    ("put", "/api/v1/courses/{course}/assignments/{assignment}/published", Staff),
    ("delete", "/api/v1/courses/{course}/assignments/{assignment}/published", Staff),
    ("post", "/c/{course}/a/{assignment}/publish", Staff),
    ("post", "/c/{course}/a/{assignment}/withhold", Staff),
    ("get", "/api/v1/courses/{course}/assignments/{assignment}/class", Staff),
    ("get", "/api/v1/courses/{course}/assignments/{assignment}/export", Staff),
    ("get", "/api/v1/courses/{course}/assignments/{assignment}/submissions", Members),
    ("post", "/api/v1/courses/{course}/assignments/{assignment}/submissions", Members),
    ("get", "/api/v1/courses/{course}/submissions/{id}", Owner),
    ("get", "/api/v1/courses/{course}/submissions/{id}/history", Owner),
    ("get", "/api/v1/courses/{course}/submissions/{id}/files/{name}", Owner),
    ("get", "/api/v1/courses/{course}/submissions/{id}/upload", Owner),
    ("post", "/api/v1/courses/{course}/submissions/{id}/again", Staff),
    ("post", "/api/v1/courses/{course}/assignments/{assignment}/judge-errors/again", Staff),
    ("post", "/api/v1/courses/{course}/judge-errors/again", Staff),
    ("get", "/api/v1/courses/{course}/assignments/{assignment}/regrades", Staff),
    ("post", "/api/v1/courses/{course}/assignments/{assignment}/regrades", Staff),
    ("get", "/api/v1/courses/{course}/assignments/{assignment}/regrades/{id}", Staff),
    ("post", "/api/v1/courses/{course}/assignments/{assignment}/regrades/{id}/apply", Staff),
    ("post", "/api/v1/courses/{course}/assignments/{assignment}/regrades/{id}/discard", Staff),
    ("post", "/api/v1/worker/tick", Workers),
    ("post", "/api/v1/worker/claim", Workers),
    ("post", "/api/v1/worker/renew", Workers),
    ("post", "/api/v1/worker/release", Workers),
    ("post", "/api/v1/worker/fail", Workers),
    ("post", "/api/v1/worker/finish", Workers),
    ("get", "/api/v1/worker/files/{digest}", Workers),
    ("put", "/api/v1/worker/files/{digest}", Workers),
    ("get", "/", People),
    ("get", "/sign-in", All),
    ("post", "/sign-in", All),
    ("get", "/sign-in/provider", All),
    ("get", "/sign-in/provider/answer", All),
    ("get", "/welcome/{secret}", All),
    ("post", "/welcome/{secret}", All),
    ("post", "/sign-out", All),
    ("post", "/api/v1/courses/{course}/members", Staff),
    ("put", "/api/v1/courses/{course}/submissions/{id}/mark", Staff),
    ("post", "/api/v1/courses/{course}/submissions/{id}/request", Members),
    ("put", "/api/v1/courses/{course}/assignments/{assignment}/extensions/{login}", Staff),
    ("delete", "/api/v1/courses/{course}/assignments/{assignment}/extensions/{login}", Staff),
    ("get", "/c/{course}/members/import", Staff),
    ("post", "/c/{course}/members/import", Staff),
    ("post", "/c/{course}/members/table", Staff),
    ("get", "/c/{course}/a/{assignment}/students/{login}", Staff),
    ("post", "/c/{course}/a/{assignment}/students/{login}/extension", Staff),
    ("post", "/c/{course}/s/{id}/mark", Staff),
    ("post", "/c/{course}/s/{id}/request", Members),
    ("delete", "/api/v1/courses/{course}", Admins),
    ("delete", "/api/v1/courses/{course}/assignments/{assignment}", Staff),
    ("delete", "/api/v1/courses/{course}/submissions/{id}", Staff),
    ("delete", "/api/v1/accounts/{login}/data", Admins),
    ("post", "/admin/accounts/{login}/remove", Admins),
    ("post", "/admin/accounts/{login}/shut", Admins),
    ("post", "/c/{course}/remove", Admins),
    ("post", "/c/{course}/members/{login}/remove", Staff),
    ("post", "/c/{course}/a/{assignment}/remove", Staff),
    ("post", "/c/{course}/s/{id}/remove", Staff),
    ("get", "/account", People),
    ("get", "/account/provider", People),
    ("post", "/account/provider/remove", People),
    ("post", "/account/tokens", People),
    ("post", "/account/tokens/{id}/revoke", People),
    ("get", "/admin", Admins),
    ("get", "/admin/people", Admins),
    ("get", "/admin/platforms", Admins),
    ("get", "/admin/workers", Admins),
    ("get", "/admin/log", Admins),
    ("post", "/admin/courses", Admins),
    ("post", "/admin/accounts", Admins),
    ("post", "/admin/workers", Admins),
    ("post", "/admin/workers/{id}/revoke", Admins),
    ("post", "/admin/platforms", Admins),
    ("post", "/admin/platforms/{name}/shut", Admins),
    ("post", "/admin/platform-keys", Admins),
    ("get", "/lti/login", All),
    ("post", "/lti/login", All),
    ("post", "/lti/launch", All),
    ("get", "/lti/keys.json", All),
    ("get", "/lti/configuration.json", All),
    ("get", "/lti/choose/{secret}", People),
    ("post", "/lti/choose/{secret}/course", People),
    ("post", "/lti/choose/{secret}/assignment", People),
    ("post", "/c/{course}/members/roster", Staff),
    ("post", "/c/{course}/a/{assignment}/scores", Staff),
    ("get", "/c/{course}", Members),
    ("post", "/c/{course}/assignments", Staff),
    ("get", "/c/{course}/members", Staff),
    ("post", "/c/{course}/members", Staff),
    ("post", "/c/{course}/members/{login}/link", Staff),
    ("get", "/c/{course}/audit", Staff),
    ("get", "/c/{course}/queue", Staff),
    ("get", "/c/{course}/a/{assignment}", Members),
    ("post", "/c/{course}/a/{assignment}", Members),
    ("get", "/c/{course}/a/{assignment}/settings", Staff),
    ("post", "/c/{course}/a/{assignment}/settings", Staff),
    ("post", "/c/{course}/a/{assignment}/suite", Staff),
    ("get", "/c/{course}/a/{assignment}/class", Staff),
    ("post", "/c/{course}/a/{assignment}/judge-errors", Staff),
    ("post", "/c/{course}/s/{id}/again", Staff),
    ("post", "/c/{course}/a/{assignment}/regrades", Staff),
    ("get", "/c/{course}/a/{assignment}/regrades/{id}", Staff),
    ("post", "/c/{course}/a/{assignment}/regrades/{id}/newcomers", Staff),
    ("post", "/c/{course}/a/{assignment}/regrades/{id}/apply", Staff),
    ("post", "/c/{course}/a/{assignment}/regrades/{id}/discard", Staff),
    ("get", "/c/{course}/s/{id}/beside", Staff),
    ("get", "/c/{course}/s/{id}", Owner),
    ("get", "/check", All),
    ("get", "/static/style.css", All),
    ("get", "/static/page.js", All),
    ("get", "/static/report.js", All),
];

/// The roles of senders.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    Visitor,
    Owner,
    Classmate,
    OtherStudent,
    Staff,
    OtherStaff,
    Admin,
    Worker,
}

/// Returns the path to the submission of `owner`. Other objects in the path do not exist, so that an accepted request
/// changes nothing.
fn fill(method: &str, path: &str, submission: i64) -> String {
    let is_there = path.contains("submissions/{id}") || path.contains("/s/{id}");
    let id = if is_there && method != "delete" { submission } else { 999_999 };
    path.replace("{course}", "physics")
        .replace(
            "{assignment}",
            if path.contains("/submissions") || path.ends_with("/a/{assignment}") { "m1" } else { "none" },
        )
        .replace("{id}", &id.to_string())
        .replace("{login}", "nobody.here")
        .replace("{name}", "report.txt")
        .replace("{secret}", "0123")
        .replace("{digest}", &"0".repeat(64))
}

/// Returns the expected status of a rejection; `None` if the request is accepted.
fn expected(role: Role, whom: For) -> Option<u16> {
    let signed_in = !matches!(role, Role::Visitor | Role::Worker);
    let of_course = matches!(role, Role::Owner | Role::Classmate | Role::Staff | Role::Admin);
    let staff = matches!(role, Role::Staff | Role::Admin);
    match whom {
        For::All => None,
        For::Workers => (role != Role::Worker).then_some(401),
        _ if !signed_in => Some(401),
        For::People => None,
        For::Admins => (role != Role::Admin).then_some(403),
        // Another person's course looks like a missing one.
        _ if !of_course => Some(404),
        For::Members => None,
        For::Staff => (!staff).then_some(403),
        For::Owner => (role == Role::Classmate).then_some(404),
    }
}

/// Requests a course's objects by the address of another course, as its staff. Returns the answers that reveal them.
fn found_elsewhere(clients: &[(Role, Client)], submission: i64) -> Vec<String> {
    let mut wrong = Vec::new();
    let by_name = |name: Role| clients.iter().find(|(role, _)| *role == name).map(|(_, client)| client);
    let (teacher, colleague) = (by_name(Role::Staff).expect("one"), by_name(Role::OtherStaff).expect("one"));
    let regrades = "/api/v1/courses/physics/assignments/m1/regrades";
    let regrade = teacher.post_json(regrades, r#"{"reason": "to see"}"#).expect(201).json()["id"].to_string();
    let of_objects = ROUTES.iter().filter(|(_, path, _)| path.contains("{course}") && path.contains("{id}"));
    for (method, path, _) in of_objects {
        let page = !path.starts_with("/api");
        let asked = fill("get", path, submission).replace("physics", "other").replace("/none/", "/m1/");
        let asked = asked.replace("999999", &regrade);
        let form =
            if path.ends_with("/request") { "text=x".to_owned() } else { format!("comment=x&confirm={submission}") };
        let (headers, body) = match () {
            () if page => ("application/x-www-form-urlencoded", form.as_str()),
            () if path.ends_with("/mark") => (JSON[0].1, r#"{"comment": "x"}"#),
            () => (JSON[0].1, r#"{"text": "x"}"#),
        };
        let headers = [("Content-Type", headers), ("Sec-Fetch-Site", "same-origin")];
        let answer = colleague.send(&method.to_uppercase(), &asked, &headers, body.as_bytes());
        if answer.status != 404 || answer.text().contains("owner") {
            wrong.push(format!("{method} {asked}: {} {}", answer.status, answer.text()));
        }
    }
    teacher.get(&format!("/api/v1/courses/physics/submissions/{submission}")).expect(200);
    wrong
}

#[test]
fn every_route_serves_whom_it_should_and_nobody_else() {
    run(async {
        let fresh = match Fresh::postgres().await {
            Some(fresh) => fresh.with_tables().await,
            None => Fresh::sqlite().await.expect("SQLite"),
        };
        let mut server = Server::start(&fresh, &["--workers", "1", "--requests-per-minute", "100000"]);
        let admin = server.admin();
        server.course(&admin, "physics");
        server.course(&admin, "other");
        let owner = server.member(&admin, "physics", "owner", "student");
        let submission = owner.submit("physics", &program("AC", 1));
        owner.wait_for_grade("physics", submission);
        let token = admin.post_json("/api/v1/worker-tokens", r#"{"name": "machine"}"#).expect(201).json();
        let worker = server.with_token(token["token"].as_str().expect("a token"));
        let clients: Vec<(Role, Client)> = vec![
            (Role::Visitor, server.visitor()),
            (Role::Owner, owner),
            (Role::Classmate, server.member(&admin, "physics", "mate", "student")),
            (Role::OtherStudent, server.member(&admin, "other", "guest", "student")),
            (Role::Staff, server.member(&admin, "physics", "teacher", "staff")),
            (Role::OtherStaff, server.member(&admin, "other", "colleague", "staff")),
            (Role::Admin, admin),
            (Role::Worker, worker),
        ];
        let mut wrong = Vec::new();
        for (method, path, whom) in ROUTES {
            for (role, client) in &clients {
                let page = !path.starts_with("/api") && !path.ends_with("/health");
                // The body is never valid. People with the right get that answer, and no data changes.
                let headers: &[(&str, &str)] = if page {
                    &[("Content-Type", "application/x-www-form-urlencoded"), ("Sec-Fetch-Site", "same-origin")]
                } else if path.ends_with("/submissions") || path.ends_with("/suite") {
                    &[("Sec-Fetch-Site", "same-origin")]
                } else {
                    &[JSON[0], ("Sec-Fetch-Site", "same-origin")]
                };
                let answer = client.send(&method.to_uppercase(), &fill(method, path, submission), headers, b"%");
                let refused = expected(*role, *whom);
                let right = match refused {
                    // A page redirects to the sign-in page instead.
                    Some(401) if page && *method == "get" => {
                        answer.header("location").is_some_and(|place| place.starts_with("/sign-in"))
                    }
                    Some(status) => answer.status == status,
                    // Accepted senders get an error about a missing object or an invalid request.
                    None if *method == "get" => matches!(answer.status, 200 | 400 | 404),
                    None => !matches!(answer.status, 403 | 500..),
                };
                // An error about the body, or about a missing object, must not reveal data. The head of a page names
                // the person who is signed in.
                let own = if matches!(role, Role::Owner) { "/account\">owner<" } else { "nobody" };
                let leaks = refused.is_some() && answer.text().replace(own, "").contains("owner");
                if !right || leaks {
                    wrong.push(format!("{role:?} {method} {path}: {} {}", answer.status, answer.text()));
                }
            }
        }
        wrong.extend(found_elsewhere(&clients, submission));
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    });
}

#[test]
fn every_route_is_in_the_table() {
    let listed: BTreeSet<(String, String)> =
        ROUTES.iter().map(|(method, path, _)| ((*method).to_owned(), (*path).to_owned())).collect();
    assert_eq!(listed.len(), ROUTES.len());
    let document: serde_json::Value = serde_json::from_str(&web::openapi()).expect("JSON");
    let mut served: BTreeSet<(String, String)> =
        web::pages::PAGES.iter().map(|(method, path)| ((*method).to_owned(), (*path).to_owned())).collect();
    for (path, methods) in document["paths"].as_object().expect("paths") {
        for method in methods.as_object().expect("methods").keys() {
            served.insert((method.clone(), path.clone()));
        }
    }
    assert_eq!(listed, served);
}

#[test]
fn the_committed_description_is_the_served_one() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../schemas/service.openapi.json");
    let committed = std::fs::read_to_string(file).unwrap_or_default();
    assert!(
        committed == web::openapi(),
        "the API has changed: cargo run -p fosssim-server -- openapi > schemas/service.openapi.json"
    );
}
