//! Tests submissions on which the grader fails: the texts that students read, and a new grading by staff.
use crate::support::{
    engines::{Fresh, on_both_engines, run},
    server::{Client, JSON, Server, program},
};
use std::{
    fs,
    time::{Duration, Instant},
};

on_both_engines!(staff_has_it_graded_again, a_student_sees_how_far_the_grading_is,);

fn wait_for_state(client: &Client, id: i64, wanted: impl Fn(&serde_json::Value) -> bool) -> serde_json::Value {
    let start = Instant::now();
    loop {
        let submission = client.get(&format!("/api/v1/courses/physics/submissions/{id}")).expect(200).json();
        if wanted(&submission) {
            return submission;
        }
        assert!(start.elapsed() < Duration::from_secs(120), "{submission}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

async fn staff_has_it_graded_again(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1", "--lease", "2", "--tries", "2"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let (ada, bob) =
        (server.member(&admin, "physics", "ada", "student"), server.member(&admin, "physics", "bob", "student"));
    let right = ada.submit("physics", &program("AC", 100));
    ada.wait_for_grade("physics", right);
    let ids = [ada.submit("physics", &program("FAIL", 30)), bob.submit("physics", &program("FAIL", 40))];
    for (client, id) in [(&ada, ids[0]), (&bob, ids[1])] {
        let submission = wait_for_state(client, id, |submission| submission["state"] == "buried");
        assert_eq!(submission["grade"]["code"], "JE");
        let page = client.get(&format!("/c/physics/s/{id}")).expect(200).text();
        let summary = submission["grade"]["summary"].as_str().expect("a sentence");
        assert!(summary.contains("not the submission's fault"), "{summary}");
        for text in [submission.to_string(), page] {
            assert!(!text.contains("secret") && !text.contains("suite.toml"), "{text}");
        }
        let seen = admin.get(&format!("/api/v1/courses/physics/submissions/{id}")).expect(200).json();
        let fault = seen["fault"].as_str().expect("staff get a reason");
        assert!(fault.contains("suite.toml:5:9: a secret of the machine") && !fault.contains('/'), "{fault}");
    }
    let metrics = server.visitor().get("/metrics").expect(200).text();
    assert!(metrics.contains("fosssim_events_total{kind=\"graded\"} 1\n"), "{metrics}");
    let queue = admin.get("/api/v1/queue").expect(200).json();
    assert_eq!(queue["workers"][0]["faults"], 4, "{queue}");
    fs::write(server.grader().with_extension("mended"), "").expect("a file");
    let again = format!("/api/v1/courses/physics/submissions/{}/again", ids[0]);
    assert_eq!(admin.post_json(&again, "").expect(202).json()["jobs"], 1);
    let graded = |client: &Client, id| {
        wait_for_state(client, id, |submission| submission["state"] == "done")["grade"]["points"].clone()
    };
    assert_eq!(graded(&ada, ids[0]), "30");
    let all = "/api/v1/courses/physics/assignments/m1/judge-errors/again";
    assert_eq!(admin.post_json(all, "").expect(202).json()["jobs"], 1, "only what the grader failed on");
    assert_eq!(graded(&bob, ids[1]), "40");
    assert_eq!(admin.post_json("/api/v1/courses/physics/judge-errors/again", "").expect(202).json()["jobs"], 0);
    let history = ada.get(&format!("/api/v1/courses/physics/submissions/{}/history", ids[0])).expect(200).json();
    let reasons: Vec<_> = history.as_array().expect("a list").iter().map(|change| change["reason"].clone()).collect();
    assert_eq!(reasons, ["graded", "graded again"]);
    assert_eq!([&history[0]["by"], &history[1]["by"]], [&serde_json::Value::Null, &"admin".into()]);
    let own = ada.get("/api/v1/courses/physics/assignments/m1/submissions").expect(200).json();
    assert_eq!(own.as_array().expect("a list").len(), 2, "a submission is one, however often it is graded");
    assert_eq!(admin.get("/api/v1/queue").expect(200).json()["buried"], 0);
}

#[test]
fn a_suite_that_can_t_work_is_refused() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite");
        let mut server = Server::start(&fresh, &["--workers", "0"]);
        let admin = server.admin();
        server.course(&admin, "physics");
        let path = "/api/v1/courses/physics/assignments/m1/suite";
        let suite = |text: &str| {
            let mut archive = tar::Builder::new(Vec::new());
            let mut header = tar::Header::new_ustar();
            header.set_size(text.len() as u64);
            header.set_mode(0o644);
            archive.append_data(&mut header, "suite.toml", text.as_bytes()).expect("an entry");
            archive.into_inner().expect("an archive")
        };
        let refused = admin.send("PUT", path, &[], &suite("title = 'broken'")).expect(422).json();
        assert_eq!(refused["detail"], "the suite has a problem: suite.toml:1:1: it is broken");
        let assignment = admin.get("/api/v1/courses/physics/assignments/m1").expect(200).json();
        assert!(assignment["settings"]["suite_archive"].is_null(), "{assignment}");
        admin.send("PUT", path, &[], &suite("title = 'whole'")).expect(200);
        let audit = admin.get("/api/v1/courses/physics/audit").expect(200).text();
        let course = admin.get("/api/v1/courses/physics/audit?who=M1+&kind=assignment").expect(200).json();
        assert_eq!(course[0]["kind"], "assignment", "{course}");
        for other in ["who=nobody", "kind=member&who=m1", "before=1"] {
            let none = admin.get(&format!("/api/v1/courses/physics/audit?{other}")).expect(200).json();
            assert_eq!(none.as_array().map(Vec::len), Some(0), "{other}: {none}");
        }
        assert!(
            audit.contains("m1 (Milestone one), visible: uploaded suite \\\"") && !audit.contains("largest upload"),
            "{audit}"
        );
        // A single file is packed into an archive.
        admin.send("PUT", path, &[], b"title = 'alone'\n").expect(200);
        let refused = admin.send("PUT", path, &[], b"title = \n").expect(422).json();
        assert!(
            refused["detail"].as_str().is_some_and(|text| text.starts_with("suite.toml can't be read")),
            "{refused}"
        );
        admin.send("PUT", path, &[], &suite("title = 'whole'")).expect(200);
        // A rejection has the frame of its assignment, and links back to the form.
        let form = [
            ("Content-Type", "multipart/form-data; boundary=b"),
            ("Sec-Fetch-Site", "same-origin"),
            ("Referer", "https://grades.example.org/c/physics/a/m1/settings?x=1"),
        ];
        let file = b"--b\r\nContent-Disposition: form-data; name=\"file\"; filename=\"s\"\r\n\r\nx\r\n--b--\r\n";
        let page = admin.send("POST", "/c/physics/a/m1/suite", &form, file).expect(422).text();
        assert!(
            page.contains("href=\"/c/physics/a/m1/settings?x=1\" data-back>Back") && page.contains(">Milestone one<"),
            "{page}"
        );
        // The new suite's hidden groups are not those that were published.
        let published =
            || admin.get("/api/v1/courses/physics/assignments/m1").expect(200).json()["published_at"].clone();
        admin.send("PUT", "/api/v1/courses/physics/assignments/m1/published", &[], b"").expect(200);
        admin.send("PUT", path, &[], &suite("[[group]]\nvisibility = 'visible'")).expect(200);
        assert!(published().is_i64(), "it hides nothing");
        admin.send("PUT", path, &[], &suite("[[group]]\nvisibility = 'hidden'")).expect(200);
        assert!(published().is_null());
        // It is not known yet whether a named suite hides groups.
        for (change, remains) in [("another suite", false), ("the same suite", true)] {
            admin.send("PUT", "/api/v1/courses/physics/assignments/m1/published", &[], b"").expect(200);
            let named = br#"{"title": "Milestone one", "settings": {"suite": "course-2027"}}"#;
            admin.send("PUT", "/api/v1/courses/physics/assignments/m1", JSON, named).expect(200);
            assert_eq!(published().is_i64(), remains, "{change}");
        }
        let audit = admin.get("/api/v1/courses/physics/audit").expect(200).text();
        assert!(audit.contains("; withheld hidden groups"), "{audit}");
    });
}

async fn a_student_sees_how_far_the_grading_is(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let id = ada.submit("physics", &program("SLOW", 90));
    let running = wait_for_state(&ada, id, |submission| submission["progress"].is_object());
    assert_eq!(running["progress"], serde_json::json!({"done": 3, "all": 85}));
    let page = ada.get(&format!("/c/physics/s/{id}")).expect(200).text();
    assert!(page.contains("being graded, 3 of 85 scenes done"), "{page}");
    fs::write(server.grader().with_extension("mended"), "").expect("a file");
    assert!(ada.wait_for_grade("physics", id)["progress"].is_null(), "it is graded");
}
