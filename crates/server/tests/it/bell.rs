//! The bell between processes.
use crate::support::engines::{Fresh, on_both_engines};
use fosssim_server::{
    db::{Database, Dialect},
    queue::Bell,
};
use std::time::Duration;

on_both_engines!(the_bell_is_heard_by_other_processes);

async fn the_bell_is_heard_by_other_processes(fresh: Fresh) {
    // SQLite's other processes look by the clock; there, only this process hears.
    let (here, there) = (Bell::default(), Bell::default());
    let other = Database::open(&fresh.address).await.expect("a second connection");
    let postgres = other.dialect() == Dialect::Postgres;
    let mut ear = if postgres { there.ear() } else { here.ear() };
    let listening = tokio::spawn(there.clone().listen(other, None));
    if postgres {
        // The first stroke says that it listens.
        assert!(ear.wait(Duration::from_secs(60)).await);
    }
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    Bell::ring(&mut transaction).await.expect("a ring");
    transaction.commit().await.expect("commit");
    here.strike();
    assert!(ear.wait(Duration::from_secs(60)).await);
    assert!(!ear.wait(Duration::ZERO).await, "once is once");
    listening.abort();
}
