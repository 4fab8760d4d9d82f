//! The notifier between processes.
use crate::support::engines::{Fresh, on_both_engines};
use fosssim_server::{
    db::{Database, Dialect},
    queue::Notifier,
};
use std::time::Duration;

on_both_engines!(the_bell_is_heard_by_other_processes);

async fn the_bell_is_heard_by_other_processes(fresh: Fresh) {
    // SQLite's other processes look by the clock; there, only this process hears.
    let (here, there) = (Notifier::default(), Notifier::default());
    let other = Database::open(&fresh.address).await.expect("a second connection");
    let postgres = other.dialect() == Dialect::Postgres;
    let mut subscription = if postgres { there.subscribe() } else { here.subscribe() };
    let listening = tokio::spawn(there.clone().listen(other, None));
    if postgres {
        // The first stroke says that it listens.
        assert!(subscription.wait(Duration::from_secs(60)).await);
    }
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    Notifier::notify(&mut transaction).await.expect("a ring");
    transaction.commit().await.expect("commit");
    here.wake();
    assert!(subscription.wait(Duration::from_secs(60)).await);
    assert!(!subscription.wait(Duration::ZERO).await, "once is once");
    listening.abort();
}
