//! The health of workers and suites. If the grader fails, either the worker or the suite may be the cause. Therefore a
//! worker that keeps failing leaves jobs to other workers, and a suite that keeps failing waits for staff.
use crate::{
    db::{DbError, Transaction},
    queue::{Claimant, QueuePolicy, millis},
    values,
};
use std::time::Duration;

/// The number of consecutive faults after which a worker leaves jobs to workers without a fault since their last
/// result.
const MAX_FAULTS: i64 = 3;

/// The maximum pause of a failing worker. The first pause is one second, and each further one is twice as long.
const MAX_PAUSE: Duration = Duration::from_secs(60);

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

/// Returns whether a worker may claim a job. It must have fewer jobs than its token has slots. If it fails while other
/// workers succeed, it must pause first.
///
/// # Errors
///
/// Fails if the database cannot be read.
pub async fn may_claim(
    transaction: &mut Transaction,
    policy: &QueuePolicy,
    claimant: Claimant<'_>,
) -> Result<bool, DbError> {
    let recent = worker_timeout_millis(policy);
    if let Some(token_id) = claimant.token_id {
        // Requests of one token are handled one after another, so that the number of its jobs is exact.
        transaction.row("SELECT id FROM token WHERE id = ? {for update}", values![token_id]).await?;
        let statement = "SELECT CAST(coalesce(sum(slots), 0) AS {int}) AS slots,
               (SELECT count(*) FROM job WHERE token = ? AND state = 'running') AS held
            FROM worker WHERE token = ? AND seen_at > {now} - ?";
        let room = transaction.one(statement, values![token_id, token_id, recent]).await?;
        if room.int("held")? >= room.int("slots")?.max(1) {
            return Ok(false);
        }
    }
    let statement = "SELECT in_a_row, {now} - fault_at AS since FROM worker WHERE name = ? AND in_a_row >= ?";
    let row = transaction.row(statement, values![claimant.worker, MAX_FAULTS]).await?;
    let Some(row) = row else { return Ok(true) };
    let steps = u32::try_from(row.int("in_a_row")? - MAX_FAULTS).unwrap_or(0).min(16);
    let aside = Duration::from_secs(1).saturating_mul(1 << steps).min(MAX_PAUSE);
    // A fault with a future time was recorded before the clock was set back.
    let since = row.maybe_int("since")?.and_then(|since| u64::try_from(since).ok());
    if since.is_none_or(|since| Duration::from_millis(since) >= aside) {
        return Ok(true);
    }
    let statement = "SELECT name FROM worker WHERE name <> ? AND slots > 0 AND in_a_row = 0 AND seen_at > {now} - ?
        AND seen_at <= {now} + ? LIMIT 1";
    let better = transaction.row(statement, values![claimant.worker, recent, recent]).await?;
    Ok(better.is_none())
}

/// Records that the grader failed in a worker that had reported that it can grade.
pub(crate) async fn record_failure(transaction: &mut Transaction, worker: &str, fault: &str) -> Result<(), DbError> {
    let statement = "UPDATE worker SET faults = faults + 1, in_a_row = in_a_row + 1, fault = ?, fault_at = {now}
        WHERE name = ?";
    transaction.execute(statement, values![fault, worker]).await?;
    Ok(())
}

/// Records that a worker delivered a result.
pub(crate) async fn record_result(transaction: &mut Transaction, worker: &str) -> Result<(), DbError> {
    transaction.execute("UPDATE worker SET in_a_row = 0 WHERE name = ? AND in_a_row > 0", values![worker]).await?;
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
