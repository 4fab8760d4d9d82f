//! Tests the work of staff: importing a class, extensions, points by hand, and answers to requests.
use crate::support::{
    engines::{Fresh, on_both_engines},
    server::{Client, JSON, Server, program},
};
use std::time::{Duration, SystemTime};

on_both_engines!(
    a_regrade_fills_no_log,
    a_class_comes_in_by_a_table,
    staff_overrules_answers_and_gives_time,
    late_work_is_taken_and_costs_points,
);

async fn a_class_comes_in_by_a_table(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let csv = [("Content-Type", "text/csv")];
    let path = "/api/v1/courses/physics/members";
    let members = || teacher.get(path).expect(200).json().as_array().expect("a list").len();
    // A wrong line is reported with its number, and no member is added.
    let wrong = teacher.send("POST", path, &csv, b"name,login\nAda,ada\nEve,e v e\n").expect(200).json();
    assert!(wrong[0]["error"].is_null() && wrong[1]["error"].is_string() && wrong[1]["line"] == 3, "{wrong}");
    let wrong = "table=name,login%0AAda,ada%0AEve,e+v+e&import=yes";
    let page = teacher.post_form("/c/physics/members/import", wrong).expect(200).text();
    assert!(page.contains("no member was added"), "{page}");
    let table = "name,login,email,role\nAda,ada,ada@example.org,\nCarol,carol,,staff\nBoss,admin,,staff\n";
    let form = "table=name,login,email,role%0AAda,ada,ada@example.org,%0ACarol,carol,,staff%0ABoss,admin,,staff%0A";
    let page = teacher.post_form("/c/physics/members/import", form).expect(200).text();
    assert!(
        page.contains("3 new, 0 with another role, 0 unchanged") && page.contains("Import these members"),
        "{page}"
    );
    teacher.send("POST", &format!("{path}?preview=true"), &csv, table.as_bytes()).expect(200);
    assert_eq!(members(), 1);
    let imported = teacher.post_form("/c/physics/members/import", &format!("{form}&import=yes")).expect(200).text();
    for part in ["mailto:ada%40example.org?", "data:text/csv", "/welcome/", "data-copy=\"http", "To the members"] {
        assert!(imported.contains(part), "{part}: {imported}");
    }
    assert_eq!(members(), 4);
    let page = teacher.post_form("/c/physics/members/import", &form.replacen("carol,,staff", "carol,,", 1)).expect(200);
    assert!(page.text().contains("0 new, 1 with another role, 2 unchanged"), "{}", page.text());
    let page = imported;
    let link = page.split("<code>").nth(1).and_then(|rest| rest.split('<').next()).expect("a link");
    let ada = server.visitor().welcome(link.rsplit('/').next().expect("a secret"));
    assert_eq!(ada.get("/api/v1/me").expect(200).json()["login"], "ada");
    // A file works like the form, and is on its page: it is previewed first, and ignored columns are listed.
    let file = "--b\r\nContent-Disposition: form-data; name=\"file\"; filename=\"class.csv\"\r\n\r\n\
                Login,Name,Matriculation\ndora,Dora,4711\n\r\n--b--\r\n";
    let page = teacher.get("/c/physics/members/import").expect(200).text();
    assert!(page.contains("action=\"/c/physics/members/table\""), "{page}");
    let form = [("Content-Type", "multipart/form-data; boundary=b")];
    let page = teacher.send("POST", "/c/physics/members/table", &form, file.as_bytes()).expect(200).text();
    assert!(page.contains("not used: Matriculation.") && page.contains("dora,Dora,4711"), "{page}");
    assert_eq!(members(), 4);
    // A name that a spreadsheet would read as a formula is marked as text.
    let formula = "table=name,login%0A%3D1%2B1,mallory%0A&import=yes";
    let page = teacher.post_form("/c/physics/members/import", formula).expect(200).text();
    assert!(
        page.contains("data:text/csv;charset=utf-8,Name%2CLogin%2CE-mail%2CRole%2CLink%0A%27%3D1%2B1%2C"),
        "{page}"
    );
    teacher.send("DELETE", &format!("{path}/mallory"), &[], b"").expect(204);
    // The first line may be a heading that is not known. The preview says so, and programs need no headings.
    let import = |table: &str| teacher.post_form("/c/physics/members/import", table).expect(200).text();
    let page = import("table=who,what%0AFay,fay%0A");
    let note = "Line 1 is read as a member, what. Is it a heading?";
    assert!(page.contains(note) && page.contains("what <span class=\"chip warn\">a heading?"), "{page}");
    for plain in ["table=login,name%0Afay,Fay%0A", "table=Fay,fay,fay@example.org%0A", "table=Ada,ada%0A"] {
        assert!(!import(plain).contains("heading?"), "{plain}");
    }
    let unnamed = teacher.send("POST", &format!("{path}?preview=true"), &csv, b"Fay,fay\n").expect(200).json();
    assert!(unnamed[0]["login"] == "fay" && unnamed[0]["error"].is_null(), "{unnamed}");
    // A repeated import creates nothing.
    let again = teacher.send("POST", path, &csv, table.as_bytes()).expect(200).json();
    assert!(again[0]["link"].is_null() && again[0]["error"].is_null(), "{again}");
    assert_eq!(members(), 4);
    // The log has a line for each member, and its page folds those of an import.
    let many: String = (0..70).map(|number| format!("Student {number},s{number}\n")).collect();
    teacher.send("POST", path, &csv, many.as_bytes()).expect(200);
    let page = teacher.get("/c/physics/audit").expect(200).text();
    assert!(page.contains("<summary>70 similar events, such as: s9 became student</summary>"), "{page}");
    assert!(page.matches("became student</li>").count() == 70 && page.matches("<tr>").count() < 20, "{page}");
}

/// Checks the order of a class, and that the heading of its column shows it.
fn check_order(teacher: &Client) {
    let class = teacher.get("/c/physics/a/m1/class").expect(200).text();
    assert!(
        class.contains("<th scope=\"col\" aria-sort=\"ascending\"><button") && !class.contains("descending"),
        "{class}"
    );
    let class = teacher.get("/c/physics/a/m1/class?sort=points&page=7").expect(200).text();
    assert!(class.find("students/eve") < class.find("students/ada"), "{class}");
    let heading = "<th scope=\"col\" class=\"num\" aria-sort=\"descending\">";
    assert!(class.contains(heading) && class.matches("aria-sort").count() == 1, "{class}");
}

async fn staff_overrules_answers_and_gives_time(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let ada = server.member(&admin, "physics", "ada", "student");
    let eve = server.member(&admin, "physics", "eve", "student");
    let ids: Vec<i64> = [40, 30].map(|points| ada.submit("physics", &program("WA", points))).to_vec();
    for id in &ids {
        ada.wait_for_grade("physics", *id);
    }
    let place = |id: i64| format!("/api/v1/courses/physics/submissions/{id}");
    // The student requests a review, and staff answers with other points.
    ada.post_form(&format!("/c/physics/s/{}/request", ids[1]), "text=The+scene+is+%3Cb%3Eodd%3C/b%3E").expect(303);
    eve.post_json(&format!("{}/request", place(ids[1])), r#"{"text": "me, too"}"#).expect(404);
    ada.post_json(&format!("{}/request", place(ids[1])), r#"{"text": "Is anybody there?"}"#).expect(204);
    let class = teacher.get("/c/physics/a/m1/class").expect(200).text();
    assert!(class.contains("The scene is &#60;b&#62;odd") && class.contains("Is anybody there?"), "{class}");
    assert!(class.contains("<b>40 %</b>mean"), "{class}");
    check_bad_marks(&teacher, &ada, ids[1]);
    teacher.post_form(&format!("/c/physics/s/{}/mark", ids[1]), "points=68%2C5&comment=You+are+right").expect(303);
    assert_eq!(ada.get(&place(ids[1])).expect(200).json()["grade"]["points"], "68.5");
    let page = ada.get(&format!("/c/physics/s/{}", ids[1])).expect(200).text();
    assert!(page.contains("68.5 of 100 points") && page.contains("You are right"), "{page}");
    let words = "Staff gave 68.5 points</strong> instead of the grader's 30 (";
    assert!(page.contains(words) && page.contains("Points in the report are the grader's."), "{page}");
    let class = teacher.get("/c/physics/a/m1/class").expect(200).text();
    assert!(class.contains("68.5 of 100") && !class.contains("odd"), "{class}");
    let table = teacher.get("/api/v1/courses/physics/assignments/m1/export").expect(200).text();
    assert!(table.contains(",points,grader_points,max_points,") && table.contains(",68.5,30,100,"), "{table}");
    // A class is searched, and sorted.
    let eve_handed_in = eve.submit("physics", &program("WA", 90));
    eve.wait_for_grade("physics", eve_handed_in);
    let class = teacher.get("/c/physics/a/m1/class?q=EVE").expect(200).text();
    let has = |login: &str| class.contains(&format!("students/{login}"));
    assert!(class.contains("1 student.") && has("eve") && !has("ada"), "{class}");
    check_order(&teacher);
    check_parts(&server, &admin, &teacher);
    // The wrong scenes of students whose programs ran.
    let dora = server.member(&admin, "physics", "dora", "student");
    let unusable = dora.submit("physics", &program("US", 0));
    dora.wait_for_grade("physics", unusable);
    let class = teacher.get("/c/physics/a/m1/class").expect(200).text();
    let hard = "students\">2</td><td class=\"words\" data-label=\"logins\"><a href=\"/c/physics/a/m1/students/ada";
    assert!(class.contains(hard), "{class}");
    // All attempts are on one page, with the changes of each.
    let mended = eve.submit("physics", &program("AC", 90));
    eve.wait_for_grade("physics", mended);
    let words = "Since submission 1, these became right: Group/hard.";
    assert!(eve.get(&format!("/c/physics/s/{mended}")).expect(200).text().contains(words));
    assert!(teacher.get("/c/physics/a/m1/students/eve").expect(200).text().contains(words));
    check_beside(&teacher, [eve_handed_in, mended]);
    check_request_and_unusable(&teacher, &eve, mended);
    let page = teacher.get("/c/physics/a/m1/students/ada").expect(200).text();
    assert!(page.contains(">Submission 1<") && page.contains(">Submission 2<") && page.contains("40 of 100"), "{page}");
    teacher.send("PUT", &format!("{}/mark", place(ids[1])), JSON, br#"{"comment": "after all"}"#).expect(200);
    assert_eq!(ada.get(&place(ids[1])).expect(200).json()["grade"]["points"], "30");
    check_history(&teacher, &ada, ids[1]);
    // An extension for one student.
    let wish = r#"{"title": "M", "visible": true, "settings": {"per_hour": 0, "due_at": "2026-01-01T00:00Z"}}"#;
    teacher.send("PUT", "/api/v1/courses/physics/assignments/m1", JSON, wish.as_bytes()).expect(200);
    let upload = "/api/v1/courses/physics/assignments/m1/submissions?name=FOSSSim";
    ada.send("POST", upload, &[], &program("AC", 100)).expect(409);
    let extension = "/api/v1/courses/physics/assignments/m1/extensions/ada";
    teacher.send("PUT", extension, JSON, br#"{"due_at": "2096-01-01T00:00Z"}"#).expect(204);
    ada.send("POST", upload, &[], &program("AC", 100)).expect(201);
    eve.send("POST", upload, &[], &program("AC", 100)).expect(409);
    assert!(ada.get("/c/physics/a/m1").expect(200).text().contains("2096-01-01 00:00 UTC"));
    teacher.post_form("/c/physics/a/m1/students/ada/extension", "due=&due_zone=0").expect(303);
    ada.send("POST", upload, &[], &program("AC", 90)).expect(409);
    // No data about it remains when the person is removed.
    teacher.send("PUT", extension, JSON, br#"{"due_at": "2096-01-01T00:00Z"}"#).expect(204);
    admin.send("DELETE", "/api/v1/accounts/ada/data", &[], b"").expect(204);
}

/// Checks that both marks are in the history, and that a comment alone changes no grade.
fn check_history(teacher: &Client, ada: &Client, id: i64) {
    let place = format!("/api/v1/courses/physics/submissions/{id}");
    teacher.send("PUT", &format!("{place}/mark"), JSON, br#"{"comment": "by the way"}"#).expect(200);
    let history = ada.get(&format!("{place}/history")).expect(200).json();
    let changes: Vec<_> = history.as_array().expect("a list")[1..].iter().collect();
    let line = |change: &serde_json::Value| ["by", "reason", "old_points", "new_points"].map(|key| change[key].clone());
    assert_eq!(changes.len(), 2, "{history}");
    assert_eq!(line(changes[0]), ["teacher", "points by hand: You are right", "30", "68.5"]);
    assert_eq!(line(changes[1]), ["teacher", "the grader's points again: after all", "68.5", "30"]);
    let page = ada.get(&format!("/c/physics/s/{id}")).expect(200).text();
    assert!(page.contains(", 68.5 of 100 points</td><td") && page.contains(", 30 of 100 points</td>"), "{page}");
}

/// Checks that the class page filters students by category and by mistake.
fn check_parts(server: &Server, admin: &Client, teacher: &Client) {
    server.member(admin, "physics", "carl", "student");
    for (part, shown) in [("missing", "carl"), ("wrong", "eve"), ("late", ""), ("accepted", "")] {
        let class = teacher.get(&format!("/c/physics/a/m1/class?part={part}")).expect(200).text();
        for login in ["ada", "carl", "eve"] {
            let is_shown = class.contains(&format!("<span class=\"names\">{login}</span>"));
            assert_eq!(is_shown, login == shown || part == "wrong" && login == "ada", "{part} {login}: {class}");
        }
    }
    check_names(server, admin, teacher);
    assert!(teacher.get("/c/physics/a/m1/class?mistake=none").expect(200).text().contains("matches the filter"));
}

/// Checks that a class page names students as its table does, and says how a program ended.
fn check_names(server: &Server, admin: &Client, teacher: &Client) {
    for login in ["dora", "emil"] {
        let student = server.member(admin, "physics", login, "student");
        let id = student.submit("physics", &program("RTE", 5));
        student.wait_for_grade("physics", id);
    }
    let class = teacher.get("/c/physics/a/m1/class").expect(200).text();
    let (same, table) = (class.split("Identical programs").nth(1), class.split("<tbody>").nth(1));
    assert!(same.is_some_and(|same| same.contains("The dora, The emil</summary>")), "{class}");
    assert!(table.is_some_and(|table| table.contains("a step is wrong\">a step is wrong</td>")), "{class}");
    assert!(class.contains("data-copy=\"dora, emil\""), "{class}");
    for login in ["dora", "emil"] {
        admin.send("DELETE", &format!("/api/v1/accounts/{login}/data"), &[], b"").expect(204);
    }
}

/// Checks that a request has the submission's number among those of its owner, and that scenes that did not run are not
/// mentioned.
fn check_request_and_unusable(teacher: &Client, eve: &Client, mended: i64) {
    eve.post_form(&format!("/c/physics/s/{mended}/request"), "text=Is+it").expect(303);
    let class = teacher.get("/c/physics/a/m1/class").expect(200).text();
    assert!(
        class.contains("eve, submission 2</a> <span class=\"names\"><time") && class.contains(": Is it"),
        "{class}"
    );
    let unusable = eve.submit("physics", &program("US", 0));
    eve.wait_for_grade("physics", unusable);
    let page = eve.get(&format!("/c/physics/s/{unusable}")).expect(200).text();
    assert!(page.contains("do what the report says about the file") && !page.contains("o longer right"), "{page}");
}

/// Checks that points need a reason, lie between zero and the maximum, and come from staff.
fn check_bad_marks(teacher: &Client, ada: &Client, id: i64) {
    let mark = format!("/api/v1/courses/physics/submissions/{id}/mark");
    teacher.send("PUT", &mark, JSON, br#"{"points": 10}"#).expect(409);
    for points in ["-1", "1e300", "100.5", "5000"] {
        let wish = format!(r#"{{"points": {points}, "comment": "x"}}"#);
        let refused = teacher.send("PUT", &mark, JSON, wish.as_bytes()).expect(400).text();
        assert!(refused.contains("points must be a number between 0 and 100"), "{refused}");
    }
    let form = "points=101&comment=x";
    let refused = teacher.post_form(&format!("/c/physics/s/{id}/mark"), form).expect(400).text();
    assert!(refused.contains("between 0 and 100"), "{refused}");
    ada.send("PUT", &mark, JSON, br#"{"points": 100, "comment": "x"}"#).expect(403);
}

/// Checks that a submission is compared with one of another student by login, and with the same student's by number.
fn check_beside(teacher: &Client, [one, mended]: [i64; 2]) {
    let page = teacher.get(&format!("/c/physics/s/{one}/beside?with=ada")).expect(200).text();
    assert!(page.contains("Both have the same verdict on every scene") && page.contains("of 100"), "{page}");
    teacher.get(&format!("/c/physics/s/{one}/beside?with=carl")).expect(404);
    teacher.get("/c/physics/a/m1/students/nobody").expect(404);
    let page = teacher.get(&format!("/c/physics/s/{mended}/beside?with=1")).expect(200).text();
    let row = "<tr><th scope=\"row\">Group/hard</th>";
    assert!(page.contains("1 scene differs") && page.contains(row) && page.contains("#scene=Group%2Fhard"), "{page}");
}

async fn late_work_is_taken_and_costs_points(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let ada = server.member(&admin, "physics", "ada", "student");
    let before = SystemTime::now() - Duration::from_secs(36 * 3600);
    let due = before.duration_since(SystemTime::UNIX_EPOCH).expect("a time").as_millis();
    let wish_of = |days: u32, percent: u32| {
        let settings = format!(r#"{{"due_at": {due}, "late_days": {days}, "late_percent": {percent}}}"#);
        format!(r#"{{"title": "M", "visible": true, "settings": {settings}}}"#)
    };
    let set = |days: u32| {
        let wish = wish_of(days, 10);
        teacher.send("PUT", "/api/v1/courses/physics/assignments/m1", JSON, wish.as_bytes())
    };
    set(366).expect(400);
    set(3).expect(200);
    let place = ada.get("/c/physics/a/m1").expect(200).text();
    assert!(place.contains("each late day that has begun takes 10 %"), "{place}");
    let closes = place.split_once("accepted until <time").expect("a time").1;
    assert!(!closes.starts_with(place.split_once("<dd><time").expect("the due date").1.split('<').next().expect("it")));
    let id = ada.submit("physics", &program("AC", 95));
    ada.wait_for_grade("physics", id);
    let seen = || ada.get(&format!("/api/v1/courses/physics/submissions/{id}")).expect(200).json();
    assert_eq!(seen()["late"], serde_json::json!({"days": 2, "percent": 20}));
    assert_eq!(seen()["grade"]["points"], "76");
    let page = ada.get(&format!("/c/physics/s/{id}")).expect(200).text();
    assert!(page.contains("76 of 100 points") && page.contains("2 days late, which deducts 20 %"), "{page}");
    assert!(teacher.get("/c/physics/a/m1/class").expect(200).text().contains("76 of 100"), "staff see the same");
    assert!(teacher.get("/c/physics").expect(200).text().contains("\"accepted\">1<"), "one student has it right");
    assert!(teacher.get("/api/v1/courses/physics/assignments/m1/export").expect(200).text().contains(",76,"));
    // With more time for one student the submission is not late, and points by hand are not reduced.
    let extension = "/api/v1/courses/physics/assignments/m1/extensions/ada";
    teacher.send("PUT", extension, JSON, br#"{"due_at": "2096-01-01T00:00Z"}"#).expect(204);
    assert_eq!((&seen()["grade"]["points"], seen()["late"].is_null()), (&"95".into(), true));
    teacher.send("DELETE", extension, &[], b"").expect(204);
    let mark = format!("/api/v1/courses/physics/submissions/{id}/mark");
    teacher.send("PUT", &mark, JSON, br#"{"points": 90, "comment": "ill"}"#).expect(200);
    assert_eq!(seen()["grade"]["points"], "90");
    teacher.send("PUT", extension, JSON, br#"{"due_at": "2001-01-01T00:00Z"}"#).expect(400);
    teacher.send("PUT", &mark, JSON, b"{}").expect(200);
    assert_eq!(seen()["grade"]["points"], "76");
    // Late days without a deduction.
    let free = wish_of(3, 0);
    teacher.send("PUT", "/api/v1/courses/physics/assignments/m1", JSON, free.as_bytes()).expect(200);
    let place = ada.get("/c/physics/a/m1").expect(200).text();
    assert!(place.contains(", without a deduction.") && !place.contains("0 % of the points"), "{place}");
    assert!(!ada.get(&format!("/c/physics/s/{id}")).expect(200).text().contains("deducts"));
    // The late days are over.
    set(1).expect(200);
    let upload = "/api/v1/courses/physics/assignments/m1/submissions?name=FOSSSim";
    ada.send("POST", upload, &[], &program("AC", 100)).expect(409);
    // When late work is no longer accepted, earlier late work keeps its deduction. A new title changes nothing else.
    set(0).expect(200);
    let wish = br#"{"title": "Another title"}"#;
    let kept = teacher.send("PUT", "/api/v1/courses/physics/assignments/m1", JSON, wish).expect(200).json();
    assert_eq!((&kept["visible"], &kept["settings"]["late_percent"]), (&true.into(), &10.into()));
    assert_eq!(seen()["grade"]["points"], "76");
    // Staff who try the assignment are not in the class.
    let trial = teacher.submit("physics", &program("AC", 20));
    teacher.wait_for_grade("physics", trial);
    let class = teacher.get("/api/v1/courses/physics/assignments/m1/class").expect(200).json();
    assert_eq!(class.as_array().map(Vec::len), Some(1), "{class}");
    // A browser gets a page for a missing address.
    let missing = ada.send("GET", "/nope", &[("accept", "text/html")], b"").expect(404).text();
    assert!(missing.contains("<html"), "{missing}");
}

/// The results of a regrade, and the changed grades after it, each take one line of the log.
async fn a_regrade_fills_no_log(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    for points in 1..=4 {
        let id = ada.submit("physics", &program("WA", points));
        ada.wait_for_grade("physics", id);
    }
    let base = "/api/v1/courses/physics/assignments/m1/regrades";
    let wish = r#"{"reason": "other rules", "settings": {"rules": "parity"}}"#;
    let path = format!("{base}/{}", admin.post_json(base, wish).expect(201).json()["id"]);
    while admin.get(&path).expect(200).json()["left"] != 0 {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    admin.post_json(&format!("{path}/apply"), "").expect(200);
    let page = admin.get("/c/physics/audit").expect(200).text();
    assert_eq!(page.matches("<summary>4 similar events").count(), 2, "{page}");
}
