//! Whose an account is: what staff may do to it, what its person may, and what a token may not.
use crate::support::{
    engines::{Fresh, on_both_engines},
    server::{Client, JSON, Server},
};

on_both_engines!(
    being_in_two_courses_takes_nothing_away,
    what_staff_could_have_planted_ends_when_rights_grow,
    an_account_with_a_password_is_its_persons_own,
    tokens_make_no_further_ways_in,
    a_session_lasts_from_the_last_visit
);

/// Makes somebody a member, and says what is to be handed on.
fn add(by: &Client, course: &str, login: &str, role: &str) -> serde_json::Value {
    let wish = format!(r#"{{"name": "The {login}", "role": "{role}"}}"#);
    by.send("PUT", &format!("/api/v1/courses/{course}/members/{login}"), JSON, wish.as_bytes()).expect(200).json()
}

fn secret(link: &serde_json::Value) -> String {
    link.as_str().expect("a link").rsplit('/').next().expect("a secret").to_owned()
}

fn new_link(by: &Client, course: &str, login: &str) -> crate::support::server::Answer {
    by.post_json(&format!("/api/v1/courses/{course}/members/{login}/link"), "{}")
}

fn new_token(server: &Server, session: &Client) -> Client {
    let token = session.post_json("/api/v1/tokens", r#"{"name": "tests"}"#).expect(201).json();
    server.with_token(token["token"].as_str().expect("a token"))
}

fn courses(person: &Client) -> usize {
    person.get("/api/v1/courses").expect(200).json().as_array().expect("a list").len()
}

async fn being_in_two_courses_takes_nothing_away(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    server.course(&admin, "other");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let colleague = server.member(&admin, "other", "colleague", "staff");
    let made = add(&teacher, "physics", "ada", "student");
    assert!(made["invitation"].is_null());
    let ada = server.visitor().welcome(&secret(&made["link"]));
    let token = new_token(&server, &ada);
    // Staff of another course invites, and nothing changes by that.
    for role in ["staff", "student"] {
        assert!(add(&colleague, "other", "ada", role)["link"].is_null());
    }
    let invitation = secret(&add(&colleague, "other", "ada", "student")["invitation"]);
    ada.get("/api/v1/me").expect(200);
    token.get("/api/v1/me").expect(200);
    assert_eq!(courses(&ada), 1);
    new_link(&colleague, "other", "ada").expect(404);
    new_link(&teacher, "physics", "ada").expect(200);
    let members = colleague.get("/api/v1/courses/other/members").expect(200).json();
    assert_eq!(members[0]["login"], "ada");
    assert_eq!(members[0]["is_invited"], true, "{members}");
    // The person sees it. A link of staff's is not proof enough that it is the person, a token is none.
    assert!(ada.get("/").expect(200).text().contains("colleague invites you into Course other"));
    ada.post_form("/invitations/other/accept", "").expect(403);
    token.post_form(&format!("/invitation/{invitation}"), "").expect(403);
    teacher.post_form(&format!("/invitation/{invitation}"), "").expect(404);
    let page = ada.get(&format!("/invitation/{invitation}")).expect(200).text();
    assert!(page.contains("You are signed in as ada"), "{page}");
    ada.post_form(&format!("/invitation/{invitation}"), "").expect(303);
    ada.get("/c/physics").expect(200);
    ada.get("/c/other").expect(200);
    ada.post_form(&format!("/invitation/{invitation}"), "").expect(404);
    // From now on nobody's staff signs in as her, nor signs her out.
    for (staff, course) in [(&teacher, "physics"), (&colleague, "other")] {
        new_link(staff, course, "ada").expect(403);
        let invitation = secret(&add(staff, course, "ada", "staff")["invitation"]);
        assert!(!invitation.is_empty());
        add(staff, course, "ada", "student");
    }
    ada.get("/api/v1/me").expect(200);
    // The administrator can, and leaves her memberships and session as they are.
    new_link(&admin, "physics", "ada").expect(200);
    assert_eq!(courses(&ada), 2);
    // Her session is her own by now: a button will do, also to say no.
    ada.post_form("/invitations/physics/decline", "").expect(303);
    ada.post_form("/invitations/physics/accept", "").expect(404);
    ada.post_form("/invitations/other/accept", "").expect(303);
    ada.get("/api/v1/courses/other/members").expect(200);
    ada.get("/api/v1/courses/physics/members").expect(403);
}

async fn what_staff_could_have_planted_ends_when_rights_grow(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    server.course(&admin, "other");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let colleague = server.member(&admin, "other", "colleague", "staff");
    for (login, by_admin) in [("ada", false), ("eve", true)] {
        let link = |made: serde_json::Value| server.visitor().welcome(&secret(&made["link"]));
        let student = link(add(&teacher, "physics", login, "student"));
        // The teacher signs in as the student, plants a token, and by that another session.
        let planted = link(new_link(&teacher, "physics", login).expect(200).json());
        let token = new_token(&server, &planted);
        let bearer = token.headers[0].1.strip_prefix("Bearer ").expect("a token").to_owned();
        let cookie = server.visitor().post_form("/sign-in", &format!("token={bearer}")).expect(303);
        let cookie = cookie.header("set-cookie").expect("a cookie").split(';').next().expect("a value").to_owned();
        let by_token = Client { url: server.url.clone(), headers: vec![("Cookie".to_owned(), cookie)] };
        let unused = secret(&new_link(&teacher, "physics", login).expect(200).json()["link"]);
        by_token.get("/api/v1/me").expect(200);
        let student = if by_admin {
            // Nothing proves who is who: all have to come by the administrator's link.
            let added = add(&admin, "other", login, "student");
            student.get("/api/v1/me").expect(401);
            link(added)
        } else {
            let invitation = secret(&add(&colleague, "other", login, "student")["invitation"]);
            student.post_form(&format!("/invitation/{invitation}"), "").expect(303);
            student
        };
        assert_eq!(courses(&student), 2);
        for planted in [&planted, &token, &by_token] {
            planted.get("/api/v1/me").expect(401);
        }
        server.visitor().post_form(&format!("/welcome/{unused}"), "").expect(401);
    }
}

async fn an_account_with_a_password_is_its_persons_own(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0", "--passwords"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let teacher = server.member(&admin, "physics", "teacher", "staff");
    let ada = server.visitor().welcome(&secret(&add(&teacher, "physics", "ada", "student")["link"]));
    let planted = server.visitor().welcome(&secret(&new_link(&teacher, "physics", "ada").expect(200).json()["link"]));
    let token = new_token(&server, &planted);
    ada.send("PUT", "/api/v1/password", JSON, br#"{"new": "correct horse"}"#).expect(204);
    token.get("/api/v1/me").expect(401);
    planted.get("/api/v1/me").expect(401);
    new_link(&teacher, "physics", "ada").expect(403);
    teacher.send("DELETE", "/api/v1/courses/physics/members/ada", &[], b"").expect(204);
    let invitation = add(&teacher, "physics", "ada", "student");
    assert!(invitation["link"].is_null() && invitation["invitation"].is_string(), "{invitation}");
    server.visitor().post_form("/sign-in/password", "login=ada&password=correct+horse").expect(303);
    // An account that is the course's alone is back at once.
    add(&teacher, "physics", "eve", "student");
    teacher.send("DELETE", "/api/v1/courses/physics/members/eve", &[], b"").expect(204);
    assert!(add(&teacher, "physics", "eve", "student")["invitation"].is_null());
    new_link(&teacher, "physics", "eve").expect(200);
}

async fn tokens_make_no_further_ways_in(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0", "--passwords"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let session = server.visitor().welcome(&secret(&add(&admin, "physics", "ada", "student")["link"]));
    let made = session.post_json("/api/v1/tokens", r#"{"name": "leaked"}"#).expect(201).json();
    let bearer = made["token"].as_str().expect("a token");
    let token = server.with_token(bearer);
    let cookie = server.visitor().post_form("/sign-in", &format!("token={bearer}")).expect(303);
    let cookie = cookie.header("set-cookie").expect("a cookie").split(';').next().expect("a value").to_owned();
    let headers = [("Cookie".to_owned(), cookie), ("Sec-Fetch-Site".to_owned(), "same-origin".to_owned())];
    let by_token = Client { url: server.url.clone(), headers: headers.into() };
    for leaked in [&token, &by_token] {
        leaked.get("/api/v1/me").expect(200);
        leaked.post_json("/api/v1/tokens", r#"{"name": "more"}"#).expect(403);
        leaked.post_form("/account/tokens", "name=more").expect(403);
        leaked.send("PUT", "/api/v1/password", JSON, br#"{"new": "correct horse"}"#).expect(403);
        leaked.post_form("/account/password", "new=correct+horse").expect(403);
    }
    // Revoked, it is gone with what it began.
    session.send("DELETE", &format!("/api/v1/tokens/{}", made["id"]), &[], b"").expect(204);
    token.get("/api/v1/me").expect(401);
    by_token.get("/api/v1/me").expect(401);
    // Nor does a browser that was left open make any.
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    transaction.execute("UPDATE session SET created_at = created_at - 50000000", &[]).await.expect("older");
    transaction.commit().await.expect("a commit");
    session.get("/api/v1/me").expect(200);
    let problem = session.post_json("/api/v1/tokens", r#"{"name": "more"}"#).expect(403).json();
    assert_eq!(problem["type"], "urn:fosssim:sign-in-again", "{problem}");
}

async fn a_session_lasts_from_the_last_visit(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let link = server.first_link();
    let session = server.visitor().welcome(&link);
    assert!(session.get("/").expect(200).header("set-cookie").is_none(), "seen a moment ago");
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    transaction.execute("UPDATE session SET seen_at = seen_at - 7200000", &[]).await.expect("older");
    transaction.commit().await.expect("a commit");
    let cookie = session.get("/").expect(200).header("set-cookie").expect("a cookie").to_owned();
    let kept = &session.headers[0].1;
    assert!(cookie.starts_with(kept.as_str()) && cookie.contains("Max-Age=1209600"), "{cookie}");
    // A request that forgot to say who asks is told so, and one from another site that.
    let json = [JSON[0]];
    server.visitor().send("POST", "/api/v1/tokens", &json, br#"{"name": "x"}"#).expect(401);
    let headers = [JSON[0], ("Sec-Fetch-Site", "cross-site"), ("Cookie", kept.as_str())];
    server.visitor().send("POST", "/api/v1/tokens", &headers, br#"{"name": "x"}"#).expect(403);
}
