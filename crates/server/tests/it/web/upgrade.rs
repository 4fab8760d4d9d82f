//! Tests a newer server with an older database.
use crate::support::{
    engines::{Fresh, run},
    server::Server,
};
use fosssim_server::{
    db::{self, Address, Database},
    values,
};

/// Statements that take a database back to the tables of the first version, with an account in it.
const BACK_TO_THE_FIRST: &[&str] = &[
    "DROP INDEX job_token",
    "DROP INDEX job_buried",
    "DROP INDEX job_cancelled",
    "DROP INDEX job_oldest",
    "DROP INDEX result_campaign",
    "DROP INDEX job_campaign",
    "DROP TABLE numbering",
    "ALTER TABLE grade_change DROP COLUMN given",
    "ALTER TABLE job DROP COLUMN asked_by",
    "ALTER TABLE result DROP COLUMN failed",
    "ALTER TABLE job DROP COLUMN scenes",
    "ALTER TABLE job DROP COLUMN scenes_done",
    "ALTER TABLE job DROP COLUMN deaths",
    "ALTER TABLE job DROP COLUMN token",
    "ALTER TABLE job DROP COLUMN replaced",
    "ALTER TABLE worker DROP COLUMN token",
    "ALTER TABLE worker DROP COLUMN fault",
    "ALTER TABLE worker DROP COLUMN fault_at",
    "ALTER TABLE worker DROP COLUMN faults",
    "ALTER TABLE worker DROP COLUMN in_a_row",
    "ALTER TABLE worker DROP COLUMN aside_since",
    "CREATE INDEX result_campaign ON result (campaign)",
    "CREATE INDEX job_campaign ON job (campaign)",
    "DROP VIEW kept_upload",
    "DROP TRIGGER submission_comes",
    "DROP TRIGGER submission_is_given_up",
    "DROP TRIGGER submission_goes",
    "DROP TRIGGER report_comes",
    "DROP TRIGGER report_goes",
    "DROP TABLE kept_bytes",
    "DROP INDEX submission_age",
    "DROP INDEX submission_digest",
    "DROP INDEX submission_assignment",
    "DROP INDEX result_archive",
    "ALTER TABLE job DROP COLUMN failed_by",
    "DROP TABLE platform_score",
    "DROP TABLE platform_choice",
    "DROP TABLE platform_link",
    "DROP TABLE platform_member",
    "DROP TABLE platform_course",
    "DROP TABLE platform_account",
    "DROP TABLE platform_login",
    "DROP TABLE platform_key",
    "DROP TABLE platform",
    "ALTER TABLE member DROP COLUMN platform",
    "ALTER TABLE result DROP COLUMN grader",
    "ALTER TABLE result DROP COLUMN essence",
    "ALTER TABLE submission DROP COLUMN removed_at",
    "DROP INDEX grade_result",
    "DROP INDEX grade_change_old",
    "DROP INDEX grade_change_new",
    "DROP TABLE mark",
    "DROP TABLE extension",
    "ALTER TABLE account DROP COLUMN managed_by",
    "ALTER TABLE assignment DROP COLUMN published_at",
    "ALTER TABLE result DROP COLUMN shown",
    "ALTER TABLE result DROP COLUMN parts",
    "DROP TABLE session",
    "DROP TABLE token",
    "DROP TABLE sign_in_link",
    "DROP TABLE upload_key",
    "DROP TABLE job_file",
    "DROP INDEX event_assignment",
    "DROP INDEX campaign_assignment",
    "DROP TABLE suite",
    "DROP TABLE server_secret",
    "ALTER TABLE assignment DROP COLUMN revision",
    "ALTER TABLE account ADD COLUMN password TEXT",
    "DELETE FROM schema_change WHERE number > 1",
    "INSERT INTO account (login, name, created_at, password) VALUES ('ada', 'Ada', {now}, 'argon2id$')",
];

#[test]
fn the_database_is_copied_before_its_tables_change() {
    run(async {
        let fresh = Fresh::sqlite().await.expect("SQLite").with_tables().await;
        // The database is as the first version left it.
        let mut transaction = fresh.database.begin().await.expect("a transaction");
        for statement in BACK_TO_THE_FIRST {
            transaction.execute(statement, values![]).await.expect("a statement");
        }
        transaction.commit().await.expect("commit");
        // A server that was killed during a copy left a part of it behind.
        let temp = tempfile::tempdir().expect("a folder");
        let backups = temp.path().join("data/backups");
        std::fs::create_dir_all(&backups).expect("a folder");
        std::fs::write(backups.join("version-1-7.db.partial"), b"").expect("a file");
        let mut server = Server::start_in(&fresh, &["--workers", "0"], temp.path().join("data"));
        let admin = server.admin();
        let accounts = admin.get("/api/v1/accounts").expect(200).json();
        assert_eq!(accounts[0]["login"], "ada", "what was there stays there");
        assert!(!backups.join("version-1-7.db.partial").exists());
        let copies = || -> Vec<_> {
            let entries = std::fs::read_dir(&backups).expect("a folder").map(|entry| entry.expect("an entry").path());
            // SQLite keeps further files next to an open database.
            entries.filter(|path| path.extension().is_some_and(|extension| extension == "db")).collect()
        };
        let made = copies();
        let [copy] = made.as_slice() else { panic!("{made:?}") };
        // The copy is a complete database of the old version.
        let old = Database::open(&Address::Sqlite(copy.clone())).await.expect("the copy");
        assert_eq!(db::read_version(&old).await.expect("a version"), 1);
        let mut transaction = old.read().await.expect("a transaction");
        let row = transaction.one("SELECT name FROM account WHERE login = 'ada'", values![]).await.expect("a row");
        assert_eq!(row.text("name").expect("a name"), "Ada");
        drop(transaction);
        // After a restart, it changes and copies nothing.
        assert!(server.stop().success());
        server.resume();
        admin.get("/api/v1/me").expect(200);
        assert_eq!(copies(), made);
        // A restored backup is updated automatically.
        old.close().await;
        let folder = tempfile::tempdir().expect("a folder");
        let place = folder.path().join("restored.db");
        std::fs::copy(copy, &place).expect("a copy");
        let restored = Database::open(&Address::Sqlite(place)).await.expect("the restored one");
        db::migrate(&restored).await.expect("tables");
        assert_eq!(db::read_version(&restored).await.expect("a version"), db::NEWEST);
        restored.close().await;
    });
}
