//! Tests that people sign in from a learning platform, and that their scores are sent there.
use crate::support::{
    engines::{Fresh, on_both_engines, run},
    platform::{CLIENT, DEPLOYMENT, INSTRUCTOR, KEYS, LEARNER, Platform, Trouble, arrive, begin, checked, come},
    server::{Client, JSON, Server, program},
};
use serde_json::{Value, json};

on_both_engines!(
    a_course_of_a_platform,
    a_platform_with_troubles,
    rosters_are_read_to_their_end,
    many_scores_make_one_column,
);

pub(super) const CONTEXT: &str = "https://purl.imsglobal.org/spec/lti/claim/context";
pub(super) const RESOURCE: &str = "https://purl.imsglobal.org/spec/lti/claim/resource_link";
const CUSTOM: &str = "https://purl.imsglobal.org/spec/lti/claim/custom";
const ENDPOINT: &str = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint";

pub(super) async fn start(fresh: &Fresh, more: &[&str]) -> (Server, Client, Platform) {
    let options = ["--workers", "1", "--public-url", "https://grades.example.org", "--lti-over-http"];
    let mut server = Server::start(fresh, &[&options[..], more].concat());
    let link = server.first_link();
    let session = server.visitor().welcome(&link);
    let token = session.post_json("/api/v1/tokens", r#"{"name": "tests"}"#).expect(201).json();
    let admin = server.with_token(token["token"].as_str().expect("a token"));
    let platform = Platform::start(&server, &admin).await;
    (server, admin, platform)
}

/// Connects the platform's course with a new one as its teacher, creates an assignment, and chooses it for the link.
pub(super) fn connect(server: &Server, platform: &Platform) -> Client {
    let (teacher, place) = arrive(server, platform, ("teacher", INSTRUCTOR), |_| {});
    let page = teacher.get(&place).expect(200).text();
    assert!(page.contains("Physics &#60;1&#62;") && page.contains(r#"value="phys-1""#), "{page}");
    teacher.post_form(&format!("{place}/course"), "slug=physics&title=Physics").expect(303);
    // The assignment can be created during the choice.
    assert!(teacher.get(&place).expect(200).text().contains("A new assignment"));
    let wish = r#"{"title": "Milestone one", "visible": true, "settings": {"per_hour": 0}}"#;
    teacher.send("PUT", "/api/v1/courses/physics/assignments/m1", JSON, wish.as_bytes()).expect(200);
    // The form of the earlier page can still be sent.
    let chosen = teacher.post_form(&format!("{place}/assignment"), "assignment=m1").expect(303);
    assert_eq!(chosen.header("location"), Some("/c/physics/a/m1#done"));
    teacher
}

async fn a_course_of_a_platform(fresh: Fresh) {
    let (server, admin, platform) = start(&fresh, &["--tries", "1"]).await;
    // Before a teacher has opened the link, nobody can sign in, and no account is created.
    let begun = begin(&server, &platform);
    let token = KEYS[0].sign(&platform.claims(&begun.nonce, "ada", LEARNER));
    let early = come(&server, &begun, &token).expect(403).text();
    assert!(early.contains("not connected with the grading server yet"), "{early}");
    assert!(early.contains("ask your teacher to open this link once"), "{early}");
    let teacher = connect(&server, &platform);
    assert!(!admin.get("/api/v1/accounts").expect(200).text().contains("ada"));
    let (_, place) = arrive(&server, &platform, ("teacher", INSTRUCTOR), |_| {});
    assert_eq!(place, "/c/physics/a/m1", "chosen once");
    let (ada, place) = arrive(&server, &platform, ("ada", LEARNER), |_| {});
    assert_eq!(place, "/c/physics/a/m1");
    assert!(ada.get(&place).expect(200).text().contains("Milestone one"));
    let me = ada.get("/api/v1/me").expect(200).json();
    assert_eq!([&me["login"], &me["name"]], ["ada", "The ada"]);
    ada.get("/api/v1/courses/physics/members").expect(403);
    let members = teacher.get("/api/v1/courses/physics/members").expect(200).text();
    assert!(members.contains(r#""login":"ada","name":"The ada","role":"student""#), "{members}");

    // Points are sent to a column that the service creates once. The better submission counts.
    let first = ada.submit("physics", &program("WA", 40));
    ada.wait_for_grade("physics", first);
    let score = platform.wait_for("ada", |score| score["scoreGiven"] == 40.0);
    assert_eq!([&score["scoreMaximum"], &score["userId"]], [&json!(100.0), &json!("ada")]);
    assert_eq!([&score["activityProgress"], &score["gradingProgress"]], ["Completed", "FullyGraded"]);
    for points in [80, 60] {
        let id = ada.submit("physics", &program("WA", points));
        ada.wait_for_grade("physics", id);
    }
    platform.wait_for("ada", |score| score["scoreGiven"] == 80.0);
    // The grader's own failure is never sent as a zero, and reduces no score.
    let (eve, _) = arrive(&server, &platform, ("eve", LEARNER), |_| {});
    let failed = eve.submit("physics", b"#!grade JE 0\n");
    assert_eq!(eve.wait_for_grade("physics", failed)["state"], "buried");
    let score = platform.wait_for("eve", |score| score["gradingProgress"] == "PendingManual");
    assert!(score.get("scoreGiven").is_none() && score["activityProgress"] == "Submitted", "{score}");
    let failed = ada.submit("physics", b"#!grade JE 0\n");
    ada.wait_for_grade("physics", failed);
    // A submission of the teacher does not create a score.
    let tried = teacher.submit("physics", &program("AC", 100));
    teacher.wait_for_grade("physics", tried);

    // An applied regrade sends the new scores. By these rules every score is half as large.
    let base = "/api/v1/courses/physics/assignments/m1";
    let wish = r#"{"reason": "other rules", "settings": {"rules": "parity", "per_hour": 0}}"#;
    let regrade = teacher.post_json(&format!("{base}/regrades"), wish).expect(201).json();
    let path = format!("{base}/regrades/{}", regrade["id"]);
    while teacher.get(&path).expect(200).json()["left"] != 0 {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    assert_eq!(platform.wait_for("ada", |_| true)["scoreGiven"], 80.0, "not before it is applied");
    teacher.post_json(&format!("{path}/apply"), "").expect(200);
    platform.wait_for("ada", |score| score["scoreGiven"] == 40.0);
    {
        let inside = platform.inside();
        assert_eq!(inside.line_items.len(), 1, "{:?}", inside.line_items);
        assert_eq!(inside.line_items[0]["resourceLinkId"], "link");
        let zeros = inside.scores.iter().filter(|(_, score)| score["scoreGiven"] == 0.0).count();
        let teachers = inside.scores.iter().filter(|(_, score)| score["userId"] == "teacher").count();
        assert_eq!((zeros, teachers), (0, 0), "{:?}", inside.scores);
        assert!(inside.token_requests <= 3, "tokens are used as long as they last");
    }
    let scores = teacher.get(&format!("{base}/scores")).expect(200).json();
    assert_eq!([&scores[0]["login"], &scores[0]["platform"]], ["ada", "lms"]);
    let page = teacher.get("/c/physics/a/m1/class").expect(200).text();
    assert!(page.contains("40 of 100") && page.contains("staff must check the submission"), "{page}");
    // A score that is sent again is newer than all earlier ones.
    let before = platform.wait_for("ada", |_| true)["timestamp"].clone();
    teacher.post_form("/c/physics/a/m1/scores", "").expect(303);
    platform.wait_for("ada", |score| score["timestamp"].as_str() > before.as_str());

    // The platform is disconnected, so nobody can sign in from it, and no scores are sent to it.
    admin.send("DELETE", "/api/v1/platforms/lms", &[], b"").expect(204);
    let query = format!("iss={}&login_hint=x", platform.url.replace(':', "%3A"));
    server.visitor().get(&format!("/lti/login?{query}")).expect(403);
    ada.get("/c/physics").expect(200);
}

async fn a_platform_with_troubles(fresh: Fresh) {
    let (server, _admin, platform) = start(&fresh, &["--lease", "3"]).await;
    let teacher = connect(&server, &platform);
    let (ada, _) = arrive(&server, &platform, ("ada", LEARNER), |_| {});
    platform.inside().troubles.extend([
        Trouble::Status(500),
        Trouble::Busy(1),
        Trouble::Forgets,
        Trouble::Lost,
        Trouble::Status(403),
    ]);
    let id = ada.submit("physics", &program("WA", 40));
    ada.wait_for_grade("physics", id);
    platform.wait_for("ada", |score| score["scoreGiven"] == 40.0);
    let base = "/api/v1/courses/physics/assignments/m1/scores";
    let taken = || -> Vec<Value> {
        loop {
            let scores = teacher.get(base).expect(200).json();
            let scores = scores.as_array().expect("a list");
            if !scores.is_empty() && scores.iter().all(|score| score["sent_at"].is_i64()) {
                return scores.clone();
            }
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
    };
    assert_eq!(taken().len(), 1);
    {
        let inside = platform.inside();
        assert!(inside.troubles.is_empty(), "{:?}", inside.troubles);
        // The score whose answer was lost arrived twice, with the same time.
        let of_forty: Vec<&Value> =
            inside.scores.iter().filter(|(_, score)| score["scoreGiven"] == 40.0).map(|(_, score)| score).collect();
        assert!(of_forty.iter().all(|score| score["timestamp"] == of_forty[0]["timestamp"]), "{of_forty:?}");
    }
    // A column on a host that is not configured is never requested, and staff see the reason.
    let elsewhere = |claims: &mut Value| {
        claims[RESOURCE]["id"] = json!("other");
        claims[CUSTOM] = json!({"assignment": "m1"});
        claims[ENDPOINT]["lineitem"] = json!("http://169.254.169.254/latest/meta-data");
    };
    let (bob, place) = arrive(&server, &platform, ("bob", LEARNER), elsewhere);
    assert_eq!(place, "/c/physics/a/m1", "the link names its assignment");
    let id = bob.submit("physics", &program("WA", 10));
    bob.wait_for_grade("physics", id);
    let start = std::time::Instant::now();
    loop {
        let scores = teacher.get(base).expect(200).text();
        if scores.contains("not one of the platform's hosts") {
            break;
        }
        assert!(start.elapsed() < std::time::Duration::from_secs(120), "{scores}");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let log = server.log();
    assert!(!log.contains('\u{1b}'), "words of a platform give no orders to terminals");
}

async fn many_scores_make_one_column(fresh: Fresh) {
    let (server, _admin, platform) = start(&fresh, &[]).await;
    connect(&server, &platform);
    platform.inside().slow_columns = true;
    let students: Vec<Client> =
        (0..8).map(|number| arrive(&server, &platform, (&format!("student{number}"), LEARNER), |_| {}).0).collect();
    let handed_in: Vec<i64> = students.iter().map(|student| student.submit("physics", &program("WA", 40))).collect();
    for (student, id) in students.iter().zip(handed_in) {
        student.wait_for_grade("physics", id);
    }
    for number in 0..8 {
        platform.wait_for(&format!("student{number}"), |score| score["scoreGiven"] == 40.0);
    }
    let columns = platform.inside().line_items.clone();
    assert_eq!(columns.len(), 1, "{columns:?}");
}

/// Returns a member of a platform's roster.
fn member(id: &str, role: &str, status: &str) -> Value {
    json!({"user_id": id, "status": status, "roles": [role], "given_name": "Given", "family_name": id})
}

async fn rosters_are_read_to_their_end(fresh: Fresh) {
    let (server, admin, platform) = start(&fresh, &[]).await;
    let teacher = connect(&server, &platform);
    let (ada, _) = arrive(&server, &platform, ("ada", LEARNER), |_| {});
    platform.inside().members = vec![
        member("teacher", INSTRUCTOR, "Active"),
        member("ada", LEARNER, "Active"),
        member("bob", LEARNER, "Active"),
        member("gone", LEARNER, "Inactive"),
        member("parent", "http://purl.imsglobal.org/vocab/lis/v2/membership#Mentor", "Active"),
        member("tutor", "http://purl.imsglobal.org/vocab/lis/v2/membership/Instructor#TeachingAssistant", "Active"),
        member("carol", LEARNER, "Active"),
    ];
    let read = teacher.post_json("/api/v1/courses/physics/roster", "").expect(200).json();
    assert_eq!([&read["members"], &read["left"]], [5, 0]);
    assert_eq!(read["comes"].as_array().map(Vec::len), Some(3), "{read}");
    let members = || -> Vec<String> {
        let members = teacher.get("/api/v1/courses/physics/members").expect(200).json();
        let line =
            |member: &Value| format!("{} {}", member["name"].as_str().unwrap(), member["role"].as_str().unwrap());
        members.as_array().expect("a list").iter().map(line).collect()
    };
    let all =
        ["Given ada student", "Given bob student", "Given carol student", "Given teacher staff", "Given tutor staff"];
    let sorted = |mut lines: Vec<String>| {
        lines.sort();
        lines
    };
    assert_eq!(sorted(members()), all);
    // A student who is first known from the roster has the same account at the first visit.
    let (bob, _) = arrive(&server, &platform, ("bob", LEARNER), |_| {});
    bob.get("/c/physics").expect(200);
    // Staff made one of them staff here, and made a person from no platform a student. Both keep their roles.
    let wish = br#"{"name": "x", "role": "staff"}"#;
    let login = bob.get("/api/v1/me").expect(200).json()["login"].as_str().expect("a login").to_owned();
    teacher.send("PUT", &format!("/api/v1/courses/physics/members/{login}"), JSON, wish).expect(200);
    teacher
        .send("PUT", "/api/v1/courses/physics/members/local", JSON, br#"{"name": "Local", "role": "student"}"#)
        .expect(200);
    platform.inside().members.retain(|member| member["user_id"] != "carol");
    let read = teacher.post_json("/api/v1/courses/physics/roster", "").expect(200).json();
    assert_eq!([&read["members"], &read["left"]], [4, 1]);
    // A filter or a fault of the platform removes nobody, and the person who reads the roster is never removed.
    let whole = std::mem::take(&mut platform.inside().members);
    for question in ["", "?confirm=true"] {
        let path = format!("/api/v1/courses/physics/roster{question}");
        assert_eq!(teacher.post_json(&path, "").expect(200).json()["left"], 0, "a list of nobody changes nothing");
    }
    platform.inside().members = whole.iter().filter(|member| member["user_id"] == "bob").cloned().collect();
    let refused = teacher.post_json("/api/v1/courses/physics/roster", "").expect(409).json();
    assert!(
        refused["detail"].as_str().is_some_and(|said| said.starts_with("2 of 5 members would leave: ")),
        "{refused}"
    );
    let page = teacher.post_form("/c/physics/members/roster", "").expect(200).text();
    let said = ["<dt>Leave: 2</dt>", "Given tutor (", "remove 2"];
    assert!(said.iter().all(|words| page.contains(words)), "{page}");
    let preview = teacher.post_json("/api/v1/courses/physics/roster?preview=true", "").expect(200).json();
    assert_eq!(preview["goes"].as_array().map(Vec::len), Some(2), "{preview}");
    platform.inside().members = whole;
    let left = ["Given ada student", "Given bob staff", "Given teacher staff", "Given tutor staff", "Local student"];
    assert_eq!(sorted(members()), left);
    // A student who becomes staff signs in again. Earlier sessions of the account have ended.
    let (now_staff, _) = arrive(&server, &platform, ("ada", INSTRUCTOR), |_| {});
    ada.get("/api/v1/me").expect(401);
    now_staff.get("/api/v1/courses/physics/members").expect(200);
    // A platform cannot make anybody an administrator of this server.
    let account = now_staff.get("/api/v1/me").expect(200).json()["login"].as_str().expect("a login").to_owned();
    let wish = br#"{"name": "Ada", "is_admin": true}"#;
    admin.send("PUT", &format!("/api/v1/accounts/{account}"), JSON, wish).expect(200);
    let begun = begin(&server, &platform);
    let token = KEYS[0].sign(&platform.claims(&begun.nonce, "ada", INSTRUCTOR));
    assert!(come(&server, &begun, &token).expect(403).text().contains("sign in on its own pages"));
    // A list without an end is rejected, and changes nothing.
    let done = teacher.post_form("/c/physics/members/roster", "confirm=yes").expect(200).text();
    assert!(done.contains(" joined, ") && done.contains(" left."), "{done}");
    platform.inside().published.clear();
    assert!(teacher.get("/c/physics/members").expect(200).text().contains("Read the members from lms"));
}

#[test]
fn platforms_change_their_keys() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite");
        let (server, _, platform) = start(&fresh, &[]).await;
        connect(&server, &platform);
        assert_eq!(platform.inside().key_reads, 1, "read once");
        // An unknown key is requested from the platform, but not for every invented key.
        for _ in 0..20 {
            let begun = begin(&server, &platform);
            let header = json!({"alg": "RS256", "kid": "made up"});
            let token = KEYS[0].sign_as(&header, &platform.claims(&begun.nonce, "ada", LEARNER));
            come(&server, &begun, &token).expect(403);
        }
        let reads = platform.inside().key_reads;
        assert!(reads <= 3, "{reads}");
        platform.inside().published = vec![0, 1];
        let start = std::time::Instant::now();
        loop {
            let begun = begin(&server, &platform);
            let token = KEYS[1].sign(&platform.claims(&begun.nonce, "ada", LEARNER));
            if come(&server, &begun, &token).status == 303 {
                break;
            }
            assert!(start.elapsed() < std::time::Duration::from_secs(60), "the new key is never believed");
            std::thread::sleep(std::time::Duration::from_millis(100));
        }
    });
}

#[test]
fn links_are_chosen_in_the_platform() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite");
        let (server, admin, platform) = start(&fresh, &[]).await;
        connect(&server, &platform);
        let wanted = |claims: &mut Value| {
            let claims = claims.as_object_mut().expect("claims");
            claims.remove(RESOURCE);
            claims.insert(
                "https://purl.imsglobal.org/spec/lti/claim/message_type".to_owned(),
                json!("LtiDeepLinkingRequest"),
            );
            let settings = json!({"deep_link_return_url": format!("{}/return?course=1", platform.url),
                "accept_types": ["link", "ltiResourceLink"], "data": "sent back"});
            claims.insert("https://purl.imsglobal.org/spec/lti-dl/claim/deep_linking_settings".to_owned(), settings);
        };
        let (teacher, place) = arrive(&server, &platform, ("teacher", INSTRUCTOR), wanted);
        let answer = teacher.post_form(&format!("{place}/assignment"), "assignment=m1").expect(200);
        let policy = answer.header("content-security-policy").expect("a policy");
        assert!(policy.contains(&format!("form-action 'self' {};", platform.url)), "{policy}");
        let page = answer.text();
        assert!(page.contains(&format!("action=\"{}/return?course=1\"", platform.url)), "{page}");
        let token =
            page.split("name=\"JWT\" value=\"").nth(1).and_then(|rest| rest.split('"').next()).expect("a token");
        let keys = server.visitor().get("/lti/keys.json").expect(200).json();
        let claims = checked(token, &keys);
        assert_eq!([&claims["iss"], &claims["aud"][0]], [CLIENT, platform.url.as_str()]);
        assert_eq!(claims["https://purl.imsglobal.org/spec/lti/claim/deployment_id"], DEPLOYMENT);
        assert_eq!(claims["https://purl.imsglobal.org/spec/lti-dl/claim/data"], "sent back");
        let item = &claims["https://purl.imsglobal.org/spec/lti-dl/claim/content_items"][0];
        assert_eq!(item["url"], "https://grades.example.org/lti/launch");
        // The link that the platform creates opens the assignment without a further choice.
        let chosen = |claims: &mut Value| {
            claims[RESOURCE]["id"] = json!("chosen");
            claims[CUSTOM] = item["custom"].clone();
        };
        let (_, place) = arrive(&server, &platform, ("ada", LEARNER), chosen);
        assert_eq!(place, "/c/physics/a/m1");
        // Students cannot choose an assignment, and nobody can choose for another person.
        let begun = begin(&server, &platform);
        let mut claims = platform.claims(&begun.nonce, "ada", LEARNER);
        wanted(&mut claims);
        come(&server, &begun, &KEYS[0].sign(&claims)).expect(403);
        let (_, place) = arrive(&server, &platform, ("teacher", INSTRUCTOR), wanted);
        admin.get(&place).expect(404);
        // A hidden assignment is created during the choice. A name that is taken changes nothing.
        let made = "assignment=&suite=&title=Milestone+two";
        teacher.post_form(&format!("{place}/assignment"), made).expect(200);
        let two = admin.get("/api/v1/courses/physics/assignments/milestone-two").expect(200).json();
        assert_eq!((&two["title"], &two["visible"]), (&json!("Milestone two"), &json!(false)));
        let (teacher, place) = arrive(&server, &platform, ("teacher", INSTRUCTOR), wanted);
        teacher.post_form(&format!("{place}/assignment"), made).expect(409);
        // The answer is sent only to the platform.
        let elsewhere = |claims: &mut Value| {
            wanted(claims);
            claims["https://purl.imsglobal.org/spec/lti-dl/claim/deep_linking_settings"]["deep_link_return_url"] =
                json!("https://evil.example/return");
        };
        let (teacher, place) = arrive(&server, &platform, ("teacher", INSTRUCTOR), elsewhere);
        let refused = teacher.post_form(&format!("{place}/assignment"), "assignment=m1").expect(403).text();
        assert!(refused.contains("is not configured"), "{refused}");

        // A new key is published next to the key that signs.
        admin.post_json("/api/v1/platform-keys", "").expect(204);
        let newly = server.visitor().get("/lti/keys.json").expect(200).json();
        assert_eq!(newly["keys"].as_array().map(Vec::len), Some(2));
        assert!(newly["keys"].as_array().expect("keys").contains(&keys["keys"][0]));
        assert!(!newly.to_string().contains("\"d\""), "no private part");
        for _ in 0..2 {
            admin.post_form("/admin/platform-keys", "").expect(303);
        }
        let later = server.visitor().get("/lti/keys.json").expect(200).json();
        assert_eq!(later["keys"].as_array().map(Vec::len), Some(2));
    });
}

#[test]
fn frames_and_cookies_are_as_platforms_need_them() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite");
        let (server, _, platform) = start(&fresh, &[]).await;
        let cookie = begin(&server, &platform).cookie;
        assert!(cookie.starts_with("__Host-fosssim-lti="), "{cookie}");
        for word in ["; Path=/", "; HttpOnly", "; SameSite=None", "; Secure", "; Partitioned", "; Max-Age=600"] {
            assert!(cookie.contains(word), "{cookie}");
        }
        // In a frame, a button opens a window, which sends the same request.
        let query = format!("iss={}&login_hint=a%22%3E&client_id={CLIENT}", platform.url.replace(':', "%3A"));
        let framed = server.visitor().send("GET", &format!("/lti/login?{query}"), &[("Sec-Fetch-Dest", "iframe")], b"");
        let framed = framed.expect(200);
        assert!(framed.header("set-cookie").is_none());
        let policy = framed.header("content-security-policy").expect("a policy").to_owned();
        assert!(policy.contains(&format!("frame-ancestors {}", platform.url)), "{policy}");
        let page = framed.text();
        assert!(page.contains("target=\"_blank\"") && page.contains("login_hint=a%22%3E&#38;client_id="), "{page}");
        // Some platforms begin with POST.
        let headers = [("Content-Type", "application/x-www-form-urlencoded"), ("Sec-Fetch-Site", "cross-site")];
        server.visitor().send("POST", "/lti/login", &headers, query.as_bytes()).expect(303);
        let configuration = server.visitor().get("/lti/configuration.json").expect(200).json();
        assert_eq!(configuration["oidc_initiation_url"], "https://grades.example.org/lti/login");
    });
}

#[test]
fn platforms_are_reached_by_https_only() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite");
        let mut server = Server::start(&fresh, &["--workers", "0"]);
        let admin = server.admin();
        let mut wish = json!({
            "issuer": "https://moodle.example.org",
            "client_id": "abc",
            "login_url": "https://moodle.example.org/mod/lti/auth.php",
            "token_url": "https://moodle.example.org/mod/lti/token.php",
            "keys_url": "https://moodle.example.org/mod/lti/certs.php",
            "deployments": ["1"],
        });
        let put = |name: &str, wish: &Value| {
            admin.send("PUT", &format!("/api/v1/platforms/{name}"), JSON, wish.to_string().as_bytes())
        };
        put("moodle", &wish).expect(200);
        for (field, value) in [
            ("keys_url", "http://127.0.0.1:5432/"),
            ("token_url", "http://169.254.169.254/"),
            ("login_url", "javascript:alert(1)"),
            ("keys_url", "file:///etc/passwd"),
        ] {
            let mut wrong = wish.clone();
            wrong[field] = json!(value);
            put("other", &wrong).expect(400);
        }
        // Each issuer and client can be registered once, and a registration's issuer cannot change.
        put("other", &wish).expect(409);
        wish["issuer"] = json!("https://evil.example");
        put("moodle", &wish).expect(409);
        let page = admin.get("/admin/platforms").expect(200).text();
        assert!(page.contains("/lti/login</code>") && page.contains("https://moodle.example.org"), "{page}");
        // Without HTTPS, the browser would not send the cookie with the platform's answer.
        let answer = server.visitor().get("/lti/login?iss=https%3A%2F%2Fmoodle.example.org&login_hint=x").expect(409);
        assert!(answer.text().contains("--public-url"), "{}", answer.text());
        let form = "name=canvas&issuer=https://canvas.instructure.com&client_id=1&login_url=https://sso.canvaslms.com/a\
            &token_url=https://sso.canvaslms.com/t&keys_url=https://sso.canvaslms.com/k&deployments=1%3Aab,+2%3Acd\
            &hosts=school.instructure.com";
        admin.post_form("/admin/platforms", form).expect(303);
        let platforms = admin.get("/api/v1/platforms").expect(200).json();
        assert_eq!(platforms[0]["deployments"], json!(["1:ab", "2:cd"]));
        admin.post_form("/admin/platforms/canvas/shut", "").expect(303);
        assert_eq!(admin.get("/api/v1/platforms").expect(200).json().as_array().map(Vec::len), Some(1));
    });
}
