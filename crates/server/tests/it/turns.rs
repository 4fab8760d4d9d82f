//! Tests that workers do not wait for all people who submit.
use crate::support::engines::{Fresh, on_both_engines};
use fosssim_server::db::Dialect;
use std::sync::{
    Arc, Mutex,
    atomic::{AtomicUsize, Ordering},
};

on_both_engines!(workers_go_before_requests);

/// Waits until `wanted` requests wait for a transaction.
async fn asked(count: &AtomicUsize, wanted: usize) {
    while count.load(Ordering::SeqCst) < wanted {
        tokio::task::yield_now().await;
    }
}

async fn workers_go_before_requests(fresh: Fresh) {
    let others = match fresh.database.dialect() {
        Dialect::Sqlite => 1,
        Dialect::Postgres => 7,
    };
    let mut held = Vec::new();
    for _ in 0..others {
        held.push(fresh.database.begin().await.expect("a transaction"));
    }
    // Twenty requests wait before a worker's request arrives.
    let (order, asks) = (Arc::new(Mutex::new(Vec::new())), Arc::new(AtomicUsize::new(0)));
    let task = |who: &'static str, database: fosssim_server::db::Database| {
        let (order, asks) = (order.clone(), asks.clone());
        tokio::spawn(async move {
            // A task counts when its request has its place among those that wait.
            let (mut begin, mut once) = (std::pin::pin!(database.begin()), true);
            let begin = std::future::poll_fn(|context| {
                let progress = begin.as_mut().poll(context);
                asks.fetch_add(usize::from(std::mem::take(&mut once)), Ordering::SeqCst);
                progress
            });
            let transaction = begin.await.expect("a transaction");
            order.lock().expect("no panic").push(who);
            transaction.commit().await.expect("commit");
        })
    };
    let mut tasks: Vec<_> = (0..20).map(|_| task("request", fresh.database.clone())).collect();
    asked(&asks, 20).await;
    let worker = task("worker", fresh.database.with_priority());
    if fresh.database.dialect() == Dialect::Postgres {
        // Some connections are only for workers.
        worker.await.expect("no panic");
        assert_eq!(*order.lock().expect("no panic"), ["worker"]);
    } else {
        asked(&asks, 21).await;
        tasks.push(worker);
    }
    held.clear();
    for task in tasks {
        task.await.expect("no panic");
    }
    let order = order.lock().expect("no panic");
    let place = order.iter().position(|who| *who == "worker").expect("the worker had its turn");
    assert!(place <= 1 && order.len() == 21, "{order:?}");
}
