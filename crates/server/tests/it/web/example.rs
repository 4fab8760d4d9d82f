//! Tests the example course that the README promises with two commands.
use crate::support::{
    engines::{Fresh, on_sqlite},
    server::Server,
};
use std::os::unix::fs::PermissionsExt;

on_sqlite!(two_commands_and_an_upload, a_real_server_is_no_example);

async fn two_commands_and_an_upload(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1", "--example"]);
    let (admin, student, flawed) = (server.first_link(), server.first_link(), server.next_word());
    let mode = std::fs::metadata(&flawed).expect("the program").permissions().mode();
    let flawed = std::fs::read(flawed).expect("the program");
    assert_eq!(mode & 0o077 & 0o022, 0, "others can't write it");
    let student = server.visitor().welcome(&student);
    let home = student.get("/").expect(200).text();
    assert!(home.contains("/c/example"), "{home}");
    let id = student.submit("example", &flawed);
    assert_eq!(student.wait_for_grade("example", id)["grade"]["code"], "WA");
    assert!(student.get(&format!("/c/example/s/{id}")).expect(200).text().contains("report.html"));
    let admin = server.visitor().welcome(&admin);
    let class = admin.get("/api/v1/courses/example/assignments/m1/class").expect(200).json();
    assert_eq!(class[0]["login"], "student");
    // An administrator sees the size of a course and missing staff. Staff see how many students have submitted.
    let courses = admin.get("/admin").expect(200).text();
    assert!(courses.contains("\"submissions\">1<") && courses.contains("none: <a"), "{courses}");
    // The log of a new server begins with its creation.
    let log = admin.get("/admin/log").expect(200).text();
    assert!(
        log.contains("created the first administrator, admin") && log.contains("example (Example course)"),
        "{log}"
    );
    let course = admin.get("/c/example").expect(200).text();
    assert!(course.contains(">1 of 1<") && course.contains("\"accepted\">0<"), "{course}");
    let class = admin.get("/c/example/a/m1/class").expect(200).text();
    assert!(class.contains("aria-label=\"Points of the class: 0 to 10 %: "), "{class}");
    // After a restart there is no second example, and people who have signed in need no link.
    server.stop();
    server.resume();
    assert!(server.next_word().ends_with("/flawed-program"));
    assert_eq!(admin.get("/api/v1/courses").expect(200).json().as_array().expect("a list").len(), 1);
}

async fn a_real_server_is_no_example(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    server.stop();
    let error = server.start_again_with(&["--example"]).expect_err("refused");
    assert!(error.contains("this server already has courses"), "{error}");
    server.resume();
    assert_eq!(admin.get("/api/v1/courses").expect(200).json().as_array().expect("a list").len(), 1);
}
