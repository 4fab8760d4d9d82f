//! The health of workers and suites. If the grader fails, either the worker or the suite may be the cause. A worker
//! checks itself after a fault, and a suite that keeps failing waits for staff.
use crate::{
    db::{DbError, Transaction},
    queue::{Claimant, QueuePolicy, millis},
    values,
};

/// Returns the number of milliseconds for which a worker counts as alive after its last report.
pub fn worker_timeout_millis(policy: &QueuePolicy) -> i64 {
    millis(policy.lease * 2)
}

/// Records that a worker is alive, and whether it can grade.
///
/// # Errors
///
/// Fails if the database cannot be changed.
pub async fn record_report(
    transaction: &mut Transaction,
    (worker, version): (&str, &str),
    token_id: Option<i64>,
    slots: usize,
    fault: Option<&str>,
) -> Result<(), DbError> {
    let slots = i64::try_from(slots).unwrap_or(i64::MAX);
    let fault = fault.map(strip_paths);
    let statement =
        "INSERT INTO worker (name, version, slots, started_at, seen_at, token) VALUES (?, ?, ?, {now}, {now}, ?)
        ON CONFLICT (name) DO UPDATE SET version = excluded.version, slots = excluded.slots,
           seen_at = excluded.seen_at";
    transaction.execute(statement, values![worker, version, slots, token_id]).await?;
    if let Some(fault) = &fault {
        let statement = "UPDATE worker SET fault = ?, fault_at = {now}, aside_since = coalesce(aside_since, {now}),
            faults = faults + CASE WHEN aside_since IS NULL THEN 1 ELSE 0 END WHERE name = ?";
        transaction.execute(statement, values![fault, worker]).await?;
    } else if slots > 0 {
        let statement = "UPDATE worker SET aside_since = NULL WHERE name = ? AND aside_since IS NOT NULL";
        transaction.execute(statement, values![worker]).await?;
    }
    Ok(())
}

/// Returns whether a worker may claim a job: whether it has fewer jobs than its token has slots.
///
/// # Errors
///
/// Fails if the database cannot be read.
pub async fn may_claim(
    transaction: &mut Transaction,
    policy: &QueuePolicy,
    claimant: Claimant<'_>,
) -> Result<bool, DbError> {
    let Some(token_id) = claimant.token_id else { return Ok(true) };
    // Requests of one token are handled one after another, so that the number of its jobs is exact.
    transaction.row("SELECT id FROM token WHERE id = ? {for update}", values![token_id]).await?;
    let statement = "SELECT CAST(coalesce(sum(slots), 0) AS {int}) AS slots,
           (SELECT count(*) FROM job WHERE token = ? AND state = 'running') AS held
        FROM worker WHERE token = ? AND seen_at > {now} - ?";
    let room = transaction.one(statement, values![token_id, token_id, worker_timeout_millis(policy)]).await?;
    Ok(room.int("held")? < room.int("slots")?.max(1))
}

/// Records that the grader failed in a worker that had reported that it can grade.
pub(crate) async fn record_failure(transaction: &mut Transaction, worker: &str, fault: &str) -> Result<(), DbError> {
    let statement = "UPDATE worker SET faults = faults + 1, fault = ?, fault_at = {now} WHERE name = ?";
    transaction.execute(statement, values![fault, worker]).await?;
    Ok(())
}

/// Removes the machine's folders from a message. Only the last part of each absolute path is kept.
pub fn strip_paths(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find('/') {
        let before = rest[..at].chars().next_back();
        let (head, tail) = rest.split_at(at);
        plain.push_str(head);
        let end = tail.find(|c: char| c.is_whitespace() || "\"'`(),;:<>|".contains(c)).unwrap_or(tail.len());
        let (path, after) = tail.split_at(end);
        // `Group/scene` and `asset:Group/scene` are names, and the slash in `<a/>` is not a path.
        let is_name = before.is_some_and(|c| c.is_alphanumeric() || "_.-@*".contains(c));
        let last = path.trim_end_matches('/').rsplit('/').next().unwrap_or_default();
        plain.push_str(if is_name || last.is_empty() { path } else { last });
        rest = after;
    }
    plain.push_str(rest);
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_cut_and_names_are_not() {
        for (said, told) in [
            ("/var/lib/f/w.1/job-a/input/suite/suite.toml:5:9: no", "suite.toml:5:9: no"),
            ("cannot read `/etc/passwd`, (/tmp/a b)", "cannot read `passwd`, (a b)"),
            ("no embedded scene matches asset:No/such", "no embedded scene matches asset:No/such"),
            ("file:///srv/x/y failed in Group/scene-1", "file:y failed in Group/scene-1"),
            ("add `<duration time=\"...\"/>`: 1 / 2", "add `<duration time=\"...\"/>`: 1 / 2"),
            ("", ""),
        ] {
            assert_eq!(strip_paths(said), told);
        }
    }
}
