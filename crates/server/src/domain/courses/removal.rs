//! Removes people, submissions, assignments and courses with all their data. The audit log records the removal without
//! names. An artifact stays in the store until nothing refers to it, see [`retention`](crate::retention). If a removed
//! submission is being graded, the job loses its lease and ends without effect.
use crate::domain::{Admin, Staff};
use crate::{
    db::{Database, DbError, Transaction},
    lti::score,
    problem::{Problem, ensure},
    values,
};

/// The tables whose rows belong to submissions, in the order of removal.
const TABLES: [&str; 10] = [
    "DELETE FROM result_file WHERE result IN (SELECT result.id FROM result JOIN {each}
        ON result.submission = CAST(wanted.value AS {int}))",
    "DELETE FROM mark WHERE submission IN (SELECT CAST(wanted.value AS {int}) FROM {each})",
    "DELETE FROM grade_change WHERE submission IN (SELECT CAST(wanted.value AS {int}) FROM {each})",
    "DELETE FROM grade WHERE submission IN (SELECT CAST(wanted.value AS {int}) FROM {each})",
    "DELETE FROM result WHERE submission IN (SELECT CAST(wanted.value AS {int}) FROM {each})",
    "DELETE FROM job_file WHERE job IN (SELECT job.id FROM job JOIN {each}
        ON job.submission = CAST(wanted.value AS {int}))",
    "DELETE FROM job WHERE submission IN (SELECT CAST(wanted.value AS {int}) FROM {each})",
    "DELETE FROM upload_key WHERE submission IN (SELECT CAST(wanted.value AS {int}) FROM {each})",
    "DELETE FROM event WHERE submission IN (SELECT CAST(wanted.value AS {int}) FROM {each})",
    "DELETE FROM submission WHERE id IN (SELECT CAST(wanted.value AS {int}) FROM {each})",
];

/// Selects some submissions of an assignment. They are removed in batches, so that other transactions can write in
/// between.
const SOME_OF_ASSIGNMENT: &str = "SELECT id FROM submission WHERE assignment = ? ORDER BY id LIMIT 500";
const SOME_OF_COURSE: &str =
    "SELECT id FROM submission WHERE assignment IN (SELECT id FROM assignment WHERE course = ?)
    ORDER BY id LIMIT 500";
const SOME_OF_PERSON: &str = "SELECT id FROM submission WHERE account = ? ORDER BY id LIMIT 500";

const SELECT_BY_ASSIGNMENT: &str = "SELECT id FROM submission WHERE assignment = ?";
const SELECT_BY_COURSE: &str =
    "SELECT id FROM submission WHERE assignment IN (SELECT id FROM assignment WHERE course = ?)";
const SELECT_BY_PERSON: &str = "SELECT id FROM submission WHERE account = ?";

/// Removes the jobs of the submissions that a statement selects, and returns the submissions' IDs as JSON. Waits for
/// jobs that are about to finish.
async fn cancel_jobs(transaction: &mut Transaction, which: &'static str, value: i64) -> Result<String, DbError> {
    let rows = transaction.rows(which, values![value]).await?;
    let ids = rows.iter().map(|row| row.int("id")).collect::<Result<Vec<_>, _>>()?;
    let ids = serde_json::to_string(&ids).unwrap_or_default();
    let statement = "WITH going AS (SELECT id FROM job WHERE state IN ('waiting', 'running')
           AND submission IN (SELECT CAST(wanted.value AS {int}) FROM {each}) ORDER BY id {for update})
        UPDATE job SET state = 'cancelled', finished_at = {now}, lease_key = NULL, lease_until = NULL
        WHERE id IN (SELECT id FROM going)";
    transaction.execute(statement, values![&ids]).await?;
    Ok(ids)
}

/// Removes all data of the submissions that a statement selects. Waits for transactions that write data of these
/// submissions.
async fn remove_submissions(transaction: &mut Transaction, which: &'static str, value: i64) -> Result<(), DbError> {
    let ids = cancel_jobs(transaction, which, value).await?;
    let locked = "SELECT id FROM submission WHERE id IN (SELECT CAST(wanted.value AS {int}) FROM {each})
                  ORDER BY id {for removal}";
    transaction.rows(locked, values![&ids]).await?;
    for statement in TABLES {
        transaction.execute(statement, values![&ids]).await?;
    }
    Ok(())
}

/// Removes submissions in batches, until the statement selects no more. Submissions that arrive later are left for the
/// caller to remove.
async fn remove_in_batches(database: &Database, which: &'static str, value: i64) -> Result<(), DbError> {
    loop {
        let mut transaction = database.begin().await?;
        if transaction.row(which, values![value]).await?.is_none() {
            return Ok(());
        }
        remove_submissions(&mut transaction, which, value).await?;
        transaction.commit().await?;
    }
}

async fn run_statements(transaction: &mut Transaction, statements: &[&'static str], id: i64) -> Result<(), DbError> {
    for statement in statements {
        transaction.execute(statement, values![id]).await?;
    }
    Ok(())
}

impl Staff {
    /// Removes a submission.
    ///
    /// # Errors
    ///
    /// Fails if the course has no submission with this ID.
    pub async fn remove_submission(&self, id: i64) -> Result<(), Problem> {
        let mut transaction = self.begin().await?;
        let statement = "SELECT assignment.id FROM submission JOIN assignment ON assignment.id = submission.assignment
            WHERE submission.id = ? AND assignment.course = ?";
        let found = transaction.row(statement, values![id, self.course]).await?;
        let Some(found) = found else { return Err(Problem::not_found("submission")) };
        score::queue_changed_scores(&mut transaction, id).await?;
        remove_submissions(&mut transaction, "SELECT id FROM submission WHERE id = ?", id).await?;
        self.log_event(&mut transaction, "removed", Some(found.int("id")?), "a submission").await?;
        Ok(self.app.0.notifier.commit(transaction).await?)
    }

    /// Removes an assignment with its submissions.
    ///
    /// # Errors
    /// Fails if there is no such assignment.
    pub async fn remove_assignment(&self, slug: &str) -> Result<(), Problem> {
        let assignment = self.assignment(slug).await?;
        remove_in_batches(&self.app.0.database, SOME_OF_ASSIGNMENT, assignment.id).await?;
        let mut transaction = self.begin().await?;
        cancel_jobs(&mut transaction, SELECT_BY_ASSIGNMENT, assignment.id).await?;
        // After this statement, no upload to the assignment is accepted.
        transaction.rows("SELECT id FROM assignment WHERE id = ? {for removal}", values![assignment.id]).await?;
        remove_submissions(&mut transaction, SELECT_BY_ASSIGNMENT, assignment.id).await?;
        let rest = [
            "DELETE FROM platform_score WHERE link IN (SELECT id FROM platform_link WHERE assignment = ?)",
            "DELETE FROM platform_link WHERE assignment = ?",
            "DELETE FROM numbering WHERE assignment = ?",
            "DELETE FROM extension WHERE assignment = ?",
            "DELETE FROM campaign WHERE assignment = ?",
            "DELETE FROM event WHERE assignment = ?",
            "DELETE FROM assignment WHERE id = ?",
        ];
        run_statements(&mut transaction, &rest, assignment.id).await?;
        self.log_event(&mut transaction, "removed", None, &format!("the assignment {slug}")).await?;
        Ok(transaction.commit().await?)
    }
}

impl Admin {
    async fn find_course(&self, transaction: &mut Transaction, slug: &str) -> Result<i64, Problem> {
        let row = transaction.row("SELECT id FROM course WHERE slug = ?", values![slug]).await?;
        Ok(row.ok_or_else(|| Problem::not_found("course"))?.int("id")?)
    }

    /// Removes a course with its assignments and submissions. People's accounts stay.
    ///
    /// # Errors
    /// Fails if there is no such course.
    pub async fn remove_course(&self, slug: &str) -> Result<(), Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let course = self.find_course(&mut transaction, slug).await?;
        drop(transaction);
        remove_in_batches(&self.app.0.database, SOME_OF_COURSE, course).await?;
        let mut transaction = self.app.0.database.begin().await?;
        cancel_jobs(&mut transaction, SELECT_BY_COURSE, course).await?;
        transaction.rows("SELECT id FROM course WHERE id = ? {for removal}", values![course]).await?;
        transaction.rows("SELECT id FROM assignment WHERE course = ? {for removal}", values![course]).await?;
        remove_submissions(&mut transaction, SELECT_BY_COURSE, course).await?;
        let rest = [
            "DELETE FROM platform_score WHERE link IN (SELECT platform_link.id FROM platform_link
                JOIN platform_course ON platform_course.id = platform_link.platform_course WHERE course = ?)",
            "DELETE FROM platform_link WHERE platform_course IN (SELECT id FROM platform_course WHERE course = ?)",
            "DELETE FROM platform_member WHERE platform_course IN (SELECT id FROM platform_course WHERE course = ?)",
            "DELETE FROM platform_course WHERE course = ?",
            "DELETE FROM numbering WHERE assignment IN (SELECT id FROM assignment WHERE course = ?)",
            "DELETE FROM extension WHERE assignment IN (SELECT id FROM assignment WHERE course = ?)",
            "DELETE FROM campaign WHERE assignment IN (SELECT id FROM assignment WHERE course = ?)",
            "DELETE FROM assignment WHERE course = ?",
            "DELETE FROM suite WHERE course = ?",
            "DELETE FROM kept_bytes WHERE course = ?",
            "DELETE FROM member WHERE course = ?",
            "UPDATE account SET managed_by = NULL WHERE managed_by = ?",
            "DELETE FROM event WHERE course = ?",
            "DELETE FROM course WHERE id = ?",
        ];
        run_statements(&mut transaction, &rest, course).await?;
        self.log_event(&mut transaction, "removed", "a course with its assignments, submissions and members").await?;
        Ok(transaction.commit().await?)
    }

    /// Removes a person's submissions and results, their names, and every way to sign in. Their actions as staff stay
    /// in the log, without a name.
    ///
    /// # Errors
    ///
    /// Fails if the account does not exist, or is the administrator's own.
    pub async fn remove_person(&self, login: &str) -> Result<(), Problem> {
        ensure(login != self.account.login, Problem::own_account())?;
        let mut transaction = self.app.0.database.read().await?;
        let row = transaction.row("SELECT id FROM account WHERE login = ?", values![login]).await?;
        drop(transaction);
        let Some(row) = row else { return Err(Problem::not_found("account")) };
        let account = row.int("id")?;
        remove_in_batches(&self.app.0.database, SOME_OF_PERSON, account).await?;
        let mut transaction = self.app.0.database.begin().await?;
        cancel_jobs(&mut transaction, SELECT_BY_PERSON, account).await?;
        transaction.rows("SELECT id FROM account WHERE id = ? {for removal}", values![account]).await?;
        remove_submissions(&mut transaction, SELECT_BY_PERSON, account).await?;
        let rest = [
            "DELETE FROM platform_score WHERE account = ?",
            "DELETE FROM platform_choice WHERE account = ?",
            "DELETE FROM platform_member WHERE account = ?",
            "DELETE FROM platform_account WHERE account = ?",
            "DELETE FROM numbering WHERE account = ?",
            "DELETE FROM extension WHERE account = ?",
            "DELETE FROM kept_bytes WHERE account = ?",
            "DELETE FROM member WHERE account = ?",
            "DELETE FROM session WHERE account = ?",
            "DELETE FROM sign_in_link WHERE account = ?",
            "DELETE FROM token WHERE account = ?",
        ];
        run_statements(&mut transaction, &rest, account).await?;
        let nobody = format!("removed-{account}");
        let statement = "UPDATE account SET login = ?, name = 'a removed person', is_admin = 0,
            managed_by = NULL, disabled_at = {now} WHERE id = ?";
        transaction.execute(statement, values![&nobody, account]).await?;
        // Sentences in the log may contain logins as well.
        let statement = "SELECT id, text FROM event WHERE text LIKE '%' || CAST(? AS TEXT) || '%'";
        let rows = transaction.rows(statement, values![login]).await?;
        for row in &rows {
            let text = replace_name(&row.text("text")?, login, &nobody);
            transaction.execute("UPDATE event SET text = ? WHERE id = ?", values![text, row.int("id")?]).await?;
        }
        self.log_event(&mut transaction, "removed", "a person with all their data").await?;
        Ok(transaction.commit().await?)
    }
}

/// Returns a sentence in which a name is replaced by `replacement`, wherever the name is a whole word.
fn replace_name(text: &str, name: &str, replacement: &str) -> String {
    let is_word_char = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
    let mut rest = text;
    let mut replaced = String::with_capacity(text.len());
    while let Some(at) = rest.find(name) {
        let (before, after) = (&rest[..at], &rest[at + name.len()..]);
        let is_whole_word = !replaced.chars().chain(before.chars()).next_back().is_some_and(is_word_char)
            && !after.starts_with(is_word_char);
        replaced.push_str(before);
        replaced.push_str(if is_whole_word { replacement } else { name });
        rest = after;
    }
    replaced + rest
}

#[cfg(test)]
mod tests {
    use super::replace_name;

    #[test]
    fn only_whole_names_are_replaced() {
        let without = |text: &str| replace_name(text, "ada", "removed-7");
        assert_eq!(without("ada is student"), "removed-7 is student");
        assert_eq!(without("a link for ada"), "a link for removed-7");
        assert_eq!(
            without("ada: 3 of 4, adam, ada.b, b-ada, (ada)"),
            "removed-7: 3 of 4, adam, ada.b, b-ada, (removed-7)"
        );
    }
}
