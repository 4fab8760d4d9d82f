//! Tests that a course's suites belong to it: other courses cannot grade with them, and students get no information
//! about them.
use crate::support::{
    engines::{Fresh, on_sqlite},
    server::{Client, JSON, Server, program},
};

on_sqlite!(a_digest_opens_no_suite_of_another_course);

/// Returns an archive with a suite, as tar writes it.
fn suite() -> Vec<u8> {
    let text = b"title = \"secret\"\n[[group]]\nname = \"Hidden\"\nscenes = []\nvisibility = \"hidden\"\n";
    let mut tar = tar::Builder::new(flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast()));
    let mut header = tar::Header::new_gnu();
    header.set_size(text.len() as u64);
    header.set_mode(0o644);
    tar.append_data(&mut header, "suite.toml", &text[..]).expect("an entry");
    tar.into_inner().expect("a tar").finish().expect("an archive")
}

fn put(client: &Client, course: &str, settings: &str) -> crate::support::server::Answer {
    let wish = format!(r#"{{"title": "M", "settings": {settings}}}"#);
    client.send("PUT", &format!("/api/v1/courses/{course}/assignments/m1"), JSON, wish.as_bytes())
}

async fn a_digest_opens_no_suite_of_another_course(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "a");
    server.course(&admin, "b");
    let teacher = server.member(&admin, "a", "teacher", "staff");
    let ada = server.member(&admin, "a", "ada", "student");
    let thief = server.member(&admin, "b", "thief", "staff");
    let path = "/api/v1/courses/a/assignments/m1";
    let set = teacher.send("PUT", &format!("{path}/suite"), &[], &suite()).expect(200).json();
    let digest = set["settings"]["suite_archive"].as_str().expect("a digest").to_owned();
    // Students get no information about it by any route.
    let id = ada.submit("a", &program("WA", 1));
    ada.wait_for_grade("a", id);
    for door in [
        path.to_owned(),
        "/api/v1/courses/a/assignments".to_owned(),
        format!("/api/v1/courses/a/submissions/{id}"),
        format!("/api/v1/courses/a/submissions/{id}/history"),
        format!("/c/a/s/{id}"),
        "/c/a/a/m1".to_owned(),
    ] {
        let told = ada.get(&door).expect(200).text();
        assert!(!told.contains(&digest[..12]), "{door}: {told}");
    }
    // The suite that the uploaded one replaced, with other groups and points, is not shown in its place.
    assert_eq!(ada.get(path).expect(200).json()["settings"]["suite"], "");
    // The digest gives no access elsewhere, neither in settings nor in a regrade, and neither does the digest of
    // another upload.
    let upload = fosssim_server::store::Digest::from_bytes(&program("WA", 1)).to_string();
    for (client, course, digest) in [(&thief, "b", &digest), (&thief, "b", &upload), (&teacher, "a", &upload)] {
        let settings = format!(r#"{{"suite_archive": "{digest}", "hints": "full"}}"#);
        let refused = put(client, course, &settings).expect(409).text();
        assert!(refused.contains("no suite of this digest was uploaded to this course"), "{refused}");
        let regrade = format!(r#"{{"reason": "again", "settings": {settings}}}"#);
        client.post_json(&format!("/api/v1/courses/{course}/assignments/m1/regrades"), &regrade).expect(409);
    }
    // In the course to which it was uploaded, it can be chosen again.
    put(&teacher, "a", r#"{"suite_archive": null}"#).expect(200);
    put(&teacher, "a", &format!(r#"{{"suite_archive": "{digest}"}}"#)).expect(200);
}
