//! Checks that frequent statements use indexes. `FOSSSIM_ROWS=1000000` tests them with a million rows.
use crate::support::{
    engines::{Fresh, run},
    rows,
    server::{Server, program},
};
use fosssim_server::{
    db::{Address, Database},
    values,
};
use std::collections::BTreeMap;

/// Returns how often PostgreSQL has read each of the large tables completely.
async fn whole_reads(address: &Address) -> BTreeMap<String, i64> {
    let database = Database::open(address).await.expect("a database");
    // All queries of this test use one connection.
    let mut transaction = database.begin().await.expect("a transaction");
    // The database's processes report their statistics when they end, or earlier.
    let start = std::time::Instant::now();
    loop {
        transaction
            .rows("SELECT CAST(pg_stat_clear_snapshot() AS TEXT) AS done", values![])
            .await
            .expect("a look at what is new");
        let others = transaction
            .one(
                "SELECT count(*) AS n FROM pg_stat_activity
                 WHERE datname = current_database() AND pid <> pg_backend_pid() AND backend_type = 'client backend'",
                values![],
            )
            .await
            .and_then(|row| row.int("n"));
        if others.expect("a number") == 0 {
            break;
        }
        assert!(start.elapsed().as_secs() < 60, "somebody's connections stay");
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    let rows = transaction
        .rows(
            "SELECT CAST(relname AS TEXT) AS name, coalesce(seq_scan, 0) AS n FROM pg_stat_user_tables
             WHERE relname IN ('job', 'submission', 'result', 'event', 'grade')",
            values![],
        )
        .await
        .expect("statistics");
    let found = rows.iter().map(|row| (row.text("name").expect("text"), row.int("n").expect("a number"))).collect();
    drop(transaction);
    database.close().await;
    found
}

#[test]
fn no_request_reads_a_large_table_whole() {
    run(async {
        let Some(fresh) = Fresh::postgres().await else { return };
        let options = ["--workers", "1", "--requests-per-minute", "100000"];
        let mut server = Server::start(&fresh, &options);
        let admin = server.admin();
        server.course(&admin, "physics");
        let ada = server.member(&admin, "physics", "ada", "student");
        let mine = ada.submit("physics", &program("AC", 1));
        ada.wait_for_grade("physics", mine);
        let mut transaction = fresh.database.read().await.expect("a transaction");
        let assignment = transaction.one("SELECT id FROM assignment", values![]).await.expect("a row").int("id");
        drop(transaction);
        server.stop();
        rows::fill(&fresh.database, assignment.expect("a number"), 500, rows::count(40_000)).await;
        fresh.database.close().await;
        let before = whole_reads(&fresh.address).await;
        server.resume();
        let base = "/api/v1/courses/physics";
        for path in [
            "/metrics".to_owned(),
            "/api/v1/queue".to_owned(),
            "/c/physics/queue".to_owned(),
            "/api/v1/audit".to_owned(),
            format!("{base}/audit"),
            format!("{base}/submissions/{mine}"),
            format!("{base}/submissions/{mine}/history"),
            format!("{base}/assignments/m1/submissions"),
            format!("{base}/assignments/m1/regrades"),
        ] {
            admin.get(&path).expect(200);
        }
        ada.get("/c/physics/a/m1").expect(200);
        let new = ada.submit("physics", &program("WA", 10));
        assert_eq!(ada.wait_for_grade("physics", new)["grade"]["points"], "10");
        admin.post_json(&format!("{base}/submissions/{new}/again"), "").expect(202);
        server.stop();
        let after = whole_reads(&fresh.address).await;
        assert_eq!(after, before);
    });
}
