//! Measures retention, exports and pages with a million submissions.
use super::{
    Bench,
    attack::report,
    measure::{forget_peak, load, peak},
    stage::Stage,
};
use anyhow::{Context, Result};
use fosssim_server::{
    db::{Address, Database, Dialect},
    values,
};
use std::time::Instant;

/// The number of accounts, among which the submissions are divided.
const STUDENTS: i64 = 1000;

/// The age of the submissions: ten days, in milliseconds.
const AGE: i64 = 10 * 24 * 3600 * 1000;

pub(super) async fn run(arguments: &Bench) -> Result<String> {
    let mut stage = Stage::set(arguments, &["--keep-of-course", "0"]).await?;
    let address =
        arguments.database.clone().map(|text| text.parse::<Address>()).transpose().map_err(anyhow::Error::msg)?;
    let address = address.unwrap_or_else(|| Address::Sqlite(stage.folder.path().join("data/fosssim.db")));
    let database = Database::open(&address).await.context("the database")?;
    let start = Instant::now();
    fill(&database, arguments.count).await?;
    stage.say(&format!(
        "{} submissions written in {} s; load average {}",
        arguments.count,
        start.elapsed().as_secs(),
        load()
    ));
    forget_peak(stage.process());
    let start = Instant::now();
    let path = "/api/v1/courses/bench/assignments/m1/export?format=jsonl";
    let exported = stage.admin.pull(path).await?;
    stage.say(&format!(
        "export: {} MiB in {} s, memory {} MiB",
        exported >> 20,
        start.elapsed().as_secs(),
        peak(stage.process())
    ));
    // Retention begins when the server starts.
    stage.again(arguments, &["--keep-days", "1", "--keep-of-course", "0"]).await?;
    let start = Instant::now();
    let mut left = arguments.count;
    while left > 0 {
        report(arguments, &mut stage, "retention").await?;
        let mut transaction = database.read().await?;
        let row = transaction.one("SELECT count(*) AS n FROM submission WHERE removed_at IS NULL", values![]).await?;
        left = row.int("n")?;
        stage.say(&format!("{left} left after {} s", start.elapsed().as_secs()));
    }
    database.close().await;
    stage.finish().await
}

/// Writes accounts, submissions, and a result with a report for each.
async fn fill(database: &Database, count: i64) -> Result<()> {
    let mut transaction = database.begin().await?;
    let statement = "INSERT INTO account (login, name, created_at)
        WITH RECURSIVE n (i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < ?)
        SELECT 'many' || i, 'One of many', {now} FROM n";
    transaction.execute(statement, values![STUDENTS]).await?;
    let submissions = match transaction.dialect() {
        Dialect::Sqlite => {
            "INSERT INTO submission (assignment, account, number, form, file_name, digest, size, created_at)
             WITH RECURSIVE n (i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < ?)
             SELECT (SELECT min(id) FROM assignment), account.id, n.i, 'program', 'FOSSSim',
                printf('%064x', account.id * 1000000 + n.i), 1000, {now} - ?
             FROM n CROSS JOIN account WHERE account.login LIKE 'many%'"
        }
        Dialect::Postgres => {
            "INSERT INTO submission (assignment, account, number, form, file_name, digest, size, created_at)
             WITH RECURSIVE n (i) AS (SELECT CAST(1 AS BIGINT) UNION ALL SELECT i + 1 FROM n WHERE i < ?)
             SELECT (SELECT min(id) FROM assignment), account.id, n.i, 'program', 'FOSSSim',
                lpad(to_hex(account.id * 1000000 + n.i), 64, '0'), 1000, {now} - ?
             FROM n CROSS JOIN account WHERE account.login LIKE 'many%'"
        }
    };
    transaction.execute(submissions, values![count / STUDENTS, AGE]).await?;
    for statement in [
        "INSERT INTO job (lane, submission, fair_key, payload, state, rank, run_after, enqueued_at, finished_at)
            SELECT 'grading', id, 'account', '', 'done', id, created_at, created_at, created_at FROM submission",
        "INSERT INTO result (job, submission, attempt, worker, verdict, code, points, max_points, summary, version,
                task,
                seconds, created_at)
            SELECT id, submission, 1, 'worker', 'wrong', 'WA', '50', '100', 'wrong', '1.0',
                '{}', '1', enqueued_at FROM job",
        "INSERT INTO grade (submission, result, set_at) SELECT submission, id, created_at FROM result",
        "INSERT INTO result_file (result, name, media_type, digest, size)
            SELECT result.id, 'report.html', 'text/html', submission.digest, 2000 FROM result
            JOIN submission ON submission.id = result.submission",
    ] {
        transaction.execute(statement, values![]).await?;
    }
    transaction.commit().await?;
    Ok(())
}
