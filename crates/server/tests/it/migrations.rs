//! Tests the database's tables and their changes.
use crate::support::engines::{Fresh, run};
use fosssim_server::{
    db::{self, MigrateError},
    values,
};

async fn several_servers_may_start_at_once(fresh: Fresh) {
    assert_eq!(db::read_version(&fresh.database).await.expect("a version"), 0);
    let servers: Vec<_> = (0..4)
        .map(|_| {
            let address = fresh.address.clone();
            tokio::spawn(async move {
                let database = db::Database::open(&address).await.expect("a connection");
                db::migrate(&database).await.expect("tables")
            })
        })
        .collect();
    let mut applied = Vec::new();
    for server in servers {
        applied.push(server.await.expect("a server"));
    }
    applied.sort_unstable();
    assert_eq!(applied[..3], [0, 0, 0]);
    assert_eq!(i64::try_from(applied[3]).expect("few"), db::NEWEST);
    assert_eq!(db::read_version(&fresh.database).await.expect("a version"), db::NEWEST);
}

async fn a_newer_database_is_left_alone(fresh: Fresh) {
    db::migrate(&fresh.database).await.expect("tables");
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    let newer = db::NEWEST + 1;
    transaction
        .execute("INSERT INTO schema_change VALUES (?, 'from the future', 'x', {now})", values![newer])
        .await
        .expect("a row");
    transaction.commit().await.expect("commit");
    let error = db::migrate(&fresh.database).await.expect_err("a newer database");
    assert!(matches!(error, MigrateError::Newer { found } if found == newer), "{error}");
    assert!(error.to_string().contains("start the newer program"), "{error}");
    // A server that is still running stops writing as soon as it notices the newer tables.
    assert!(fresh.database.is_healthy().await);
    let refused = fresh.database.begin().await.expect_err("a newer database");
    assert!(refused.is_transient() && refused.to_string().contains("a newer program"), "{refused}");
    fresh.database.read().await.expect("it is read still");
}

#[test]
fn on_sqlite() {
    run(async {
        several_servers_may_start_at_once(Fresh::sqlite().await.expect("SQLite")).await;
        a_newer_database_is_left_alone(Fresh::sqlite().await.expect("SQLite")).await;
    });
}

#[test]
fn on_postgres() {
    run(async {
        let Some(fresh) = Fresh::postgres().await else { return };
        several_servers_may_start_at_once(fresh).await;
        a_newer_database_is_left_alone(Fresh::postgres().await.expect("PostgreSQL")).await;
    });
}

#[test]
fn behind_a_pooler() {
    run(async {
        let Some(fresh) = Fresh::pooled().await else { return };
        several_servers_may_start_at_once(fresh).await;
    });
}
