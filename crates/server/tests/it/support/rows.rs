//! Fills a course with rows, as after years of use. The database itself creates them.
use fosssim_server::{
    db::{Database, Transaction},
    values,
};

/// Returns the number of submissions: `FOSSSIM_ROWS`, or the default `some`.
pub(crate) fn count(some: i64) -> i64 {
    std::env::var("FOSSSIM_ROWS").ok().map_or(some, |rows| rows.parse().expect("a number"))
}

/// Adds this many graded submissions of students to an assignment. All were right.
pub(crate) async fn fill(database: &Database, assignment: i64, students: i64, submissions: i64) {
    let mut transaction = database.begin().await.expect("a transaction");
    let first = transaction
        .one("SELECT coalesce(max(id), 0) AS id FROM submission", values![])
        .await
        .and_then(|row| row.int("id"))
        .expect("a number");
    transaction
        .execute(
            "WITH RECURSIVE n (i) AS (SELECT CAST(1 AS {int}) UNION ALL SELECT i + 1 FROM n WHERE i < ?)
             INSERT INTO account (login, name, created_at)
             SELECT 'filled-' || CAST(i AS TEXT), 'Filled', {now} FROM n",
            values![students],
        )
        .await
        .expect("accounts");
    transaction
        .execute(
            "INSERT INTO member (course, account, role, created_at)
             SELECT assignment.course, account.id, 'student', {now} FROM account
             JOIN assignment ON assignment.id = ? WHERE account.login LIKE 'filled-%'",
            values![assignment],
        )
        .await
        .expect("members");
    transaction
        .execute(
            "WITH RECURSIVE n (i) AS (SELECT CAST(1 AS {int}) UNION ALL SELECT i + 1 FROM n WHERE i < ?)
             INSERT INTO submission (assignment, account, number, form, file_name, digest, size, created_at)
             SELECT ?, (SELECT min(id) FROM account WHERE login LIKE 'filled-%') + i % ?, i, 'program', 'FOSS\"Sim',
                CAST(? AS TEXT), 12, {now} - 1000000 FROM n",
            values![submissions, assignment, students, "ab".repeat(32)],
        )
        .await
        .expect("submissions");
    transaction
        .execute(
            "INSERT INTO job (lane, submission, fair_key, payload, state, rank, run_after, enqueued_at, started_at,
                finished_at, attempt)
             SELECT 'grading', id, 'student ' || CAST(account AS TEXT), '{}', 'done', created_at, created_at,
                created_at, created_at, created_at + 1000, 1 FROM submission WHERE id > ?",
            values![first],
        )
        .await
        .expect("jobs");
    transaction
        .execute(
            "INSERT INTO result (job, submission, attempt, worker, verdict, code, points, max_points, summary, version,
                task, seconds, created_at)
             SELECT job.id, job.submission, 1, 'w', 'accepted', 'AC', '100', '100', 's', '1', job.payload, '1',
                job.finished_at
             FROM job WHERE job.submission > ?",
            values![first],
        )
        .await
        .expect("results");
    transaction
        .execute(
            "INSERT INTO grade (submission, result, set_at)
             SELECT submission, id, created_at FROM result WHERE submission > ?",
            values![first],
        )
        .await
        .expect("grades");
    add_events(&mut transaction, first).await;
    transaction.commit().await.expect("commit");
    let mut transaction = database.begin().await.expect("a transaction");
    transaction.execute("ANALYZE", values![]).await.expect("statistics");
    transaction.commit().await.expect("commit");
}

/// Adds the events of all submissions after the number `first`.
async fn add_events(transaction: &mut Transaction, first: i64) {
    for kind in ["submitted", "graded"] {
        transaction
            .execute(
                "INSERT INTO event (happened_at, kind, course, assignment, submission, text)
                 SELECT created_at, CAST(? AS TEXT), 1, assignment, id, 't' FROM submission WHERE id > ?",
                values![kind, first],
            )
            .await
            .expect("events");
    }
}
