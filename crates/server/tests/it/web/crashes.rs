//! Tests that deaths of servers and workers do no harm to a good submission.
use crate::support::{
    engines::{Fresh, on_both_engines},
    server::{Server, program},
};
use std::time::{Duration, Instant};

on_both_engines!(a_crash_loop_buries_nothing, a_token_claims_as_much_as_its_workers_have_slots);

async fn a_crash_loop_buries_nothing(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "2", "--lease", "2", "--tries", "2"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let id = ada.submit("physics", &program("SLOW", 90));
    let path = format!("/api/v1/courses/physics/submissions/{id}");
    for crash in 0..8 {
        let start = Instant::now();
        while ada.get(&path).expect(200).json()["state"] != "running" {
            assert!(start.elapsed() < Duration::from_secs(60), "crash {crash}: {}", ada.get(&path).text());
            std::thread::sleep(Duration::from_millis(10));
        }
        server.kill();
        server.resume();
    }
    std::fs::write(server.grader().with_extension("mended"), b"").expect("the sign");
    assert_eq!(ada.wait_for_grade("physics", id)["grade"]["points"], "90");
}

async fn a_token_claims_as_much_as_its_workers_have_slots(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    for points in 0..8 {
        ada.submit("physics", &program("AC", points));
    }
    let token = |name: &str| {
        let token = admin.post_json("/api/v1/worker-tokens", &format!(r#"{{"name": "{name}"}}"#)).expect(201).json();
        server.with_token(token["token"].as_str().expect("a token"))
    };
    let (one, other) = (token("one"), token("other"));
    one.post_json("/api/v1/worker/tick", r#"{"slots": 3}"#).expect(200);
    let leases: Vec<_> = (0..8)
        .map(|_| one.post_json("/api/v1/worker/claim", "{}"))
        .filter(|answer| answer.status == 200)
        .map(|answer| answer.json()["lease"].clone())
        .collect();
    assert_eq!(leases.len(), 3);
    // A lease belongs to the token that claimed it.
    let lease = leases[0].to_string();
    assert_eq!(other.post_json("/api/v1/worker/renew", &lease).expect(200).json()["held"], false);
    let finish = |points: &str, most: &str| {
        format!(
            r#"{{"lease": {lease}, "outcome": {{"verdict": "w", "code": "AC", "points": "{points}",
                "max_points": "{most}", "summary": "s", "version": "1", "seconds": "1", "files": []}}}}"#
        )
    };
    assert_eq!(other.post_json("/api/v1/worker/finish", &finish("1", "100")).expect(200).json()["held"], false);
    for (points, most) in [("1e300", "100"), ("-5", "100"), ("101", "100"), ("1e300", "1e301")] {
        one.post_json("/api/v1/worker/finish", &finish(points, most)).expect(400);
    }
    assert_eq!(one.post_json("/api/v1/worker/renew", &lease).expect(200).json()["held"], true);
    assert_eq!(one.post_json("/api/v1/worker/finish", &finish("99.5", "100")).expect(200).json()["held"], true);
    one.post_json("/api/v1/worker/claim", "{}").expect(200);
    one.post_json("/api/v1/worker/claim", "{}").expect(204);
    other.post_json("/api/v1/worker/claim", "{}").expect(200);
}
