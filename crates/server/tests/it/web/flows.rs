//! Tests the steps of students and teachers, from the first link to a regrade.
use crate::support::{
    engines::{Fresh, on_both_engines},
    server::{Answer, Client, JSON, Server, program},
};

on_both_engines!(
    a_course_from_the_first_link_to_the_grades,
    an_upload_sent_twice_is_one_submission,
    limits_are_kept_and_say_so,
    a_regrade_changes_nothing_until_it_is_applied,
    a_regrade_tells_of_grades_of_staff_and_of_newcomers,
    a_discarded_regrade_leaves_no_trace_in_grades,
    what_was_accepted_survives_a_kill_of_the_server,
    nobody_gains_or_loses_rights_by_an_old_link,
);

async fn a_course_from_the_first_link_to_the_grades(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "2"]);
    let visitor = server.visitor();
    visitor.get("/health").expect(200);
    visitor.get("/ready").expect(200);
    visitor.get("/").expect(303);
    let link = server.first_link();
    // Opening the link, as mail programs do, does not use it up. Signing in with it does.
    visitor.get(&format!("/welcome/{link}")).expect(200);
    let session = visitor.welcome(&link);
    assert!(session.get("/").expect(200).text().contains("you are not a member of any course yet"));
    visitor.post_form(&format!("/welcome/{link}"), "").expect(401);
    let token = session.post_json("/api/v1/tokens", r#"{"name": "a token"}"#).expect(201).json();
    let admin = server.with_token(token["token"].as_str().expect("a token"));
    assert!(!server.log().contains(&link), "the log has the link");

    server.course(&admin, "physics");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let (ada, bob) =
        (server.member(&teacher, "physics", "ada", "student"), server.member(&teacher, "physics", "bob", "student"));
    let first = ada.submit("physics", &program("WA", 40));
    let second = ada.submit("physics", &program("AC", 100));
    let other = bob.submit("physics", &program("WA", 20));
    for (client, id, code, points) in
        [(&ada, first, "WA", "40"), (&ada, second, "AC", "100"), (&bob, other, "WA", "20")]
    {
        let submission = client.wait_for_grade("physics", id);
        assert_eq!(submission["grade"]["code"], code, "{submission}");
        assert_eq!(submission["grade"]["points"], points, "{submission}");
    }
    // Students see only their own submissions, in the API and on pages.
    bob.get(&format!("/api/v1/courses/physics/submissions/{first}")).expect(404);
    bob.get(&format!("/api/v1/courses/physics/submissions/{first}/files/report.txt")).expect(404);
    teacher.get(&format!("/api/v1/courses/physics/submissions/{first}")).expect(200);

    // The report is a part of the page without its scripts. As a separate page it has no rights.
    let page = ada.get(&format!("/c/physics/s/{second}")).expect(200).text();
    assert!(page.contains("<p>100 points</p>") && !page.contains("document.cookie"), "{page}");
    let report = ada.get(&format!("/api/v1/courses/physics/submissions/{second}/files/report.txt")).expect(200);
    assert!(report.header("content-security-policy").expect("a policy").starts_with("sandbox"));
    assert_eq!(report.header("content-type"), Some("text/plain; charset=utf-8"));
    assert_eq!(report.header("x-content-type-options"), Some("nosniff"));
    let page = ada.get(&format!("/api/v1/courses/physics/submissions/{second}/files/report.html")).expect(200);
    let policy = page.header("content-security-policy").expect("a policy");
    assert!(policy.starts_with("sandbox allow-scripts") && !policy.contains("same-origin"), "{policy}");
    let upload = ada.get(&format!("/api/v1/courses/physics/submissions/{second}/upload")).expect(200);
    assert_eq!(upload.body, program("AC", 100));
    assert_eq!(upload.header("content-disposition"), Some("attachment; filename=\"FOSSSim\""));

    let class = teacher.get("/api/v1/courses/physics/assignments/m1/class").expect(200).json();
    assert_eq!(class[0]["login"], "ada");
    assert_eq!(class[0]["submissions"], 2);
    assert_eq!(class[0]["counts"]["id"], second);
    let table = teacher.get("/api/v1/courses/physics/assignments/m1/export").expect(200).text();
    let head = "login,name,submissions,submission,verdict,points,grader_points,max_points,graded_at,likely_mistake,\
                Group,'=More\n";
    assert!(table.starts_with(head), "{table}");
    assert!(table.contains(",,10,100\n"), "{table}");
    assert!(table.contains(&format!("ada,The ada,2,{second},in words,100,,100,20")), "{table}");
    let lines = teacher.get("/api/v1/courses/physics/assignments/m1/export?format=jsonl").expect(200).text();
    assert_eq!(lines.lines().count(), 3);

    let metrics = visitor.get("/metrics").expect(200).text();
    assert!(metrics.contains("fosssim_jobs{state=\"done\"} 3"), "{metrics}");
    // Inside a course, its log does not name the course.
    let audit = teacher.get("/c/physics/audit").expect(200).text();
    assert!(!audit.contains("physics / m1") && audit.contains("<caption>Latest first"), "{audit}");
    assert!(session.get("/admin/log").expect(200).text().contains("physics / m1"));
    assert!(audit.contains("bob became student"), "{audit}");
    assert!(server.stop().success());
    assert!(!server.log().contains("fso_"), "the log has a token");
}

async fn an_upload_sent_twice_is_one_submission(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let path = "/api/v1/courses/physics/assignments/m1/submissions";
    let key = [("Idempotency-Key", "from my script")];
    let send = |body: &[u8]| ada.send("POST", path, &key, body);
    let id = |answer: Answer| answer.json()["id"].as_i64().expect("a number");
    let first = id(send(&program("AC", 1)).expect(201));
    assert_eq!(id(send(&program("AC", 1)).expect(200)), first);
    let problem = send(&program("AC", 2)).expect(409);
    assert_eq!(problem.header("content-type"), Some("application/problem+json"));
    assert_eq!(problem.json()["detail"], "this key was already used for another upload");
    // Simultaneous uploads, too.
    let clients: Vec<_> = (0..8)
        .map(|_| {
            let ada = ada.clone();
            std::thread::spawn(move || {
                let answer = ada.send("POST", path, &[("Idempotency-Key", "all at once")], &program("AC", 3));
                assert!(matches!(answer.status, 200 | 201), "{}", answer.text());
                answer.json()["id"].as_i64().expect("a number")
            })
        })
        .collect();
    let mut ids: Vec<i64> = clients.into_iter().map(|client| client.join().expect("an answer")).collect();
    ids.dedup();
    assert_eq!(ids.len(), 1, "{ids:?}");
    // Without a key, and from a page: the same page and file are one submission, another file is another one.
    let form = |key: &str, file: &str| {
        let body = format!(
            "--x\r\nContent-Disposition: form-data; name=\"key\"\r\n\r\n{key}\r\n--x\r\n\
             Content-Disposition: form-data; name=\"file\"; filename=\"../FOSSSim\"\r\n\r\n{file}\r\n--x--\r\n"
        );
        let headers = [("Content-Type", "multipart/form-data; boundary=x"), ("Sec-Fetch-Site", "same-origin")];
        ada.send("POST", "/c/physics/a/m1", &headers, body.as_bytes()).expect(303)
    };
    let place = |answer: Answer| answer.header("location").expect("a place").to_owned();
    let first = place(form("k1", "#!grade AC 5\n"));
    assert_eq!(place(form("k1", "#!grade AC 5\n")), first);
    assert_ne!(place(form("k1", "#!grade AC 6\n")), first);
    assert_ne!(place(form("k2", "#!grade AC 5\n")), first);
    // Programs are large, in forms, too.
    let large = place(form("k3", &format!("#!grade AC 5\n{}", "#".repeat(5_000_000))));
    let large = format!("/api/v1/courses/physics/submissions/{}/upload", large.rsplit('/').next().expect("an id"));
    assert_eq!(ada.get(&large).expect(200).body.len(), 5_000_013);
    let all = ada.get(path).expect(200).json();
    assert_eq!(all.as_array().expect("a list").len(), 6);
    assert_eq!(all[0]["file_name"], "FOSSSim");
    // No worker grades here, so the positions in the queue increase.
    let ahead: Vec<_> = [0, 1, 2]
        .map(|index| {
            let id = &all[5 - index]["id"];
            ada.get(&format!("/api/v1/courses/physics/submissions/{id}")).expect(200).json()["ahead"].clone()
        })
        .into();
    assert_eq!(ahead, [0, 1, 2]);
}

async fn limits_are_kept_and_say_so(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let path = "/api/v1/courses/physics/assignments/m1/submissions";
    let set = |settings: &str| {
        let wish = format!(r#"{{"title": "M1", "visible": true, "settings": {settings}}}"#);
        admin.send("PUT", "/api/v1/courses/physics/assignments/m1", JSON, wish.as_bytes())
    };
    let send = |body: &[u8]| ada.send("POST", path, &[], body);
    set(r#"{"attempts": 1, "max_bytes": 100}"#).expect(200);
    assert_eq!(send(&[b'#'; 101]).expect(413).json()["type"], "urn:fosssim:too-large");
    let remedy = send(b"MZ\x90").expect(422).json();
    assert!(remedy["detail"].as_str().expect("text").contains("expected a program for Linux"), "{remedy}");
    let cure = "choose the file FOSSSim in your build folder or an archive of sources or an archive of traces; ";
    assert!(remedy["remedy"].as_str().expect("text").starts_with(cure), "{remedy}");
    send(b"").expect(422);
    send(&program("AC", 1)).expect(201);
    assert!(send(&program("AC", 2)).expect(409).text().contains("used up"));
    set(r#"{"attempts": 0, "per_hour": 1}"#).expect(200);
    send(&program("AC", 2)).expect(429);
    set(r#"{"due_at": 1}"#).expect(200);
    assert!(send(&program("AC", 2)).expect(409).text().contains("due date has passed"));
    set(r#"{"forms": ["sources"], "due_at": null, "per_hour": 0}"#).expect(200);
    send(&program("AC", 2)).expect(422);
    // Invalid settings, and hidden assignments.
    for wrong in [
        r#"{"seconds": 10800}"#,
        r#"{"suite": "../../etc/passwd"}"#,
        r#"{"program": "--help"}"#,
        r#"{"rules": "kind"}"#,
        r#"{"forms": []}"#,
        r#"{"unknown": 1}"#,
    ] {
        set(wrong).expect(400);
    }
    // The grader lists the suites that exist.
    set(r#"{"suite": "course-2027"}"#).expect(200);
    assert!(set(r#"{"suite": "course-2028"}"#).expect(409).text().contains("suite must be t2m2 or course-2027"));
    assert_eq!(set(r#"{"suite": ""}"#).expect(200).json()["settings"]["suite"], "t2m2");
    let page = admin.get("/c/physics/a/m1/settings").expect(200).text();
    assert!(page.contains(">M2 (t2m2)</option><option value=\"course-2027\">New (course-2027)</option>"), "{page}");
    let hidden = r#"{"title": "M1", "visible": false}"#;
    admin.send("PUT", "/api/v1/courses/physics/assignments/m1", JSON, hidden.as_bytes()).expect(200);
    ada.get("/api/v1/courses/physics/assignments/m1").expect(404);
    send(&program("AC", 2)).expect(404);
}

async fn a_regrade_changes_nothing_until_it_is_applied(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "2"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let (whole, none) = (ada.submit("physics", &program("WA", 40)), ada.submit("physics", &program("WA", 0)));
    ada.wait_for_grade("physics", whole);
    ada.wait_for_grade("physics", none);
    let base = "/api/v1/courses/physics/assignments/m1/regrades";
    let wish = r#"{"reason": "the rules were too kind", "settings": {"rules": "parity", "per_hour": 0}}"#;
    let regrade = admin.post_json(base, wish).expect(201).json();
    let id = regrade["id"].as_i64().expect("a number");
    admin.post_json(base, wish).expect(409);
    let finished = || loop {
        let regrade = admin.get(&format!("{base}/{id}")).expect(200).json();
        if regrade["left"] == 0 {
            return regrade;
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    };
    let preview = finished();
    assert_eq!(preview["submissions"], 2);
    let changes = preview["changes"].as_array().expect("a list");
    assert_eq!(changes.len(), 1, "{preview}");
    assert_eq!(changes[0]["submission"], whole);
    assert_eq!([&changes[0]["old_points"], &changes[0]["new_points"]], ["40", "20"]);
    assert_eq!(changes[0]["why"], serde_json::json!(["rules: from the suite's to the original's"]));
    assert_eq!(ada.wait_for_grade("physics", whole)["grade"]["points"], "40");
    // A submission that arrives in the meantime is graded with the old settings, and is part of the regrade before it
    // can be applied.
    let late = ada.submit("physics", &program("WA", 60));
    assert_eq!(ada.wait_for_grade("physics", late)["grade"]["points"], "60");
    let problem = admin.post_json(&format!("{base}/{id}/apply"), "").expect(409).json();
    assert_eq!(problem["detail"], "1 submission arrived in the meantime, and is being graded");
    assert_eq!(finished()["submissions"], 3);
    let page = admin.get(&format!("/c/physics/a/m1/regrades/{id}")).expect(200).text();
    assert_eq!(page.matches("rules: from the suite").count(), 1, "the reason is there once: {page}");
    assert!(page.contains("settings also change") && !page.contains("The grader failed on"), "{page}");
    let applied = admin.post_json(&format!("{base}/{id}/apply"), "").expect(200).json();
    assert_eq!(applied["state"], "applied");
    let log = admin.get("/c/physics/audit").expect(200).text();
    assert!(log.contains(&format!("applied regrade {id}; rules: from the suite")), "{log}");
    assert_eq!(applied["changes"].as_array().expect("a list").len(), 2, "what it changed can still be seen");
    admin.post_json(&format!("{base}/{id}/apply"), "").expect(409);
    admin.post_json(&format!("{base}/{id}/discard"), "").expect(409);
    assert_eq!(ada.wait_for_grade("physics", whole)["grade"]["points"], "20");
    assert_eq!(ada.wait_for_grade("physics", late)["grade"]["points"], "30");
    // The student sees the reason, and new submissions are graded in the new way.
    let history = ada.get(&format!("/api/v1/courses/physics/submissions/{whole}/history")).expect(200).json();
    assert_eq!(history[1]["reason"], "the rules were too kind");
    assert_eq!([&history[1]["old_points"], &history[1]["new_points"]], ["40", "20"]);
    assert_eq!(history[1]["by"], "admin");
    let page = ada.get(&format!("/c/physics/s/{whole}")).expect(200).text();
    assert!(page.contains("the rules were too kind"), "{page}");
    let new = ada.submit("physics", &program("WA", 80));
    assert_eq!(ada.wait_for_grade("physics", new)["grade"]["points"], "40");
}

async fn a_regrade_tells_of_grades_of_staff_and_of_newcomers(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "2"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    admin.send("PUT", "/api/v1/courses/physics/assignments/m1/suite", &[], b"name = 'Mini'\n").expect(200);
    let ada = server.member(&admin, "physics", "ada", "student");
    let id = ada.submit("physics", &program("WA", 40));
    ada.wait_for_grade("physics", id);
    let mark = format!("/api/v1/courses/physics/submissions/{id}/mark");
    admin.send("PUT", &mark, JSON, br#"{"points": 12.5, "comment": "by hand"}"#).expect(200);
    let other = ada.submit("physics", &program("RTE", 60));
    ada.wait_for_grade("physics", other);
    assert!(!admin.get("/c/physics/a/m1/class").expect(200).text().contains("One regrade is open"));
    let base = "/api/v1/courses/physics/assignments/m1/regrades";
    let wish = r#"{"reason": "another suite", "settings": {"suite": "course-2027", "rules": "parity", "per_hour": 0}}"#;
    let regrade = admin.post_json(base, wish).expect(201).json()["id"].clone();
    let path = format!("{base}/{regrade}");
    let finish = || {
        while admin.get(&path).expect(200).json()["left"] != 0 {
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
    };
    finish();
    let place = format!("/c/physics/a/m1/regrades/{regrade}");
    let page = || admin.get(&place).expect(200).text();
    // The points of staff stay, with another maximum. Every number of points has its maximum.
    let stays =
        format!("1 grade set by staff stays: 12.5, now of 200 (<a href=\"/c/physics/s/{id}\">ada, submission 1");
    assert!(page().contains(&stays) && page().contains("1 grade would change, 1 down"), "{}", page());
    assert!(page().contains("60 of 100 points") && page().contains("30 of 200 points"), "{}", page());
    // Suites have names, and what both grades say is on the page once.
    let suites = page().matches("suite: from Mini (uploaded 2").count();
    let mistakes = page().matches("a step is wrong").count();
    assert!((suites, mistakes) == (1, 1) && page().contains(">\u{2212}30<"), "{}", page());
    // Only the link to an open regrade is there, not a form that would be rejected.
    let class = admin.get("/c/physics/a/m1/class").expect(200).text();
    assert!(class.contains("One regrade is open") && !class.contains("name=\"reason\""), "{class}");
    // A newcomer is counted before the regrade is applied, and is graded by a button.
    let late = ada.submit("physics", &program("WA", 80));
    ada.wait_for_grade("physics", late);
    assert!(page().contains("1 submission arrived after the regrade began"), "{}", page());
    assert!(page().contains("Grade it too") && !page().contains("Apply these grades"), "{}", page());
    admin.post_form(&format!("{place}/newcomers"), "").expect(303);
    finish();
    assert!(page().contains("3 submissions.") && page().contains("2 grades would change"), "{}", page());
    assert!(!page().contains("arrived after"), "{}", page());
    admin.post_form(&format!("{place}/apply"), "").expect(303);
    assert!(page().contains(&stays) && page().contains("2 grades changed"), "{}", page());
    admin.post_form(&format!("{place}/newcomers"), "").expect(409);
    let grade = ada.wait_for_grade("physics", id)["grade"].clone();
    assert_eq!([&grade["points"], &grade["max_points"]], ["12.5", "200"]);
    let history = |by: &Client| by.get(&format!("/c/physics/s/{other}")).expect(200).text();
    assert!(history(&admin).contains("suite Mini (uploaded 2") && !history(&ada).contains("Mini"), "{}", history(&ada));
}

async fn a_discarded_regrade_leaves_no_trace_in_grades(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let id = ada.submit("physics", &program("WA", 40));
    ada.wait_for_grade("physics", id);
    let base = "/api/v1/courses/physics/assignments/m1/regrades";
    let wish = r#"{"reason": "to see", "settings": {"rules": "parity", "per_hour": 0}}"#;
    let regrade = admin.post_json(base, wish).expect(201).json()["id"].clone();
    admin.post_json(&format!("{base}/{regrade}/discard"), "").expect(200);
    assert_eq!(ada.wait_for_grade("physics", id)["grade"]["points"], "40");
    let again = ada.submit("physics", &program("WA", 80));
    assert_eq!(ada.wait_for_grade("physics", again)["grade"]["points"], "80");
}

async fn what_was_accepted_survives_a_kill_of_the_server(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1", "--lease", "2"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    // A job that runs when the server dies is run again; one that waited is still there.
    let ids: Vec<i64> = (0..12).map(|points| ada.submit("physics", &program("WA", points))).collect();
    for _ in 0..3 {
        server.kill();
        server.resume();
    }
    for (points, id) in (0..).zip(ids) {
        let submission = ada.wait_for_grade("physics", id);
        assert_eq!(submission["grade"]["points"], format!("{points}"), "{submission}");
        let history = ada.get(&format!("/api/v1/courses/physics/submissions/{id}/history")).expect(200).json();
        assert_eq!(history.as_array().expect("a list").len(), 1, "graded once: {history}");
    }
}

async fn nobody_gains_or_loses_rights_by_an_old_link(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    server.course(&admin, "other");
    let (teacher, colleague) =
        (server.member(&admin, "physics", "teacher", "staff"), server.member(&admin, "other", "colleague", "staff"));
    let ada = server.member(&teacher, "physics", "ada", "student");
    let set = |by: &Client, course: &str, login: &str, role: &str| {
        let wish = format!(r#"{{"name": "x", "role": "{role}"}}"#);
        by.send("PUT", &format!("/api/v1/courses/{course}/members/{login}"), JSON, wish.as_bytes()).expect(200).json()
    };
    let link = |by: &Client, course: &str, login: &str| {
        by.post_json(&format!("/api/v1/courses/{course}/members/{login}/link"), "{}")
    };
    // Staff can create links only for their own students, not for people with more rights.
    let old = link(&teacher, "physics", "ada").expect(200).json()["link"].as_str().expect("a link").to_owned();
    let old = old.rsplit('/').next().expect("a secret").to_owned();
    link(&teacher, "physics", "teacher").expect(403);
    link(&teacher, "physics", "colleague").expect(404);
    let wish = br#"{"name": "x", "role": "student"}"#;
    colleague.send("PUT", "/api/v1/courses/other/members/ada", JSON, wish).expect(403);
    link(&colleague, "other", "ada").expect(404);
    link(&teacher, "physics", "ada").expect(200);
    // When a student becomes staff, earlier links are invalid, and so are sessions and tokens that began with one.
    server.visitor().post_form(&format!("/welcome/{old}"), "").expect(401);
    ada.get("/api/v1/me").expect(200);
    assert!(set(&admin, "other", "ada", "staff")["link"].is_string(), "the way back in");
    ada.get("/api/v1/me").expect(401);
    // Staff cannot remove administrators or staff of other courses.
    set(&teacher, "physics", "admin", "staff");
    set(&admin, "physics", "colleague", "staff");
    set(&teacher, "physics", "colleague", "student");
    admin.get("/api/v1/me").expect(200);
    colleague.get("/api/v1/me").expect(200);
    link(&teacher, "physics", "admin").expect(403);
    link(&teacher, "physics", "colleague").expect(403);
    // A closed account stays closed until it is opened again.
    admin.send("DELETE", "/api/v1/accounts/colleague", &[], b"").expect(204);
    colleague.get("/api/v1/me").expect(401);
    admin.send("DELETE", "/api/v1/accounts/admin", &[], b"").expect(409);
    let wish = br#"{"name": "Colleague"}"#;
    let again = admin.send("PUT", "/api/v1/accounts/colleague", JSON, wish).expect(200).json();
    let again = again["link"].as_str().expect("a link").rsplit('/').next().expect("a secret").to_owned();
    server.visitor().welcome(&again).get("/api/v1/me").expect(200);
}
