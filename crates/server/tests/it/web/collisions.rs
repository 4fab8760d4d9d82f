//! Tests that people, workers and the server can work on the same submissions at the same time: no request is rejected
//! because of another, and no two wait for each other.
use crate::support::{
    engines::{Fresh, on_both_engines},
    server::{Client, JSON, Server, program},
};
use fosssim_server::{db::Dialect, values};

on_both_engines!(nobody_is_in_the_way_of_another);

const BASE: &str = "/api/v1/courses/physics";

/// The number of repetitions of each action.
const ROUNDS: usize = 15;

/// Repeats a request. Every request must be answered.
fn often(mut act: impl FnMut(usize) -> Vec<u16>) {
    for round in 0..ROUNDS {
        let failed: Vec<u16> = act(round).into_iter().filter(|status| *status >= 500).collect();
        assert_eq!(failed, Vec::<u16>::new(), "round {round}");
    }
}

/// Begins a regrade, tries to apply it, and discards it if it is not ready.
fn regrade(staff: &Client) -> Vec<u16> {
    let path = format!("{BASE}/assignments/m1/regrades");
    let begun = staff.post_json(&path, r#"{"reason": "again"}"#);
    if begun.status >= 400 {
        return vec![begun.status];
    }
    let path = format!("{path}/{}", begun.json()["id"]);
    let decided =
        ["apply", "apply", "discard"].map(|decision| staff.post_json(&format!("{path}/{decision}"), "").status);
    [vec![begun.status], decided.into()].concat()
}

fn import(staff: &Client, backwards: bool) -> u16 {
    let mut lines: Vec<String> = (0..20).map(|number| format!("Student {number},new{number},,student")).collect();
    if backwards {
        lines.reverse();
    }
    let table = lines.join("\n");
    staff.send("POST", &format!("{BASE}/members"), &[("Content-Type", "text/csv")], table.as_bytes()).status
}

async fn nobody_is_in_the_way_of_another(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "3", "--lease", "2", "--requests-per-minute", "1000000"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let students: Vec<Client> =
        (0..3).map(|number| server.member(&admin, "physics", &format!("s{number}"), "student")).collect();
    for student in &students {
        student.submit("physics", &program("AC", 1));
    }
    std::thread::scope(|scope| {
        let (admin, students) = (&admin, &students);
        for student in students {
            scope.spawn(move || {
                often(|round| {
                    let path = format!("{BASE}/assignments/m1/submissions?name=FOSSSim");
                    let points = u32::try_from(round).expect("few");
                    vec![student.send("POST", &path, &[], &program("WA", points)).status]
                });
            });
        }
        scope.spawn(move || {
            often(|_| {
                let list = students[0].get(&format!("{BASE}/assignments/m1/submissions")).json();
                let Some(last) = list.as_array().and_then(|list| list.last()) else { return Vec::new() };
                let path = format!("{BASE}/submissions/{}", last["id"]);
                let mark = br#"{"points": 3, "comment": "by hand"}"#;
                vec![
                    admin.post_json(&format!("{path}/again"), "").status,
                    admin.send("PUT", &format!("{path}/mark"), JSON, mark).status,
                    admin.send("DELETE", &path, &[], b"").status,
                ]
            });
        });
        scope.spawn(move || {
            often(|round| {
                let wish = r#"{"title": "M1", "visible": true, "settings": {"per_hour": 0}}"#;
                let published = if round % 2 == 0 { "PUT" } else { "DELETE" };
                vec![
                    admin.send("PUT", &format!("{BASE}/assignments/m1"), JSON, wish.as_bytes()).status,
                    admin.send(published, &format!("{BASE}/assignments/m1/published"), &[], b"").status,
                    admin.post_json(&format!("{BASE}/assignments/m1/judge-errors/again"), "").status,
                ]
            });
        });
        for backwards in [false, true] {
            scope.spawn(move || often(|_| vec![import(admin, backwards)]));
        }
        scope.spawn(move || often(|_| regrade(admin)));
    });
    if fresh.database.dialect() == Dialect::Postgres {
        let mut transaction = fresh.database.read().await.expect("a transaction");
        let statement = "SELECT deadlocks AS n FROM pg_stat_database WHERE datname = current_database()";
        let deadlocks = transaction.one(statement, values![]).await.and_then(|row| row.int("n"));
        assert_eq!(deadlocks.expect("a number"), 0, "deadlocks");
    }
}
