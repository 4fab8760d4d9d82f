//! A regrade: new results beside the old ones, at low priority, until somebody of the staff applies or discards them as
//! one step. Until then no grade changes.
use super::{
    Settings, Staff, submit,
    view::{self, Assignment},
};
use crate::{
    db::{DbError, Row, Transaction},
    ledger::{self, GradeChange},
    problem::Problem,
    queue::{self, Bell, Lane, NewJob, Turn},
    task::{Form, Input, JUDGE_ERROR, Task},
    values,
};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Where a regrade is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum RegradeState {
    /// Nobody has decided yet.
    Open,
    /// Its results count.
    Applied,
    /// They never did.
    Discarded,
}

/// A regrade and what it would change.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Regrade {
    /// Its number.
    pub id: i64,
    /// Where it is.
    pub state: RegradeState,
    /// Why it is done, as students read it when it is applied.
    pub reason: String,
    /// What submissions are graded by this time.
    pub settings: Settings,
    /// Who began it.
    pub by: String,
    /// When, in milliseconds since 1970.
    pub created_at: i64,
    /// How many submissions it grades.
    pub submissions: usize,
    /// How many of them are still to be graded.
    pub left: usize,
    /// How many the grader failed on: their grades stay.
    pub failed: usize,
    /// What changes.
    pub changes: Vec<Change>,
}

/// A grade that changes, and why.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Change {
    /// The submission.
    pub submission: i64,
    /// Whose it is.
    pub login: String,
    /// The verdict that counts now.
    pub old_code: Option<String>,
    /// The points that count now.
    pub old_points: Option<String>,
    /// The line about it.
    pub old_summary: Option<String>,
    /// The verdict of the regrade.
    pub new_code: String,
    /// Its points.
    pub new_points: Option<String>,
    /// Its line.
    pub new_summary: String,
    /// What differs between the two gradings: version, suite, rules, limits.
    pub why: Vec<String>,
}

impl Staff {
    /// Begins a regrade of all submissions to an assignment, by other settings if there are any.
    ///
    /// # Errors
    /// When another one is open.
    pub async fn regrade(&self, slug: &str, reason: &str, settings: Option<&Settings>) -> Result<Regrade, Problem> {
        super::identity::check_title("a reason", reason)?;
        let assignment = self.member().assignment(slug).await?;
        let settings = settings.unwrap_or(&assignment.settings).checked(self.member().house().suites())?;
        let mut transaction = self.begin().await?;
        transaction.one("SELECT id FROM assignment WHERE id = ? {for update}", values![assignment.id]).await?;
        let open = transaction
            .row("SELECT id FROM campaign WHERE assignment = ? AND state = 'open'", values![assignment.id])
            .await?;
        if open.is_some() {
            return Err(Problem::conflict("another regrade is open", "apply or discard it first"));
        }
        let campaign = transaction
            .one(
                "INSERT INTO campaign (assignment, state, reason, settings, started_by, created_at)
                 VALUES (?, 'open', ?, ?, ?, {now}) RETURNING id",
                values![assignment.id, reason, settings.text(), self.member().account.id],
            )
            .await?
            .int("id")?;
        let newly = Assignment { settings, ..assignment };
        let count = enqueue_missing(&mut transaction, campaign, &newly).await?;
        let text = format!("regrade {campaign} of {count} submissions: {reason}");
        view::note(&mut transaction, &self.deed("regrade", Some(newly.id), &text)).await?;
        Bell::ring(&mut transaction).await?;
        transaction.commit().await?;
        self.member().house.0.bell.strike();
        self.show_regrade(slug, campaign).await
    }

    /// The regrades of an assignment, latest first, without their changes.
    ///
    /// # Errors
    /// When there is no such assignment.
    pub async fn regrades(&self, slug: &str) -> Result<Vec<Regrade>, Problem> {
        let mut transaction = self.member().house.0.database.read().await?;
        let assignment = self.member().find_assignment(&mut transaction, slug).await?;
        let rows = transaction
            .rows(
                "SELECT campaign.id, campaign.state, campaign.reason, campaign.settings, campaign.created_at,
                    account.login
                 FROM campaign JOIN account ON account.id = campaign.started_by
                 WHERE campaign.assignment = ? ORDER BY campaign.id DESC",
                values![assignment.id],
            )
            .await?;
        rows.iter().map(read_regrade).collect()
    }

    /// A regrade and what it would change, or did.
    ///
    /// # Errors
    /// When there is none of this number.
    pub async fn show_regrade(&self, slug: &str, id: i64) -> Result<Regrade, Problem> {
        let mut transaction = self.member().house.0.database.read().await?;
        let assignment = self.member().find_assignment(&mut transaction, slug).await?;
        find(&mut transaction, &assignment, id).await
    }

    /// Makes the results of a regrade count, all in one step, and its settings the assignment's. Where the grader
    /// failed, the old grade stays.
    ///
    /// # Errors
    /// When it is not finished; submissions that came in meanwhile are graded first, too.
    pub async fn apply_regrade(&self, slug: &str, id: i64) -> Result<Regrade, Problem> {
        let assignment = self.member().assignment(slug).await?;
        let mut transaction = self.begin().await?;
        self.lock_open(&mut transaction, &assignment, id).await?;
        let regrade = find(&mut transaction, &assignment, id).await?;
        let newly = Assignment { settings: regrade.settings.clone(), ..assignment };
        let missing = enqueue_missing(&mut transaction, id, &newly).await?;
        if missing > 0 {
            Bell::ring(&mut transaction).await?;
            transaction.commit().await?;
            self.member().house.0.bell.strike();
            return Err(Problem::conflict(
                format!("{missing} submissions came in meanwhile, and are graded now"),
                "look at them, and apply then",
            ));
        }
        if regrade.left > 0 {
            return Err(Problem::conflict(format!("{} submissions are not graded yet", regrade.left), "wait"));
        }
        let results = transaction
            .rows(
                "SELECT id, submission FROM result WHERE campaign = ? AND code <> ? ORDER BY id",
                values![id, JUDGE_ERROR],
            )
            .await?;
        for row in &results {
            let change = GradeChange {
                submission: row.int("submission")?,
                result: row.int("id")?,
                by: Some(self.member().account.id),
                campaign: Some(id),
                reason: &regrade.reason,
            };
            ledger::set_grade(&mut transaction, &change).await?;
        }
        for change in &regrade.changes {
            let mut deed = self.deed("grade changed", Some(newly.id), &regrade.reason);
            deed.submission = Some(change.submission);
            view::note(&mut transaction, &deed).await?;
        }
        transaction
            .execute("UPDATE assignment SET settings = ? WHERE id = ?", values![newly.settings.text(), newly.id])
            .await?;
        self.decide(&mut transaction, &newly, id, "applied").await?;
        transaction.commit().await?;
        self.member().house.0.bell.strike();
        self.show_regrade(slug, id).await
    }

    /// Gives a regrade up: its waiting jobs are cancelled, and nothing changes.
    ///
    /// # Errors
    /// When it is decided already.
    pub async fn discard_regrade(&self, slug: &str, id: i64) -> Result<Regrade, Problem> {
        let assignment = self.member().assignment(slug).await?;
        let mut transaction = self.begin().await?;
        self.lock_open(&mut transaction, &assignment, id).await?;
        transaction
            .execute(
                "UPDATE job SET state = 'cancelled', finished_at = {now}, lease_key = NULL, lease_until = NULL
                 WHERE campaign = ? AND state IN ('waiting', 'running')",
                values![id],
            )
            .await?;
        self.decide(&mut transaction, &assignment, id, "discarded").await?;
        transaction.commit().await?;
        self.show_regrade(slug, id).await
    }

    async fn lock_open(&self, transaction: &mut Transaction, assignment: &Assignment, id: i64) -> Result<(), Problem> {
        let row = transaction
            .row("SELECT state FROM campaign WHERE id = ? AND assignment = ? {for update}", values![id, assignment.id])
            .await?;
        match row.map(|row| row.text("state")).transpose()?.as_deref() {
            None => Err(Problem::not_found("regrade")),
            Some("open") => Ok(()),
            Some(state) => Err(Problem::conflict(format!("this regrade is {state}"), "begin a new one")),
        }
    }

    async fn decide(
        &self,
        transaction: &mut Transaction,
        assignment: &Assignment,
        id: i64,
        state: &'static str,
    ) -> Result<(), DbError> {
        transaction
            .execute(
                "UPDATE campaign SET state = ?, decided_by = ?, decided_at = {now} WHERE id = ?",
                values![state, self.member().account.id, id],
            )
            .await?;
        let text = format!("regrade {id} {state}");
        view::note(transaction, &self.deed("regrade", Some(assignment.id), &text)).await
    }
}

/// Enqueues the submissions that the regrade does not know yet, and says how many these are.
async fn enqueue_missing(transaction: &mut Transaction, campaign: i64, newly: &Assignment) -> Result<usize, Problem> {
    let rows = transaction
        .rows(
            "SELECT id, form, file_name, digest, size FROM submission
             WHERE assignment = ? AND removed_at IS NULL
                AND NOT EXISTS (SELECT 1 FROM job WHERE job.submission = submission.id AND job.campaign = ?)
             ORDER BY id",
            values![newly.id, campaign],
        )
        .await?;
    for row in &rows {
        let payload = serde_json::to_string(&submit::task(newly, read_input(row)?)).map_err(|_| Problem::fault())?;
        let job = NewJob {
            lane: Lane::Grading,
            submission: Some(row.int("id")?),
            campaign: Some(campaign),
            turn: Turn::Campaign(campaign),
            payload: &payload,
        };
        queue::enqueue(transaction, &job).await?;
    }
    Ok(rows.len())
}

fn read_input(row: &Row) -> Result<Input, DbError> {
    let wrong = |what: &str| DbError::Other(format!("a submission's {what} is none"));
    let form = match row.text("form")?.as_str() {
        "program" => Form::Program,
        "sources" => Form::Sources,
        "traces" => Form::Traces,
        _ => return Err(wrong("form")),
    };
    let digest = row.text("digest")?.parse().map_err(|_| wrong("digest"))?;
    let size = u64::try_from(row.int("size")?).map_err(|_| wrong("size"))?;
    Ok(Input { form, name: row.text("file_name")?, artefact: crate::store::Artefact { digest, size } })
}

fn read_regrade(row: &Row) -> Result<Regrade, Problem> {
    Ok(Regrade {
        id: row.int("id")?,
        state: match row.text("state")?.as_str() {
            "applied" => RegradeState::Applied,
            "discarded" => RegradeState::Discarded,
            _ => RegradeState::Open,
        },
        reason: row.text("reason")?,
        settings: Settings::read(&row.text("settings")?)?,
        by: row.text("login")?,
        created_at: row.int("created_at")?,
        submissions: 0,
        left: 0,
        failed: 0,
        changes: Vec::new(),
    })
}

async fn find(transaction: &mut Transaction, assignment: &Assignment, id: i64) -> Result<Regrade, Problem> {
    let row = transaction
        .row(
            "SELECT campaign.id, campaign.state, campaign.reason, campaign.settings, campaign.created_at,
                account.login
             FROM campaign JOIN account ON account.id = campaign.started_by
             WHERE campaign.id = ? AND campaign.assignment = ?",
            values![id, assignment.id],
        )
        .await?;
    let Some(row) = row else { return Err(Problem::not_found("regrade")) };
    let mut regrade = read_regrade(&row)?;
    // What a regrade replaced: the grade before it where it was applied, and the one that counts otherwise.
    let rows = transaction
        .rows(
            "SELECT job.state, job.submission, account.login, new.code AS new_code, new.points AS new_points,
                new.summary AS new_summary, new.version AS new_version, new.task AS new_task, old.code AS old_code,
                old.points AS old_points, old.summary AS old_summary, old.version AS old_version, old.task AS old_task
             FROM job
             JOIN submission ON submission.id = job.submission
             JOIN account ON account.id = submission.account
             LEFT JOIN result AS new ON new.job = job.id
             LEFT JOIN grade ON grade.submission = submission.id
             LEFT JOIN grade_change ON grade_change.submission = submission.id AND grade_change.campaign = job.campaign
             LEFT JOIN result AS old ON old.id =
                CASE WHEN grade_change.id IS NULL THEN grade.result ELSE grade_change.old_result END
             WHERE job.campaign = ? ORDER BY job.id",
            values![id],
        )
        .await?;
    for row in &rows {
        regrade.submissions += 1;
        if matches!(row.text("state")?.as_str(), "waiting" | "running") {
            regrade.left += 1;
        }
        let Some(new_code) = row.maybe_text("new_code")? else { continue };
        if new_code == JUDGE_ERROR {
            regrade.failed += 1;
            continue;
        }
        let change = Change {
            submission: row.int("submission")?,
            login: row.text("login")?,
            old_code: row.maybe_text("old_code")?,
            old_points: row.maybe_text("old_points")?,
            old_summary: row.maybe_text("old_summary")?,
            new_code,
            new_points: row.maybe_text("new_points")?,
            new_summary: row.text("new_summary")?,
            why: why(row)?,
        };
        if (change.old_code.as_ref(), &change.old_points) != (Some(&change.new_code), &change.new_points) {
            regrade.changes.push(change);
        }
    }
    Ok(regrade)
}

/// What differs between two gradings of one submission.
fn why(row: &Row) -> Result<Vec<String>, DbError> {
    let (Some(old_version), Some(old_task)) = (row.maybe_text("old_version")?, row.maybe_text("old_task")?) else {
        return Ok(vec!["there was no grade before".to_owned()]);
    };
    let mut why = Vec::new();
    let new_version = row.text("new_version")?;
    if old_version != new_version {
        why.push(format!("version {old_version} before, {new_version} now"));
    }
    let read = |text: &str| serde_json::from_str::<Task>(text).ok();
    if let (Some(old), Some(new)) = (read(&old_task), read(&row.text("new_task")?)) {
        let mut differ = |what: &str, old: String, new: String| {
            if old != new {
                why.push(format!("{what} {old} before, {new} now"));
            }
        };
        let or_suite = |value: Option<String>| value.unwrap_or_else(|| "of the suite".to_owned());
        let suite = |task: &Task| match &task.suite {
            crate::task::Suite::Named(name) => name.clone(),
            crate::task::Suite::Archive(digest) => digest.short().to_owned(),
        };
        differ("suite", suite(&old), suite(&new));
        differ("rules", or_suite(old.rules), or_suite(new.rules));
        differ("seconds", old.seconds.to_string(), new.seconds.to_string());
        differ("program", old.program, new.program);
    }
    if why.is_empty() {
        why.push(
            "graded by the same, with another result: the program does not always do the same, or was slow".to_owned(),
        );
    }
    Ok(why)
}
