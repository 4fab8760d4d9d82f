//! The steps of a regrade. One statement handles all submissions, so that each step is complete or has no effect.
use crate::domain::{
    submissions::bulk_enqueue::{payload, statement_pieces},
    view::Assignment,
};
use crate::{
    db::{DbError, Transaction, Value},
    lti::score,
    problem::Problem,
    queue::JobOwner,
    task::JUDGE_ERROR,
    values,
};

/// Enqueues the submissions to an assignment that are not in the regrade yet, to be graded with the regrade's settings.
/// Returns the number of these submissions.
pub(in crate::domain) async fn enqueue_missing(
    transaction: &mut Transaction,
    regrade_id: i64,
    assignment: &Assignment,
) -> Result<u64, Problem> {
    // No submission is removed before this transaction ends.
    let statement = "SELECT count(*) AS n FROM
        (SELECT id FROM submission WHERE assignment = ? ORDER BY id {for update}) AS held";
    transaction.one(statement, values![assignment.id]).await?;
    let owner = JobOwner::Regrade(regrade_id);
    let from = owner.next(transaction).await?;
    let mut values: Vec<Value> = vec![regrade_id.into(), owner.key().into()];
    values.extend(statement_pieces(assignment)?.into_iter().map(Value::from));
    values.extend([from, owner.spacing_millis(), assignment.id, regrade_id].map(Value::from));
    // The unary plus prevents an index, with which SQLite would search all jobs of the regrade for each submission.
    let statement = concat!(
        "INSERT INTO job (lane, submission, campaign, fair_key, payload, state, rank, run_after, enqueued_at)
         SELECT 'grading', submission.id, CAST(? AS {int}), CAST(? AS TEXT), ",
        payload!(),
        ", 'waiting', ? + ? * (row_number() OVER (ORDER BY submission.id) - 1), {now}, {now}
         FROM submission WHERE submission.assignment = ? AND submission.removed_at IS NULL
            AND NOT EXISTS (SELECT 1 FROM job WHERE job.submission = submission.id AND +job.campaign = ?)"
    );
    Ok(transaction.execute(statement, &values).await?)
}

/// Writes the verdict and the points of a result in SQL, such as `wrong answer, 68.09 points`. Both engines round to a
/// number with a decimal point, so its last zeros and the point are of no use.
macro_rules! grade_text {
    ($result:literal) => {
        concat!(
            $result,
            ".verdict || coalesce(', ' || rtrim(rtrim(CAST(round(CAST(",
            $result,
            ".points AS numeric), 2) AS TEXT), '0'), '.') || ' points', '')"
        )
    };
}

/// Makes the results of a regrade count, and stores the person who requested it and the reason for students. If the
/// grader failed on a submission, its old grade stays.
pub(in crate::domain) async fn apply(
    transaction: &mut Transaction,
    regrade_id: i64,
    (by, course, assignment): (i64, i64, i64),
    reason: &str,
) -> Result<(), DbError> {
    let statement =
        "INSERT INTO grade_change (submission, old_result, new_result, changed_by, campaign, reason, changed_at)
        SELECT result.submission, grade.result, result.id, CAST(? AS {int}), CAST(? AS {int}), CAST(? AS TEXT), {now}
        FROM result LEFT JOIN grade ON grade.submission = result.submission
        WHERE result.campaign = ? AND result.code <> ?";
    transaction.execute(statement, values![by, regrade_id, reason, regrade_id, JUDGE_ERROR]).await?;
    let statement = concat!(
        "INSERT INTO event (happened_at, kind, actor, course, assignment, submission, text)
        SELECT {now}, 'grade changed', CAST(? AS {int}), CAST(? AS {int}), CAST(? AS {int}), result.submission,
           CAST(? AS TEXT) || ': ' || coalesce(",
        grade_text!("old"),
        ", 'no grade') || '; now ' || ",
        grade_text!("result"),
        "
        FROM result LEFT JOIN grade ON grade.submission = result.submission
        LEFT JOIN result AS old ON old.id = grade.result
        WHERE result.campaign = ? AND result.code <> ?
           AND (old.id IS NULL OR old.code <> result.code
               OR coalesce(old.points, '') <> coalesce(result.points, ''))"
    );
    transaction.execute(statement, values![by, course, assignment, reason, regrade_id, JUDGE_ERROR]).await?;
    let statement = "INSERT INTO grade (submission, result, set_at)
        SELECT submission, id, {now} FROM result WHERE campaign = ? AND code <> ? ORDER BY submission
        ON CONFLICT (submission) DO UPDATE SET result = excluded.result, set_at = excluded.set_at";
    transaction.execute(statement, values![regrade_id, JUDGE_ERROR]).await?;
    score::send_all(transaction, assignment, false).await.map(drop)
}

/// Cancels the waiting jobs of a regrade.
pub(in crate::domain) async fn cancel(transaction: &mut Transaction, regrade_id: i64) -> Result<(), DbError> {
    let statement = "WITH left_over AS (SELECT id FROM job WHERE campaign = ? AND state IN ('waiting', 'running')
           ORDER BY id {for update})
        UPDATE job SET state = 'cancelled', finished_at = {now}, lease_key = NULL, lease_until = NULL
        WHERE id IN (SELECT id FROM left_over)";
    transaction.execute(statement, values![regrade_id]).await.map(drop)
}
