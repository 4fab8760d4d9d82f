//! Enqueues jobs for many submissions with one SQL statement.
use crate::domain::view::Assignment;
use crate::{
    db::{Transaction, Value},
    problem::Problem,
    task::{Form, Input},
};
use std::ops::RangeInclusive;

/// Builds the payload of a job for a row of `submission`, as described at [`statement_pieces`].
macro_rules! payload {
    () => {
        "CAST(? AS TEXT) || submission.form || CAST(? AS TEXT) || {quoted}(submission.file_name) || CAST(? AS TEXT)
            || submission.digest || CAST(? AS TEXT) || CAST(submission.size AS TEXT) || CAST(? AS TEXT)"
    };
}
pub(in crate::domain) use payload;

/// Returns the strings that a [`payload`] puts between the columns. They are equal for all submissions to an
/// assignment.
pub(in crate::domain) fn statement_pieces(assignment: &Assignment) -> Result<[String; 5], Problem> {
    let any = crate::store::Artifact { digest: crate::store::Digest::from_bytes(b""), size: 0 };
    let task = assignment.settings.task(Input { form: Form::Program, name: String::new(), artifact: any });
    let mut task = serde_json::to_value(task).map_err(|_| Problem::fault())?;
    task.as_object_mut().and_then(|fields| fields.remove("submission"));
    let rest = task.to_string();
    Ok([
        r#"{"submission":{"form":""#.to_owned(),
        r#"","name":"#.to_owned(),
        r#","digest":""#.to_owned(),
        r#"","size":"#.to_owned(),
        format!("}},{}", rest.trim_start_matches('{')),
    ])
}

/// Enqueues the submissions of an assignment that have IDs in a range and whose earlier jobs are all marked as
/// replaced. `by` is the person who requested this. Returns the number of these submissions.
pub(in crate::domain) async fn enqueue_replaced(
    transaction: &mut Transaction,
    assignment: &Assignment,
    by: i64,
    ids: RangeInclusive<i64>,
) -> Result<i64, Problem> {
    let pieces = statement_pieces(assignment)?;
    let mut values: Vec<Value> = vec![format!("again {}", assignment.id).into()];
    values.extend(pieces.into_iter().map(Value::from));
    values.extend([by, assignment.id, *ids.start(), *ids.end()].map(Value::from));
    // The ranks of the jobs are a second apart, so that new uploads are graded in between.
    let statement = concat!(
        "INSERT INTO job (lane, submission, fair_key, payload, state, rank, run_after, enqueued_at, asked_by)
         SELECT 'grading', submission.id, CAST(? AS TEXT), ",
        payload!(),
        ", 'waiting', {now} + 1000 * row_number() OVER (ORDER BY submission.id), {now}, {now},
            CAST(? AS {int}) FROM submission WHERE submission.assignment = ? AND submission.id BETWEEN ? AND ?
            AND submission.removed_at IS NULL
            AND EXISTS (SELECT 1 FROM job WHERE job.submission = submission.id AND job.replaced = 1)
            AND NOT EXISTS (SELECT 1 FROM job WHERE job.submission = submission.id AND job.campaign IS NULL
                AND job.replaced = 0)"
    );
    Ok(i64::try_from(transaction.execute(statement, &values).await?).unwrap_or(i64::MAX))
}
