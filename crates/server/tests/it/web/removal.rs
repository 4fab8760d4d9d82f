//! Tests that a removal deletes all data of the removed thing, and does not disturb running work.
use crate::support::{
    engines::{Fresh, on_both_engines},
    server::{Client, Server, program},
};

on_both_engines!(what_is_removed_is_gone, a_person_is_removed_by_name_too, a_job_of_what_is_removed_ends_without_harm);

/// Returns the numbers of rows about submissions.
async fn rows(fresh: &Fresh) -> Vec<i64> {
    let mut transaction = fresh.database.read().await.expect("a transaction");
    let mut counts = Vec::new();
    for statement in [
        "SELECT count(*) AS n FROM submission",
        "SELECT count(*) AS n FROM job WHERE submission IS NOT NULL",
        "SELECT count(*) AS n FROM result",
        "SELECT count(*) AS n FROM result_file",
        "SELECT count(*) AS n FROM grade",
        "SELECT count(*) AS n FROM grade_change",
        "SELECT count(*) AS n FROM event WHERE submission IS NOT NULL",
    ] {
        counts.push(transaction.one(statement, &[]).await.expect("a row").int("n").expect("a number"));
    }
    counts
}

async fn what_is_removed_is_gone(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let ada = server.member(&admin, "physics", "ada", "student");
    let ids: Vec<i64> = (0..3).map(|points| ada.submit("physics", &program("WA", points))).collect();
    for id in &ids {
        ada.wait_for_grade("physics", *id);
    }
    let regrade = "/api/v1/courses/physics/assignments/m1/regrades";
    let id = teacher.post_json(regrade, r#"{"reason": "again"}"#).expect(201).json()["id"].clone();
    while teacher.get(&format!("{regrade}/{id}")).expect(200).json()["left"] != 0 {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    teacher.post_json(&format!("{regrade}/{id}/apply"), "").expect(200);
    // A submission is removed on its page, whose form names it.
    let page = |by: &Client| by.get(&format!("/c/physics/s/{}", ids[0])).expect(200).text();
    assert!(page(&teacher).contains("permanently deleted") && !page(&ada).contains("permanently deleted"));
    teacher.post_form(&format!("/c/physics/s/{}/remove", ids[0]), &format!("confirm={}", ids[0])).expect(400);
    teacher.post_form(&format!("/c/physics/s/{}/remove", ids[0]), "confirm=ada").expect(303);
    ada.get(&format!("/api/v1/courses/physics/submissions/{}", ids[0])).expect(404);
    assert_eq!(ada.wait_for_grade("physics", ids[1])["grade"]["points"], "1", "others stay");
    teacher.send("DELETE", &format!("/api/v1/courses/physics/submissions/{}", ids[1]), &[], b"").expect(204);
    // An assignment, and a course.
    teacher.send("DELETE", "/api/v1/courses/physics/assignments/m1", &[], b"").expect(204);
    assert_eq!(rows(&fresh).await, [0; 7]);
    server.course(&admin, "other");
    let eve = server.member(&admin, "other", "eve", "student");
    let id = eve.submit("other", &program("WA", 3));
    eve.wait_for_grade("other", id);
    admin.send("DELETE", "/api/v1/courses/other?confirm=physics", &[], b"").expect(409);
    admin.send("DELETE", "/api/v1/courses/other?confirm=other", &[], b"").expect(204);
    assert_eq!(rows(&fresh).await, [0; 7]);
    eve.get("/api/v1/me").expect(200);
    eve.get("/c/other").expect(404);
    let audit = admin.get("/api/v1/audit").expect(200).text();
    assert!(
        audit.contains("a course with its assignments, submissions and members") && !audit.contains("eve"),
        "{audit}"
    );
}

async fn a_person_is_removed_by_name_too(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada.lovelace", "student");
    let id = ada.submit("physics", &program("WA", 3));
    ada.wait_for_grade("physics", id);
    assert!(admin.get("/admin/people").expect(200).text().contains("in all courses"));
    admin.send("DELETE", "/api/v1/accounts/admin/data", &[], b"").expect(409);
    admin.post_form("/admin/accounts/ada.lovelace/remove", "confirm=ada.lovelace").expect(303);
    ada.get("/api/v1/me").expect(401);
    admin.send("DELETE", "/api/v1/accounts/ada.lovelace/data", &[], b"").expect(404);
    assert_eq!(rows(&fresh).await, [0; 7]);
    for place in
        ["/api/v1/audit", "/api/v1/accounts", "/api/v1/courses/physics/members", "/api/v1/courses/physics/audit"]
    {
        let text = admin.get(place).expect(200).text();
        assert!(!text.contains("lovelace"), "{place}: {text}");
    }
    assert!(admin.get("/api/v1/audit").expect(200).text().contains("a person with all their data"));
    // A new person can get the login.
    let other = server.member(&admin, "physics", "ada.lovelace", "student");
    assert_eq!(
        other.get("/api/v1/courses/physics/assignments/m1/submissions").expect(200).json(),
        serde_json::json!([])
    );
}

async fn a_job_of_what_is_removed_ends_without_harm(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1", "--lease", "2"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let id = ada.submit("physics", b"#!grade HANG\n");
    while ada.get(&format!("/api/v1/courses/physics/submissions/{id}")).expect(200).json()["state"] != "running" {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    admin.send("DELETE", &format!("/api/v1/courses/physics/submissions/{id}"), &[], b"").expect(204);
    // The only worker is free again, long before that grading would have ended.
    let next = ada.submit("physics", &program("WA", 30));
    assert_eq!(ada.wait_for_grade("physics", next)["grade"]["points"], "30");
    assert_eq!(ada.wait_for_grade("physics", next)["number"], 2, "a number is given out once");
}
