//! Tests the commands for backup and restore while a server runs.
use crate::support::{
    engines::{Fresh, on_both_engines, run},
    server::{Server, program},
};
use fosssim_server::db::{self, Address};
use std::{
    fs,
    path::Path,
    process::Command,
    sync::atomic::{AtomicBool, Ordering},
};

/// Runs the program with a data folder and a database. Returns the exit code and the output.
fn command(words: &[&str], data: &Path, database: Option<&str>) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fosssim-server"));
    command.args(words).arg("--data").arg(data).env_remove("FOSSSIM_DATABASE");
    command.envs(database.map(|database| ("FOSSSIM_DATABASE", database)));
    let output = command.output().expect("an answer");
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    (output.status.code(), said)
}

on_both_engines!(what_was_accepted_is_in_a_backup_that_is_made_meanwhile);

async fn what_was_accepted_is_in_a_backup_that_is_made_meanwhile(fresh: Fresh) {
    let options = ["--workers", "1", "--requests-per-minute", "100000"];
    let mut server = Server::start(&fresh, &options);
    let admin = server.admin();
    server.course(&admin, "physics");
    let ada = server.member(&admin, "physics", "ada", "student");
    let first = ada.submit("physics", &program("WA", 40));
    ada.wait_for_grade("physics", first);
    let folder = tempfile::tempdir().expect("a folder");
    let copy = folder.path().join("copy");
    let done = AtomicBool::new(false);
    let (code, said) = std::thread::scope(|scope| {
        scope.spawn(|| {
            for points in 0..25 {
                if !done.load(Ordering::Relaxed) {
                    ada.submit("physics", &program("WA", points));
                }
            }
        });
        let ended = command(&["backup", copy.to_str().expect("UTF-8")], &server.folder, Some(&server.database()));
        done.store(true, Ordering::Relaxed);
        ended
    });
    assert_eq!(code, Some(0), "{said}");
    assert!(copy.join("backup.json").is_file() && said.contains("artifacts"), "{said}");
    assert_eq!(fs::metadata(&copy).expect("a folder").permissions_mode(), 0o700);
    // A second backup needs another folder.
    let (code, said) = command(&["backup", copy.to_str().expect("UTF-8")], &server.folder, Some(&server.database()));
    assert!(code == Some(2) && said.contains("already exists"), "{said}");

    // Restore into another folder, with another database.
    let data = folder.path().join("restored");
    let other = match fresh.address {
        Address::Sqlite(_) => None,
        Address::Postgres(_) => Some(Fresh::postgres().await.expect("PostgreSQL")),
    };
    let address = other.as_ref().map(|other| match &other.address {
        Address::Postgres(url) => url.clone(),
        Address::Sqlite(_) => unreachable!(),
    });
    let restore = |data: &Path| command(&["restore", copy.to_str().expect("UTF-8")], data, address.as_deref());
    let (code, said) = restore(&data);
    assert_eq!(code, Some(0), "{said}");
    let (code, said) = restore(&data);
    assert!(code == Some(2) && said.contains("not empty"), "{said}");
    let other = match other {
        Some(other) => other,
        None => {
            let mut other = Fresh::sqlite().await.expect("SQLite");
            other.address = Address::Sqlite(data.join("fosssim.db"));
            other
        }
    };
    let again = Server::start_in(&other, &options, data.clone());
    // Tokens are still valid, and waiting submissions are graded.
    let ada = fosssim_client(&again, &ada);
    let submissions = ada.get("/api/v1/courses/physics/assignments/m1/submissions").expect(200).json();
    let submissions = submissions.as_array().expect("a list");
    assert!(!submissions.is_empty());
    for submission in submissions {
        let id = submission["id"].as_i64().expect("a number");
        assert_eq!(ada.wait_for_grade("physics", id)["grade"]["code"], "WA");
        let upload = ada.get(&format!("/api/v1/courses/physics/submissions/{id}/upload")).expect(200).body;
        assert_eq!(
            fosssim_server::store::Digest::from_bytes(&upload).as_str(),
            submission["digest"].as_str().expect("one")
        );
    }
}

/// Returns the same person as a client of another server.
fn fosssim_client(server: &Server, person: &crate::support::server::Client) -> crate::support::server::Client {
    crate::support::server::Client { url: server.url.clone(), headers: person.headers.clone() }
}

trait PermissionsMode {
    fn permissions_mode(&self) -> u32;
}

impl PermissionsMode for fs::Metadata {
    fn permissions_mode(&self) -> u32 {
        use std::os::unix::fs::PermissionsExt;
        self.permissions().mode() & 0o777
    }
}

#[test]
fn a_backup_that_is_damaged_incomplete_or_newer_is_refused() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite").with_tables().await;
        let mut server = Server::start(&fresh, &["--workers", "1"]);
        let admin = server.admin();
        server.course(&admin, "physics");
        let ada = server.member(&admin, "physics", "ada", "student");
        let id = ada.submit("physics", &program("WA", 40));
        ada.wait_for_grade("physics", id);
        let folder = tempfile::tempdir().expect("a folder");
        let copy = folder.path().join("copy");
        let text = copy.to_str().expect("UTF-8");
        assert_eq!(command(&["backup", text], &server.folder, Some(&server.database())).0, Some(0));
        let restore = |number: u32| command(&["restore", text], &folder.path().join(number.to_string()), None);
        let upload = fosssim_server::store::Digest::from_bytes(&program("WA", 40));
        let (first, rest) = upload.as_str().split_at(2);
        let artifact = copy.join("store/sha256").join(first).join(rest);
        let refused = |number: u32, what: &str| {
            let (code, said) = restore(number);
            assert!(code == Some(2) && said.contains(what), "{code:?} {said}");
            assert!(!folder.path().join(number.to_string()).exists(), "half a data folder is left: {what}");
        };
        // One artifact is changed, then one is missing.
        fs::write(&artifact, program("AC", 99)).expect("written");
        refused(1, "is damaged: its bytes do not match its name");
        fs::remove_file(&artifact).expect("removed");
        refused(2, "the backup is damaged: it has");
        fs::write(&artifact, program("WA", 40)).expect("written");
        assert_eq!(restore(3).0, Some(0));
        // The manifest of a newer program, one of newer tables, and no manifest.
        let manifest = copy.join("backup.json");
        let said = fs::read_to_string(&manifest).expect("a manifest");
        fs::write(&manifest, said.replace("\"schema\": 1", "\"schema\": 2")).expect("written");
        refused(4, "the backup has format 2, but this program reads up to 1");
        let tables = format!("\"tables\": {}", db::NEWEST);
        assert!(said.contains(&tables), "{said}");
        fs::write(&manifest, said.replace(&tables, "\"tables\": 9999")).expect("written");
        refused(5, "the backup's tables have version 9999");
        fs::remove_file(&manifest).expect("removed");
        refused(6, "is not a complete backup");
        fs::write(&manifest, &said).expect("written");
        // The copy of the database is changed.
        fs::write(copy.join("fosssim.db"), b"SQLite format 3").expect("written");
        refused(7, "is damaged: its digest is not the one in the manifest");
        // There is no data folder to copy.
        let (code, said) = command(&["backup", text], &folder.path().join("none"), None);
        assert!(code == Some(2) && said.contains("there is no data folder"), "{said}");
    });
}
