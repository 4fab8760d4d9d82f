//! Tests settings, from forms and from programs.
use crate::support::{
    engines::{Fresh, on_sqlite},
    server::{JSON, Server},
};

on_sqlite!(settings_are_a_form, a_date_is_a_date, nothing_is_overwritten_unseen);

async fn settings_are_a_form(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let settings = || admin.get("/api/v1/courses/physics/assignments/m1").expect(200).json()["settings"].clone();
    let revision = || admin.get("/api/v1/courses/physics/assignments/m1").expect(200).json()["revision"].clone();
    let send = |path: &str, form: &str| admin.post_form(path, &format!("{form}&revision={}", revision()));
    let form = "title=Milestone+one&visible=on&suite=course-2027&rules=&hints=what&smallest=on&program=FOSSSim\
                &seconds=90&form_sources=on\
                &megabytes=0.5&attempts=3&per_hour=0&late_days=2&late_percent=25";
    let path = "/c/physics/a/m1/settings";
    // Without a script, the field is in UTC and shows this. With a script, it is in the reader's time zone.
    send(path, &format!("{form}&due=2026-12-01T22:59&due_zone=0")).expect(303);
    let utc = settings();
    send(path, &format!("{form}&due=2026-12-01T23:59&due_zone=60")).expect(303);
    assert_eq!(settings(), utc);
    assert_eq!(
        utc,
        serde_json::json!({"suite": "course-2027", "hints": "what", "smallest": true, "program": "FOSSSim",
            "seconds": 90,
            "forms": ["sources"], "max_bytes": 524_288, "attempts": 3, "per_hour": 0, "due_at": 1_796_165_940_000_i64,
            "late_days": 2, "late_percent": 25})
    );
    let page = admin.get(path).expect(200).text();
    for part in [
        "value=\"2026-12-01T22:59\"",
        "<option value=\"course-2027\" selected>",
        "value=\"0.5\"",
        ">UTC</span>",
        ">suite's default (fair rules)<",
        ">suite's default (what)<",
    ] {
        assert!(page.contains(part), "{part}: {page}");
    }
    assert!(!page.contains("data-zone"), "{page}");
    send(path, &format!("{form}&due=2026-12-01T22:59&due_zone=0&time_zone=Europe/Berlin")).expect(303);
    let page = admin.get(path).expect(200).text();
    assert!(page.contains("data-zone=\"Europe/Berlin\" value=\"2026-12-01T22:59\""), "{page}");
    send(path, &format!("{form}&due=2026-12-01T22:59&due_zone=0")).expect(303);
    let page = admin.get("/c/physics/a/m1").expect(200).text();
    let time = "00.000+00:00\" title=\"2026-12-01 22:59:00 UTC\">2026-12-01 22:59 UTC</time>";
    assert!(page.contains(&format!("<time datetime=\"2026-12-01T22:59:{time}")), "{page}");
    for bad in ["due=tomorrow&due_zone=0", "due=2026-12-01T22:59&due_zone=east"] {
        send(path, &format!("{form}&{bad}")).expect(400);
    }
    send(path, &form.replace("form_sources=on", "x=y")).expect(400);
    assert_eq!(settings(), utc);
    // Settings that the form does not show are kept: the seconds of a date, and an uploaded suite.
    let wish = r#"{"title": "M", "visible": true, "settings": {"due_at": "2026-12-01T23:59:30+01:00"}}"#;
    admin.send("PUT", "/api/v1/courses/physics/assignments/m1", JSON, wish.as_bytes()).expect(200);
    send(path, &format!("{form}&due=2026-12-01T22:59&due_zone=0")).expect(303);
    assert_eq!(settings()["due_at"], 1_796_165_970_000_i64);
    send(path, &format!("{form}&due=&due_zone=0")).expect(303);
    assert!(settings()["due_at"].is_null());
    let regrade = "reason=again&suite=t2m2&rules=parity&hints=&program=FOSSSim&seconds=60";
    admin.post_form("/c/physics/a/m1/regrades", regrade).expect(303);
}

async fn a_date_is_a_date(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let set = |due: &str| {
        let wish = format!(r#"{{"title": "M", "settings": {{"due_at": {due}}}}}"#);
        admin.send("PUT", "/api/v1/courses/physics/assignments/m1", JSON, wish.as_bytes())
    };
    for due in ["1796165940000", "\"2026-12-01T22:59Z\"", "\"2026-12-01T23:59:00+01:00\""] {
        assert_eq!(set(due).expect(200).json()["settings"]["due_at"], 1_796_165_940_000_i64, "{due}");
    }
    set("null").expect(200);
    // A number of seconds would close the assignment in 1970.
    let problem = set("1796165940").expect(400).json();
    assert!(problem["detail"].as_str().expect("words").contains("1796165940 looks like seconds"), "{problem}");
    for due in ["\"2026-12-01T22:59\"", "\"soon\"", "1.5", "-1"] {
        set(due).expect(400);
    }
}

async fn nothing_is_overwritten_unseen(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let colleague = server.member(&admin, "physics", "colleague", "staff");
    let path = "/api/v1/courses/physics/assignments/m1";
    let seen = admin.get(path).expect(200).json()["revision"].as_i64().expect("a number");
    let page = admin.get("/c/physics/a/m1/settings").expect(200).text();
    assert!(page.contains(&format!("name=\"revision\" value=\"{seen}\"")), "{page}");
    let wish = r#"{"title": "M", "settings": {"due_at": "2026-12-01T22:59Z", "attempts": 3}}"#;
    colleague.send("PUT", path, JSON, wish.as_bytes()).expect(200);
    // The page that was opened before.
    let form = format!(
        "title=M&visible=on&suite=t2m2&rules=&hints=&program=FOSSSim&seconds=60&form_program=on&megabytes=1&attempts=0\
         &per_hour=0&late_days=0&late_percent=0&due=&due_zone=0&revision={seen}"
    );
    let refused = admin.post_form("/c/physics/a/m1/settings", &form).expect(409).text();
    assert!(
        refused.contains("colleague has changed it in the meantime") && refused.contains("attempts 3"),
        "{refused}"
    );
    let stale = format!(r#"{{"title": "M", "settings": {{"attempts": 9}}, "revision": {seen}}}"#);
    admin.send("PUT", path, JSON, stale.as_bytes()).expect(409);
    // A change of one field keeps the other fields, even without a revision.
    let one = admin.send("PUT", path, JSON, br#"{"title": "M", "settings": {"hints": "what"}}"#).expect(200).json();
    assert_eq!((&one["settings"]["attempts"], &one["settings"]["hints"]), (&3.into(), &"what".into()));
    admin.send("PUT", path, JSON, br#"{"title": "M", "settings": {"attempts": null}}"#).expect(400);
    // A member, too.
    let members = || admin.get("/c/physics/members").expect(200).text();
    let seen = members().split_once("name=\"seen\" value=\"").expect("a field").1.split('"').next().map(str::to_owned);
    let seen = seen.expect("a number");
    server.member(&colleague, "physics", "bob", "staff");
    let demoted = format!("login=bob&name=Bob&role=student&seen={seen}");
    let refused = admin.post_form("/c/physics/members", &demoted).expect(409).text();
    assert!(refused.contains("colleague has changed it in the meantime: bob became staff"), "{refused}");
    admin.post_form("/c/physics/members/bob/remove", &format!("seen={seen}")).expect(409);
    let wish = format!(r#"{{"name": "Bob", "role": "student", "seen": {seen}}}"#);
    admin.send("PUT", "/api/v1/courses/physics/members/bob", JSON, wish.as_bytes()).expect(409);
    assert!(members().contains(">staff</span>"));
    admin.send("DELETE", &format!("/api/v1/courses/physics/members/bob?seen={seen}"), &[], b"").expect(409);
    let table = format!("table=name,login%0ABob,bob%0A&import=yes&seen={seen}");
    admin.post_form("/c/physics/members/import", &table).expect(409);
    let csv = [("Content-Type", "text/csv")];
    admin
        .send("POST", &format!("/api/v1/courses/physics/members?seen={seen}"), &csv, b"name,login\nBob,bob\n")
        .expect(409);
    admin.post_form("/c/physics/members", &format!("login=eve&name=Eve&role=student&seen={seen}")).expect(200);
    admin.post_form("/c/physics/members/bob/remove", "").expect(303);
    // More time, too.
    let ada = server.member(&admin, "physics", "ada", "student");
    let page = admin.get("/c/physics/a/m1/students/ada").expect(200).text();
    let seen = page.split_once("name=\"seen\" value=\"").expect("a field").1.split('"').next().expect("a number");
    let extension = "/api/v1/courses/physics/assignments/m1/extensions/ada";
    colleague.send("PUT", extension, JSON, br#"{"due_at": "2026-12-08T22:59Z"}"#).expect(204);
    let early = colleague.send("PUT", extension, JSON, br#"{"due_at": "2026-11-08T22:59Z"}"#).expect(400).text();
    assert!(early.contains("after the assignment's due date"), "{early}");
    let form = format!("due=2026-12-03T12:00&due_zone=0&seen={seen}");
    let refused = admin.post_form("/c/physics/a/m1/students/ada/extension", &form).expect(409).text();
    let words = "colleague has changed it in the meantime: ada got an extension until 2026-12-08 22:59";
    assert!(refused.contains(words), "{refused}");
    let wish = format!(r#"{{"due_at": null, "seen": {seen}}}"#);
    admin.send("PUT", extension, JSON, wish.as_bytes()).expect(409);
    admin.send("DELETE", &format!("{extension}?seen={seen}"), &[], b"").expect(409);
    admin.send("DELETE", extension, &[], b"").expect(204);
    // A mark, too.
    let id = ada.submit("physics", b"#!grade WA 1\n");
    let mark = format!("/api/v1/courses/physics/submissions/{id}/mark");
    let hidden = r#"{"comment": "well\u200bdone"}"#;
    let refused = colleague.send("PUT", &mark, JSON, hidden.as_bytes()).expect(400).text();
    assert!(refused.contains("must not contain the invisible character \\\\u{200b}"), "{refused}");
    let seen = colleague.send("PUT", &mark, JSON, br#"{"comment": "well done"}"#).expect(200).json();
    let seen = seen["mark"]["marked_at"].as_i64().expect("a moment");
    let other = format!(r#"{{"comment": "poor", "marked_at": {}}}"#, seen - 1);
    let refused = admin.send("PUT", &mark, JSON, other.as_bytes()).expect(409).text();
    assert!(refused.contains("colleague has marked it in the meantime: well done"), "{refused}");
    let form = format!("points=&comment=poor&marked_at={}", seen - 1);
    admin.post_form(&format!("/c/physics/s/{id}/mark"), &form).expect(409);
    admin.post_form(&format!("/c/physics/s/{id}/mark"), &format!("points=&comment=poor&marked_at={seen}")).expect(303);
}
