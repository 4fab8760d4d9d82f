//! Tests full disks and read-only databases.
use crate::support::{
    disk::{SmallDisk, stored},
    engines::{Fresh, on_sqlite, run},
    server::{JSON, Server, program},
};
use std::{io::Write, time::Instant};

on_sqlite!(uploads_need_room, nothing_is_stored_of_a_refused_upload);

const SUBMISSIONS: &str = "/api/v1/courses/physics/assignments/m1/submissions";

async fn uploads_need_room(fresh: Fresh) {
    // The limit is larger than any disk.
    let mut server = Server::start(&fresh, &["--workers", "0", "--low-water", "1000000000"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let answer = ada.send("POST", SUBMISSIONS, &[], &program("AC", 1)).expect(507).json();
    assert_eq!(answer["type"], "urn:fosssim:no-room", "{answer}");
    assert_eq!(stored(&server), 0);
    server.visitor().get("/ready").expect(200);
}

async fn nothing_is_stored_of_a_refused_upload(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let wish = r#"{"title": "M1", "visible": true, "settings": {"attempts": 1}}"#;
    admin.send("PUT", "/api/v1/courses/physics/assignments/m1", JSON, wish.as_bytes()).expect(200);
    let ada = server.member(&admin, "physics", "ada", "student");
    let key = &[("Idempotency-Key", "one")];
    ada.send("POST", SUBMISSIONS, key, &program("AC", 1)).expect(201);
    let before = stored(&server);
    for points in 2..5 {
        ada.send("POST", SUBMISSIONS, &[], &program("AC", points)).expect(409);
    }
    assert_eq!(stored(&server), before);
    // Sent twice, it is still one submission.
    ada.send("POST", SUBMISSIONS, key, &program("AC", 1)).expect(200);
}

/// When a full disk has free space again, the server writes again without a restart. Its log is on the same disk.
#[test]
fn a_full_disk_heals() {
    run(async {
        let Some(disk) = SmallDisk::mount(24 << 20) else { return };
        let fresh = Fresh::sqlite_in(disk.path()).await;
        let mut server = Server::start_in(&fresh, &["--workers", "0", "--low-water", "0"], disk.path().join("data"));
        let admin = server.admin();
        server.course(&admin, "physics");
        let ada = server.member(&admin, "physics", "ada", "student");
        ada.submit("physics", &program("AC", 1));
        let filler = disk.path().join("filler");
        let mut file = std::fs::File::create(&filler).expect("a file");
        while file.write_all(&[1; 4096]).is_ok() {}
        // Every upload in the meantime is rejected with a reason.
        for number in 0..4 {
            let course = format!(r#"{{"slug": "full{number}", "title": "{}"}}"#, "x".repeat(150));
            assert!(admin.post_json("/api/v1/courses", &course).status >= 500);
            assert!(ada.send("POST", SUBMISSIONS, &[], &program("AC", 2)).status >= 500);
        }
        let visitor = server.visitor();
        visitor.get("/health").expect(200);
        let answer = visitor.get("/ready").expect(503).text();
        assert!(answer.contains("can't be written"), "{answer}");
        drop(file);
        std::fs::remove_file(&filler).expect("room");
        let start = Instant::now();
        while visitor.get("/ready").status != 200 {
            assert!(start.elapsed().as_secs() < 60, "{}", visitor.get("/ready").text());
            std::thread::sleep(std::time::Duration::from_millis(100));
        }
        ada.submit("physics", &program("AC", 3));
        let submissions = ada.get(SUBMISSIONS).expect(200).json();
        assert_eq!(submissions.as_array().map(Vec::len), Some(2), "{submissions}");
    });
}

/// While another server takes over, a database is read-only. The answers state this, and end with that state.
#[test]
fn a_database_that_was_read_only_is_written_again_at_once() {
    run(async {
        let Some(fresh) = Fresh::postgres().await else { return };
        let fresh = fresh.with_tables().await;
        let mut server = Server::start(&fresh, &["--workers", "0"]);
        let admin = server.admin();
        let run = async |statements: [&'static str; 2]| {
            let mut transaction = fresh.database.begin().await.expect("a transaction");
            transaction.execute("SET TRANSACTION READ WRITE", &[]).await.expect("a statement");
            for statement in statements {
                transaction.execute(statement, &[]).await.expect("a statement");
            }
            transaction.commit().await.expect("commit");
        };
        let end_others = "SELECT pg_terminate_backend(pid) FROM pg_stat_activity
            WHERE datname = current_database() AND pid <> pg_backend_pid()";
        let begin = "DO $$ BEGIN EXECUTE format('ALTER DATABASE %I SET default_transaction_read_only = on',
            current_database()); END $$";
        run([begin, end_others]).await;
        for slug in ["one", "two"] {
            let course = format!(r#"{{"slug": "{slug}", "title": "{slug}"}}"#);
            let refused = admin.post_json("/api/v1/courses", &course).expect(503);
            assert!(refused.header("retry-after").is_some(), "{:?}", refused.headers);
        }
        server.visitor().get("/ready").expect(503);
        let end = "DO $$ BEGIN EXECUTE format('ALTER DATABASE %I RESET default_transaction_read_only',
            current_database()); END $$";
        run([end, "SELECT 1"]).await;
        admin.post_json("/api/v1/courses", r#"{"slug": "one", "title": "one"}"#).expect(201);
    });
}
