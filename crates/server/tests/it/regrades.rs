//! Regrades of whole classes. `FOSSSIM_ROWS=20000` grades this many submissions again, and prints how long it took.
use crate::support::{
    engines::{Fresh, on_both_engines},
    rows,
    server::{Server, program},
};
use fosssim_server::{db::Dialect, values};
use std::time::{Duration, Instant};

on_both_engines!(
    a_class_is_graded_again_beside_uploads,
    a_result_and_the_end_of_its_regrade_do_not_wait_for_each_other,
);

const BASE: &str = "/api/v1/courses/physics/assignments/m1/regrades";

async fn assignment(fresh: &Fresh) -> i64 {
    let mut transaction = fresh.database.read().await.expect("a transaction");
    let row = transaction.one("SELECT id FROM assignment WHERE slug = 'm1'", values![]).await;
    row.and_then(|row| row.int("id")).expect("a number")
}

/// Ends the jobs of a regrade with half the points for every second submission.
async fn grade_all(fresh: &Fresh) {
    let mut transaction = fresh.database.begin().await.expect("a transaction");
    for statement in [
        "INSERT INTO result (job, submission, campaign, attempt, worker, verdict, code, points, max_points, summary,
            version, task, seconds, created_at)
         SELECT id, submission, campaign, 1, 'w', 'v', CASE WHEN id % 2 = 0 THEN 'AC' ELSE 'WA' END,
            CASE WHEN id % 2 = 0 THEN '100' ELSE '50' END, '100', 's', '2', payload, '1', {now}
         FROM job WHERE campaign IS NOT NULL AND state = 'waiting'",
        "UPDATE job SET state = 'done', finished_at = {now} WHERE campaign IS NOT NULL AND state = 'waiting'",
    ] {
        transaction.execute(statement, values![]).await.expect("results");
    }
    transaction.commit().await.expect("commit");
}

async fn number(fresh: &Fresh, statement: &'static str) -> i64 {
    let mut transaction = fresh.database.read().await.expect("a transaction");
    transaction.one(statement, values![]).await.and_then(|row| row.int("n")).expect("a number")
}

async fn a_class_is_graded_again_beside_uploads(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0", "--requests-per-minute", "100000"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    let all = rows::count(1200);
    rows::fill(&fresh.database, assignment(&fresh).await, 100, all).await;
    let ada = server.member(&admin, "physics", "ada", "student");
    // A student submits the whole time, so the longest wait is that for the beginning of the regrade.
    let stop = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
    let uploading = std::thread::spawn({
        let stop = stop.clone();
        move || {
            let mut longest = Duration::ZERO;
            while !stop.load(std::sync::atomic::Ordering::SeqCst) {
                let start = Instant::now();
                ada.submit("physics", &program("AC", 1));
                longest = longest.max(start.elapsed());
                std::thread::sleep(Duration::from_millis(50));
            }
            longest
        }
    });
    let start = Instant::now();
    let begun = admin.post_json(BASE, r#"{"reason": "another rule", "settings": {"rules": "parity", "per_hour": 0}}"#);
    let began = start.elapsed();
    let regrade = begun.expect(201).json();
    let id = regrade["id"].clone();
    stop.store(true, std::sync::atomic::Ordering::SeqCst);
    let longest = uploading.join().expect("uploads");
    assert!(regrade["left"].as_i64() >= Some(all), "{}", regrade["left"]);
    let payload =
        number(&fresh, "SELECT count(*) AS n FROM job WHERE campaign IS NOT NULL AND payload LIKE '%parity%'");
    assert!(payload.await >= all);
    // Claim one of the jobs, as a worker does.
    let mut transaction = fresh.database.read().await.expect("a transaction");
    let row =
        transaction.one("SELECT payload FROM job WHERE campaign IS NOT NULL ORDER BY id LIMIT 1", values![]).await;
    let task: fosssim_server::task::Task =
        serde_json::from_str(&row.and_then(|row| row.text("payload")).expect("text")).expect("a task");
    drop(transaction);
    assert_eq!((task.submission.name.as_str(), task.submission.artifact.size), ("FOSS\"Sim", 12));
    // A submission that arrived while the regrade began is graded, too.
    let path = format!("{BASE}/{id}");
    grade_all(&fresh).await;
    let start = Instant::now();
    let mut applied = admin.post_json(&format!("{path}/apply"), "");
    while applied.status == 409 {
        grade_all(&fresh).await;
        applied = admin.post_json(&format!("{path}/apply"), "");
    }
    let took = start.elapsed();
    let regrade = applied.expect(200).json();
    assert_eq!(regrade["state"], "applied");
    let changed = regrade["changed"].as_i64().expect("a number");
    assert!(changed >= all / 2, "{changed}");
    let halves = number(
        &fresh,
        "SELECT count(*) AS n FROM grade JOIN result ON result.id = grade.result
         WHERE result.points = '50'",
    );
    assert!(halves.await >= all / 2);
    let told = number(
        &fresh,
        "SELECT count(*) AS n FROM event WHERE kind = 'grade changed'
         AND text LIKE 'another rule: %; now v, %0 points'",
    );
    assert_eq!(told.await, changed, "entries have the grades before and after");
    // Changes are listed page by page.
    let (mut seen, mut after) = (0, serde_json::json!(0));
    while !after.is_null() {
        let page = admin.get(&format!("{path}?after={after}")).expect(200).json();
        seen += page["changes"].as_array().expect("a list").len();
        after = page["next"].clone();
    }
    assert_eq!(i64::try_from(seen).expect("few"), changed);
    println!(
        "{all} submissions: begun in {began:.2?}, the longest upload meanwhile {longest:.2?}; applied in {took:.2?}"
    );
}

async fn a_result_and_the_end_of_its_regrade_do_not_wait_for_each_other(fresh: Fresh) {
    let mut server = Server::start(&fresh, &["--workers", "0"]);
    let admin = server.admin();
    server.course(&admin, "physics");
    server.member(&admin, "physics", "ada", "student").submit("physics", &program("AC", 1));
    let id = admin.post_json(BASE, r#"{"reason": "to see"}"#).expect(201).json()["id"].clone();
    // A worker has a job of the regrade, and is about to write its result.
    let mut worker = fresh.database.begin().await.expect("a transaction");
    worker.one("SELECT id FROM job WHERE campaign IS NOT NULL {for update}", values![]).await.expect("a job");
    // The regrade is discarded at this moment, which cancels its jobs.
    let discarding = std::thread::spawn(move || admin.post_json(&format!("{BASE}/{id}/discard"), ""));
    if fresh.database.dialect() == Dialect::Postgres {
        let waiting = "SELECT count(*) AS n FROM pg_stat_activity
                       WHERE datname = current_database() AND wait_event_type = 'Lock'";
        while number(&fresh, waiting).await == 0 {
            tokio::task::yield_now().await;
        }
    }
    let written = worker
        .execute(
            "INSERT INTO result (job, submission, campaign, attempt, worker, verdict, code, points, max_points,
                summary, version, task, seconds, created_at)
             SELECT id, submission, campaign, 1, 'w', 'v', 'AC', '100', '100', 's', '2', payload, '1', {now}
             FROM job WHERE campaign IS NOT NULL",
            values![],
        )
        .await;
    assert_eq!(written.expect("no two wait for each other"), 1);
    worker.commit().await.expect("commit");
    assert_eq!(discarding.join().expect("no panic").expect(200).json()["state"], "discarded");
}
