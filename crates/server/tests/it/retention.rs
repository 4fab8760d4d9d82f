//! Tests that expired files are removed, and no other files.
use crate::support::{
    engines::{Fresh, on_both_engines, run},
    server::{Server, program},
};
use fosssim_server::{
    retention,
    store::{Digest, Store, StoreError},
    values,
};
use std::{collections::HashSet, time::Duration};

on_both_engines!(old_uploads_go_and_grades_stay);

/// Returns those of the digests that the test declares as referenced.
fn named(
    digests: Vec<Digest>,
    is_named: impl FnMut(&Digest) -> bool,
) -> std::future::Ready<Result<HashSet<Digest>, StoreError>> {
    std::future::ready(Ok(digests.into_iter().filter(is_named).collect()))
}

async fn old_uploads_go_and_grades_stay(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "1"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let (old, new) = (ada.submit("physics", &program("WA", 40)), ada.submit("physics", &program("AC", 100)));
    for id in [old, new] {
        ada.wait_for_grade("physics", id);
    }
    let waiting = ada.submit("physics", b"#!grade HANG 0\n");
    let store = Store::folder(&server.folder.join("store")).expect("the store");
    let give_up = async |days: u64| {
        retention::remove_expired(&fresh.database, &store, Some(Duration::from_secs(days * 86400)), Duration::ZERO)
            .await
            .expect("done")
    };
    // No file is that old.
    let found = give_up(1).await;
    assert_eq!((found.submissions, found.artifacts), (0, 0), "what is named stays, however old the file");
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    let statement = "UPDATE submission SET created_at = created_at - 172800000 WHERE id <> ?";
    transaction.execute(statement, values![new]).await.expect("a statement");
    transaction.commit().await.expect("commit");
    let found = give_up(1).await;
    assert_eq!(found.submissions, 1, "what is being graded stays");
    // Equal reports of other submissions are stored once, and are kept.
    assert!(found.artifacts >= 2, "the upload and its grade: {found:?}");
    assert_eq!(give_up(1).await, retention::RemovalCounts::default(), "once");
    // The grade and its history remain. The bytes are removed, and the page states this.
    let path = |id: i64, rest: &str| format!("/api/v1/courses/physics/submissions/{id}{rest}");
    let submission = ada.get(&path(old, "")).expect(200).json();
    assert_eq!(submission["grade"]["points"], "40");
    assert_eq!(submission["grade"]["files"], serde_json::json!([]));
    assert!(ada.get(&path(old, "/history")).expect(200).text().contains("graded"));
    let gone = ada.get(&path(old, "/upload")).expect(410);
    assert!(gone.text().contains("urn:fosssim:removed"), "{}", gone.text());
    ada.get(&path(old, "/files/report.txt")).expect(410);
    assert!(ada.get(&format!("/c/physics/s/{old}")).expect(200).text().contains("reports were removed"));
    assert_eq!(ada.get(&path(new, "/upload")).expect(200).body, program("AC", 100));
    ada.get(&path(new, "/files/report.txt")).expect(200);
    ada.get(&path(waiting, "/upload")).expect(200);
    assert!(!store.has(&Digest::from_bytes(&program("WA", 40))).await.expect("the store"));
    // If the same bytes are submitted again, they are an ordinary submission.
    let again = ada.submit("physics", &program("WA", 40));
    assert_eq!(ada.get(&path(again, "/upload")).expect(200).body, program("WA", 40));
    // A regrade leaves out submissions that can no longer be graded.
    let regrade = admin.post_json("/api/v1/courses/physics/assignments/m1/regrades", r#"{"reason": "to see"}"#);
    assert_eq!(regrade.expect(201).json()["submissions"], 3);
    let audit = admin.get("/api/v1/audit").expect(200).text();
    assert!(audit.contains("uploads and reports of 1 submissions were removed"), "{audit}");
}

#[test]
fn what_somebody_stores_meanwhile_is_not_lost() {
    run(async {
        let folder = tempfile::tempdir().expect("a folder");
        let store = Store::folder(folder.path()).expect("a store");
        let one = crate::support::put(&store, b"one").await.digest;
        let two = crate::support::put(&store, b"two").await.digest;
        let place =
            |kept: &str, name: &Digest| folder.path().join(kept).join(&name.as_str()[..2]).join(&name.as_str()[2..]);
        let age = |file: &std::path::Path, hours: u64| {
            let then = std::time::SystemTime::now() - Duration::from_secs(hours * 3600);
            let file = std::fs::File::options().write(true).open(file).expect("the file");
            file.set_modified(then).expect("a time");
        };
        age(&place("sha256", &one), 48);
        age(&place("sha256", &two), 48);
        // After it is stored again, the artifact is young, because the database may be about to refer to it.
        crate::support::put(&store, b"two").await;
        let day = Duration::from_secs(24 * 3600);
        // Incomplete files: one that a killed server left behind, and one that another server is writing.
        let part = |end: &str| place("sha256", &two).with_file_name(format!("{}#{end}", &two.as_str()[2..]));
        for (end, hours) in [("1", 48), ("2", 1)] {
            std::fs::write(part(end), b"tw").expect("written");
            age(&part(end), hours);
        }
        assert_eq!(
            store.remove_unreferenced(day, |digests| named(digests, |_| false)).await.expect("done"),
            1,
            "the old part"
        );
        assert!(!part("1").exists() && part("2").exists());
        // A file in the trash is kept for a day, and can still be read.
        assert_eq!(crate::support::bytes(&store, &one).await, b"one");
        age(&place("aside", &one), 25);
        assert_eq!(store.remove_unreferenced(day, |digests| named(digests, |_| false)).await.expect("done"), 1);
        assert!(!store.has(&one).await.expect("the store") && store.has(&two).await.expect("the store"));
        // A file that a killed server had moved to the trash is restored when a row refers to it.
        age(&place("sha256", &two), 48);
        std::fs::create_dir_all(place("aside", &two).parent().expect("a folder")).expect("a folder");
        std::fs::rename(place("sha256", &two), place("aside", &two)).expect("moved");
        assert_eq!(
            store.remove_unreferenced(day, |digests| named(digests, |name| *name == two)).await.expect("done"),
            0
        );
        assert_eq!(crate::support::bytes(&store, &two).await, b"two");
    });
}

/// The same tests in a bucket, where a file in the trash begins a new age, and a server with workers on a bucket.
#[cfg(feature = "s3")]
mod bucket {
    use super::*;
    use fosssim_testing::{Need, skip};
    use std::process::{Child, Command, Stdio};

    struct Moto(Child);

    impl Drop for Moto {
        fn drop(&mut self) {
            drop(self.0.kill());
            drop(self.0.wait());
        }
    }

    /// Starts a server that answers like S3, with a bucket; `None` if it is not installed.
    fn start() -> Option<(Moto, String)> {
        let port =
            std::net::TcpListener::bind("127.0.0.1:0").and_then(|socket| socket.local_addr()).expect("a port").port();
        let mut command = Command::new("moto_server");
        command.args(["-H", "127.0.0.1", "-p", &port.to_string()]);
        let Ok(child) = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn() else {
            skip(Need::Moto, "no moto_server (pip install 'moto[server]')");
            return None;
        };
        let moto = Moto(child);
        let start = std::time::Instant::now();
        while std::net::TcpStream::connect(("127.0.0.1", port)).is_err() {
            if start.elapsed() > Duration::from_secs(120) {
                skip(Need::Moto, "moto_server does not start");
                return None;
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        let url = format!("http://127.0.0.1:{port}");
        ureq::put(format!("{url}/bucket")).send_empty().expect("a bucket");
        Some((moto, url))
    }

    /// Returns the environment variables with which a process reaches the bucket.
    fn variables(url: &str) -> [(&'static str, String); 5] {
        [
            ("AWS_ENDPOINT", url.to_owned()),
            ("AWS_ALLOW_HTTP", "true".to_owned()),
            ("AWS_ACCESS_KEY_ID", "key".to_owned()),
            ("AWS_SECRET_ACCESS_KEY", "secret".to_owned()),
            ("AWS_REGION", "us-east-1".to_owned()),
        ]
    }

    #[test]
    fn a_bucket_keeps_what_is_named() {
        let Some((_moto, url)) = start() else { return };
        // SAFETY: the tests of this file read no variables, and others run in processes of their own or do not look at
        // these.
        variables(&url).into_iter().for_each(|(name, value)| unsafe { std::env::set_var(name, value) });
        run(async {
            let store = Store::bucket("s3://bucket/some/where").expect("a store");
            let large = vec![7; 12 << 20];
            let folder = tempfile::tempdir().expect("a folder");
            let file = folder.path().join("large");
            std::fs::write(&file, &large).expect("written");
            let large_one = store.put_file(&file).await.expect("stored in parts").digest;
            let small = crate::support::put(&store, b"small").await.digest;
            assert!(crate::support::bytes(&store, &large_one).await == large);
            assert!(!store.has(&Digest::from_bytes(b"none")).await.expect("an answer"));
            let long = Duration::from_secs(3600);
            assert_eq!(
                store.remove_unreferenced(long, |digests| named(digests, |_| false)).await.expect("done"),
                0,
                "too young"
            );
            // Neither file is referenced for a moment: both are moved to the trash, and can still be read.
            let aside = Duration::ZERO;
            let mut count = 0;
            let named_later = |digests| {
                named(digests, |name| {
                    count += usize::from(*name == small);
                    *name == small && count > 1
                })
            };
            assert_eq!(store.remove_unreferenced(aside, named_later).await.expect("done"), 1, "the large one alone");
            assert!(!store.has(&large_one).await.expect("an answer"));
            assert_eq!(crate::support::bytes(&store, &small).await, b"small");
        });
        let fresh = run(async { Fresh::sqlite().await.expect("SQLite").with_tables().await });
        let mut server = Server::start(&fresh, &["--workers", "1", "--store", "s3://bucket/server"]);
        let admin = server.admin();
        server.course(&admin, "physics");
        let ada = server.member(&admin, "physics", "ada", "student");
        let id = ada.submit("physics", &program("WA", 40));
        ada.wait_for_grade("physics", id);
        let path = format!("/api/v1/courses/physics/submissions/{id}");
        assert_eq!(ada.get(&format!("{path}/upload")).expect(200).body, program("WA", 40));
        assert!(ada.get(&format!("{path}/files/report.txt")).expect(200).text().contains("by"));
        assert!(!server.folder.join("store").exists());
    }
}
