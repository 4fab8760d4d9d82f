//! Staff hears that the reference may be wrong before students do.
use crate::support::{
    engines::{Fresh, on_both_engines},
    server::{Client, Server},
};

on_both_engines!(staff_is_told_when_many_agree_on_another_answer);

/// A program that is wrong in one scene, and right for this many steps of it.
fn answering(scene: &str, right_steps: u32) -> Vec<u8> {
    format!("#!grade WA 50 {scene} {right_steps}\n").into_bytes()
}

async fn staff_is_told_when_many_agree_on_another_answer(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let students: Vec<Client> =
        (0..7).map(|number| server.member(&admin, "physics", &format!("student{number}"), "student")).collect();
    let hand_in = |student: &Client, program: &[u8]| {
        let id = student.submit("physics", program);
        student.wait_for_grade("physics", id);
        id
    };
    let base = "/api/v1/courses/physics/assignments/m1/suspicions";
    let suspicions = || teacher.get(base).expect(200).json().as_array().expect("a list").clone();
    // Four are right, and two agree on something else: too few to be more than a coincidence.
    for student in &students[..4] {
        hand_in(student, b"#!grade AC 100\n");
    }
    hand_in(&students[4], &answering("Group/hard", 12));
    hand_in(&students[5], &answering("Group/hard", 12));
    // One student counts once, however often they hand in, and staff that tries something out does not.
    let agreeing = hand_in(&students[5], &answering("Group/hard", 12));
    hand_in(&teacher, &answering("Group/hard", 12));
    assert_eq!(suspicions(), Vec::<serde_json::Value>::new());
    // A student who answers something else, or whose program crashes, does not agree.
    hand_in(&students[6], &answering("Group/hard", 13));
    hand_in(&students[6], b"#!grade RTE 0 Group/hard 12\n");
    assert!(suspicions().is_empty());
    // The third who agrees, of seven who are right otherwise.
    hand_in(&students[6], &answering("Group/hard", 12));
    let found = suspicions();
    assert_eq!(found.len(), 1, "{found:?}");
    assert_eq!([&found[0]["scene"], &found[0]["state"]], ["Group/hard", "open"]);
    assert_eq!([&found[0]["agreeing"], &found[0]["nearly_right"]], [3, 7]);
    assert_eq!(found[0]["logins"], serde_json::json!(["student4", "student5", "student6"]));
    let audit = teacher.get("/api/v1/courses/physics/audit").expect(200).text();
    assert!(audit.contains("reference suspected") && audit.contains("3 of 7 students"), "{audit}");
    let page = teacher.get("/c/physics/a/m1/class").expect(200).text();
    assert!(page.contains("Is the reference wrong?") && page.contains("Group/hard"), "{page}");
    let metrics = server.visitor().get("/metrics").expect(200).text();
    assert!(metrics.contains("fosssim_suspicions 1"), "{metrics}");
    // Students see nothing of it until staff says so.
    let seen = || students[5].get(&format!("/c/physics/s/{agreeing}")).expect(200).text();
    assert!(!seen().contains("may be wrong"), "{}", seen());
    let events = students[5].get(&format!("/api/v1/courses/physics/submissions/{agreeing}")).expect(200).text();
    assert!(!events.contains("wrong_scene") && !events.contains("answer"), "{events}");
    let id = &found[0]["id"];
    students[5].post_json(&format!("{base}/{id}/tell"), "").expect(403);
    teacher.post_json(&format!("{base}/{id}/tell"), "").expect(204);
    assert!(seen().contains("looks into Group/hard: the reference may be wrong there"), "{}", seen());
    let other = students[0].get("/api/v1/courses/physics/assignments/m1/submissions").expect(200).json();
    let other = students[0].get(&format!("/c/physics/s/{}", other[0]["id"])).expect(200).text();
    assert!(!other.contains("may be wrong"), "{other}");
    // The reference is right after all.
    teacher.post_form(&format!("/c/physics/a/m1/suspicions/{id}/dismiss"), "").expect(303);
    teacher.post_json(&format!("{base}/{id}/dismiss"), "").expect(204);
    assert!(!seen().contains("may be wrong"));
    assert_eq!(suspicions()[0]["state"], "dismissed");
    teacher.post_json(&format!("{base}/999/dismiss"), "").expect(404);
}
