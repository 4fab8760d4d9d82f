//! Grades submissions again after the grader failed on them.
use crate::domain::{
    Staff,
    submissions::bulk_enqueue::enqueue_replaced,
    view::{self, LogEntry},
};
use crate::{
    problem::{Problem, ensure},
    values,
};
use serde::Serialize;
use utoipa::ToSchema;

/// The answer to a request to grade submissions again.
#[derive(Serialize, ToSchema)]
#[schema(as = RegradeOrder)]
pub struct EnqueuedJobs {
    /// The number of submissions that are graded again.
    pub jobs: i64,
}

impl Staff {
    /// Grades a submission again, with the assignment's present settings.
    ///
    /// # Errors
    ///
    /// Fails if there is no submission with this ID, it is being graded, or its bytes are no longer stored.
    pub async fn grade_again(&self, id: i64) -> Result<EnqueuedJobs, Problem> {
        let submission = self.submission(id).await?;
        let assignment = self.assignment(&submission.assignment).await?;
        ensure(submission.removed_at.is_none(), Problem::removed())?;
        let mut transaction = self.begin().await?;
        transaction.row("SELECT id FROM submission WHERE id = ? {for update}", values![id]).await?;
        let statement = "UPDATE job SET replaced = 1 WHERE submission = ? AND campaign IS NULL AND replaced = 0
            AND state IN ('done', 'buried', 'cancelled')";
        let replaced = transaction.execute(statement, values![id]).await?;
        ensure(replaced > 0, Problem::conflict("the submission is being graded", "wait for its grade"))?;
        let jobs = enqueue_replaced(&mut transaction, &assignment, self.account.id, id..=id).await?;
        let entry = self.entry("graded again", Some(assignment.id), "one submission");
        view::log_event(&mut transaction, &LogEntry { submission: Some(id), ..entry }).await?;
        self.app.0.notifier.commit(transaction).await?;
        Ok(EnqueuedJobs { jobs })
    }

    /// Grades again all submissions on which the grader failed, of one assignment or of the whole course. Returns their
    /// number.
    pub async fn grade_errors_again(&self, assignment: Option<&str>) -> Result<EnqueuedJobs, Problem> {
        let assignments = match assignment {
            Some(slug) => vec![self.assignment(slug).await?],
            None => self.assignments().await?,
        };
        let mut jobs = 0;
        for assignment in assignments {
            let mut transaction = self.begin().await?;
            transaction.row("SELECT id FROM assignment WHERE id = ? {for update}", values![assignment.id]).await?;
            let statement = "UPDATE job SET replaced = 1 WHERE campaign IS NULL AND replaced = 0 AND state = 'buried'
                AND submission IN (SELECT submission.id FROM submission
                    JOIN grade ON grade.submission = submission.id
                    JOIN result ON result.id = grade.result AND result.code = 'JE'
                    WHERE submission.assignment = ? AND submission.removed_at IS NULL)";
            transaction.execute(statement, values![assignment.id]).await?;
            let found = enqueue_replaced(&mut transaction, &assignment, self.account.id, 0..=i64::MAX).await?;
            if found > 0 {
                let text = format!("{found} submissions on which the grader failed");
                self.log_event(&mut transaction, "graded again", Some(assignment.id), &text).await?;
            }
            self.app.0.notifier.commit(transaction).await?;
            jobs += found;
        }
        Ok(EnqueuedJobs { jobs })
    }
}
