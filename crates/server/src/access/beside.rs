//! Submissions that may stand beside another one: other attempts of the same person, and for staff those of others.
use super::{Member, view::Submission};
use crate::{problem::Problem, values};

impl Member {
    /// The other attempts of a submission's owner, latest first: their numbers of submission and attempt.
    ///
    /// # Errors
    /// When the database does not answer.
    pub async fn attempts_beside(&self, submission: &Submission) -> Result<Vec<(i64, i64)>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT other.id, other.number FROM submission AS other
            JOIN submission AS one ON one.assignment = other.assignment AND one.account = other.account
            WHERE one.id = ? AND other.id <> one.id ORDER BY other.id DESC";
        let rows = transaction.rows(statement, values![submission.id]).await?;
        rows.iter().map(|row| Ok((row.int("id")?, row.int("number")?))).collect()
    }

    /// The latest graded submission of somebody to the same assignment. Whether the member may see it is asked when it
    /// is opened.
    ///
    /// # Errors
    /// When there is none.
    pub async fn latest_beside(&self, submission: &Submission, login: &str) -> Result<i64, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT other.id FROM submission AS other
            JOIN submission AS one ON one.assignment = other.assignment
            JOIN account ON account.id = other.account
            JOIN grade ON grade.submission = other.id
            WHERE one.id = ? AND account.login = ? ORDER BY other.id DESC LIMIT 1";
        let row = transaction.row(statement, values![submission.id, login]).await?;
        let row = row.ok_or_else(|| Problem::not_found("graded submission of this login"))?;
        Ok(row.int("id")?)
    }
}
