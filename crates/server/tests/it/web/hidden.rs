//! Tests that students do not see groups that a suite hides from them.
use crate::support::{
    engines::{Fresh, on_sqlite},
    server::{Client, Server},
};
use serde_json::Value;

on_sqlite!(
    reports_that_tell_of_hidden_groups_are_for_staff,
    the_page_for_staff_is_for_staff,
    a_regrade_by_another_suite_publishes_nothing,
    all_that_a_page_offers_tells_of_the_points_in_its_head,
    the_groups_of_an_uploaded_suite_are_shown_as_far_as_they_are_visible
);

async fn reports_that_tell_of_hidden_groups_are_for_staff(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let ada = server.member(&admin, "physics", "ada", "student");
    let hidden = ada.submit("physics", b"#!grade WA 40 Secret/scene 3\n");
    let open = ada.submit("physics", b"#!grade WA 40 Group/scene 3\n");
    for id in [hidden, open] {
        ada.wait_for_grade("physics", id);
    }
    for name in ["grade.json", "report.txt"] {
        let path = |id: i64| format!("/api/v1/courses/physics/submissions/{id}/files/{name}");
        ada.get(&path(hidden)).expect(404);
        teacher.get(&path(hidden)).expect(200);
        ada.get(&path(open)).expect(200);
    }
    // The scenes that an attempt has changed are shown only if no part of both attempts is hidden.
    let page = |by: &Client| by.get(&format!("/c/physics/s/{open}")).expect(200).text();
    assert!(!page(&ada).contains("Since submission") && !page(&ada).contains("Secret"), "{}", page(&ada));
    let words = "Since submission 1, these became right: Secret/scene. No longer right: Group/scene.";
    assert!(page(&teacher).contains(words), "{}", page(&teacher));
    // Hidden parts change nothing that a student sees: no points, counts, verdicts, digests or sizes.
    let other = ada.submit("physics", b"#!grade RTE 7 Secret/scene 1\n");
    ada.wait_for_grade("physics", other);
    let told = |by: &Client, id: i64| {
        let mut told = by.get(&format!("/api/v1/courses/physics/submissions/{id}")).expect(200).json();
        let mut grade = told["grade"].take();
        let is_hour = |moment: Value| moment.as_i64().expect("a moment") % 3_600_000 == 0;
        let graded = is_hour(grade["created_at"].take());
        grade["files"].as_array_mut().expect("a list").retain(|file| file["name"] != "staff.html");
        let mut history = by.get(&format!("/api/v1/courses/physics/submissions/{id}/history")).expect(200).json();
        let mut history = history[0].take();
        let changed = is_hour(history["changed_at"].take());
        for own in ["result", "task", "by_what"] {
            history[own].take();
        }
        // The duration of the hidden groups is not shown either.
        assert_eq!([graded, changed], [told["is_withheld"] == true; 2]);
        (grade, history, told["is_withheld"].take())
    };
    let (grade, history, withheld) = told(&ada, hidden);
    assert_eq!((&grade, &history, &withheld), (&told(&ada, other).0, &told(&ada, other).1, &true.into()));
    assert_eq!([&grade["code"], &grade["points"], &grade["max_points"]], ["AC", "10.0", "10.0"]);
    assert!(grade["seconds"].is_null(), "{grade}");
    assert_eq!([&history["new_code"], &history["new_points"]], ["AC", "10.0"]);
    let list = ada.get("/api/v1/courses/physics/assignments/m1/submissions").expect(200).json();
    let seen = |one: &Value| one["id"] == open || one["grade"]["code"] == "AC";
    assert!(list.as_array().expect("a list").iter().all(seen), "{list}");
    let seen = ada.get(&format!("/api/v1/courses/physics/submissions/{other}")).expect(200).text();
    assert!(seen.contains("is_withheld") && !seen.contains("RTE") && !seen.contains("grade.json"), "{seen}");
    let page = ada.get(&format!("/c/physics/s/{other}")).expect(200).text();
    assert!(!page.contains("RTE") && page.contains("10 of 10 points"), "{page}");
    assert!(page.contains("everything on this page is accepted") && !page.contains("Everything is accepted"), "{page}");
    assert_eq!(told(&teacher, other).0["points"], "7");
    // After staff have published the groups, everything is shown.
    ada.send("PUT", "/api/v1/courses/physics/assignments/m1/published", &[], b"").expect(403);
    teacher.post_form("/c/physics/a/m1/publish", "").expect(303);
    assert_eq!(told(&ada, other), told(&teacher, other));
    assert_eq!(told(&ada, other).0["code"], "RTE");
    ada.get(&format!("/api/v1/courses/physics/submissions/{hidden}/files/grade.json")).expect(200);
    teacher.send("DELETE", "/api/v1/courses/physics/assignments/m1/published", &[], b"").expect(200);
    assert_eq!(told(&ada, other).0, grade);
    // A grade of an older version is examined when it is requested.
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    transaction.execute("UPDATE result SET shown = NULL", &[]).await.expect("as before");
    transaction.commit().await.expect("a commit");
    assert_eq!(told(&ada, other).0, grade);
    let list = ada.get("/api/v1/courses/physics/assignments/m1/submissions").expect(200).json();
    assert_eq!(
        [&list[0]["grade"]["code"], &list[0]["grade"]["files"]],
        [&serde_json::json!("AC"), &serde_json::json!([])]
    );
    // The page for students is made without them.
    ada.get(&format!("/api/v1/courses/physics/submissions/{hidden}/files/report.html")).expect(200);
    let page = ada.get(&format!("/c/physics/s/{hidden}")).expect(200).text();
    assert!(page.contains("report.html") && !page.contains("grade.json") && !page.contains("Report as text"), "{page}");
    let page = teacher.get(&format!("/c/physics/s/{hidden}")).expect(200).text();
    assert!(page.contains("grade.json") && page.contains("Report as text"), "{page}");
}

/// Details that hints withhold from students are on a separate page, with and without hidden groups.
async fn the_page_for_staff_is_for_staff(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let ada = server.member(&admin, "physics", "ada", "student");
    for (scene, hides) in [("Group/scene", false), ("Secret/scene", true)] {
        let id = ada.submit("physics", format!("#!grade WA 40 {scene} 3\n").as_bytes());
        ada.wait_for_grade("physics", id);
        let path = format!("/api/v1/courses/physics/submissions/{id}/files/staff.html");
        ada.get(&path).expect(404);
        assert!(teacher.get(&path).expect(200).text().starts_with("everything"));
        let shown = |by: &Client, page: &str| {
            by.get(&format!("/c/physics/s/{id}"))
                .expect(200)
                .text()
                .contains(&format!("/submissions/{id}/files/{page}\""))
        };
        assert!(shown(&ada, "report.html") && !shown(&ada, "staff.html") && shown(&teacher, "staff.html"));
        let class = teacher.get("/c/physics/a/m1/class").expect(200).text();
        assert_eq!(class.contains("Publish hidden groups"), hides, "{class}");
    }
}

/// The groups that staff published are those of the earlier suite.
async fn a_regrade_by_another_suite_publishes_nothing(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    for (course, login, scene, hides) in
        [("physics", "ada", "Secret/scene", true), ("chemistry", "bob", "Group/scene", false)]
    {
        server.course(&admin, course);
        let student = server.member(&admin, course, login, "student");
        let id = student.submit(course, format!("#!grade WA 40 {scene} 3\n").as_bytes());
        student.wait_for_grade(course, id);
        let path = format!("/api/v1/courses/{course}/assignments/m1");
        admin.send("PUT", &format!("{path}/published"), &[], b"").expect(200);
        for (settings, points) in [(r#"{"rules": "parity"}"#, "20"), (r#"{"suite": "course-2027"}"#, "10.0")] {
            let wish = format!(r#"{{"reason": "new", "settings": {settings}}}"#);
            let regrade = admin.post_json(&format!("{path}/regrades"), &wish).expect(201).json()["id"].clone();
            while admin.get(&format!("{path}/regrades/{regrade}")).expect(200).json()["left"] != 0 {
                std::thread::sleep(std::time::Duration::from_millis(20));
            }
            let page = admin.get(&format!("/c/{course}/a/m1/regrades/{regrade}")).expect(200).text();
            assert_eq!(page.contains("are withheld again"), hides && points == "10.0", "{page}");
            let changes = page.contains(&format!("<span class=\"names\">{login}</span></th>"));
            assert_eq!(changes, points == "20", "{page}");
            admin.post_json(&format!("{path}/regrades/{regrade}/apply"), "").expect(200);
            let seen = if hides { points } else { "20" };
            assert_eq!(student.wait_for_grade(course, id)["grade"]["points"], seen);
        }
        let log = admin.get(&format!("/api/v1/courses/{course}/audit?kind=regrade")).expect(200).text();
        assert_eq!(log.contains("; withheld hidden groups"), hides, "{log}");
    }
}

/// For every reader, before and after hidden groups are published, all offered reports have the points of the page's
/// head.
async fn all_that_a_page_offers_tells_of_the_points_in_its_head(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let ada = server.member(&admin, "physics", "ada", "student");
    let id = ada.submit("physics", b"#!grade WA 40 Secret/scene 3\n");
    ada.wait_for_grade("physics", id);
    for published in [false, true, false] {
        let method = if published { "PUT" } else { "DELETE" };
        teacher.send(method, "/api/v1/courses/physics/assignments/m1/published", &[], b"").expect(200);
        for (reader, points) in [(&ada, if published { "40" } else { "10.0" }), (&teacher, "40")] {
            let told = reader.get(&format!("/api/v1/courses/physics/submissions/{id}")).expect(200).json();
            assert_eq!(told["grade"]["points"], points, "{told}");
            let files: Vec<&str> = told["grade"]["files"]
                .as_array()
                .expect("a list")
                .iter()
                .filter_map(|file| file["name"].as_str())
                .collect();
            assert!(files.iter().any(|name| name.ends_with(".html")), "{files:?}");
            let page = reader.get(&format!("/c/physics/s/{id}")).expect(200).text();
            let words = ["Without these, the result is: accepted.", "Students have seen the hidden groups since "];
            let is_staff = std::ptr::eq(reader, &teacher);
            let found = words.map(|words| page.contains(words));
            assert_eq!(found, [is_staff && !published, is_staff && published], "{page}");
            for name in files.iter().filter(|name| name.ends_with(".html") || name.ends_with(".txt")) {
                let report =
                    reader.get(&format!("/api/v1/courses/physics/submissions/{id}/files/{name}")).expect(200).text();
                assert!(report.contains(&format!("{points} points")), "{name} by {published}: {report}");
                assert!(page.contains(name), "{name}: {page}");
            }
            for other in ["report.html", "published.html", "staff.html"].iter().filter(|name| !files.contains(name)) {
                reader.get(&format!("/api/v1/courses/physics/submissions/{id}/files/{other}")).expect(404);
            }
        }
    }
}

/// Students read the groups of the course's own suite before they submit, but nothing about hidden groups.
async fn the_groups_of_an_uploaded_suite_are_shown_as_far_as_they_are_visible(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let suite = b"name = 'Mini'
[[group]]\nname = 'Open'\nscenes = ['asset:a/b', 'asset:a/c']\npoints = 2.5
[[group]]\nname = 'Many'\nscenes = ['asset:a/*']
[[group]]\nname = 'Secret'\nscenes = ['asset:s/d']\npoints = 77\nvisibility = 'after_due_date'\n";
    let path = "/api/v1/courses/physics/assignments/m1";
    admin.send("PUT", &format!("{path}/suite"), &[], suite).expect(200);
    for published in [false, true, false] {
        let method = if published { "PUT" } else { "DELETE" };
        admin.send(method, &format!("{path}/published"), &[], b"").expect(200);
        let page = ada.get("/c/physics/a/m1").expect(200).text();
        let open = "<li>2.5 for Open <span class=\"names\">2 scenes</span></li>";
        assert!(page.contains(open) && page.contains("<li>1 for Many</li>"), "{page}");
        assert_eq!(page.contains("77 for Secret <span class=\"names\">1 scene</span>"), published, "{page}");
        assert_eq!(page.contains("Other groups stay hidden until staff publish them."), !published, "{page}");
        assert_eq!(page.contains("Secret"), published, "{page}");
    }
}
