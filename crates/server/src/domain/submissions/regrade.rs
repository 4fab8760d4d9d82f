//! Regrades: new results that are stored next to the old ones, at low priority. No grade changes until a member of
//! staff applies the regrade; it can also be discarded.
use crate::domain::{
    Settings, Staff,
    assignments::suites::{UploadedSuite, describe_suite, read_suites},
    submissions::regrade_steps,
    view::Assignment,
};
use crate::{
    db::{DbError, FromRow, Row, Transaction, from_row, read_row},
    problem::{Problem, ensure},
    task::{JUDGE_ERROR, Task},
    values,
};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The maximum number of changes in one answer.
const MAX_CHANGES: i64 = 1000;

/// The state of a regrade.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "lowercase")]
pub enum RegradeState {
    /// Staff have not decided yet.
    #[default]
    Open,
    /// The regrade's results count.
    Applied,
    /// The regrade was discarded, and its results never counted.
    Discarded,
}

/// A regrade, with the grades that it would change or has changed.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, ToSchema)]
pub struct Regrade {
    /// The regrade's ID.
    pub id: i64,
    /// The state of the regrade.
    pub state: RegradeState,
    /// The reason for the regrade, which students read after it is applied.
    pub reason: String,
    /// The settings that the regrade uses.
    pub settings: Settings,
    /// The login of the person who began the regrade.
    pub by: String,
    /// The time of creation, in milliseconds since 1970.
    pub created_at: i64,
    /// The number of submissions in the regrade.
    pub submissions: usize,
    /// The number of submissions that the regrade has not graded yet.
    pub left: usize,
    /// The number of submissions on which the grader failed. Their old grades stay.
    pub failed: usize,
    /// The number of submissions that arrived after the regrade began and are not in it. It is 0 unless the regrade is
    /// open.
    pub arrived: usize,
    /// The grades that staff set, up to the maximum number of changes. They stay, even if the maximum changes.
    pub set_by_staff: Vec<StaffGrade>,
    /// The number of grades that change.
    pub changed: usize,
    /// The number of submissions that get more points.
    pub more: usize,
    /// The number of submissions that get fewer points.
    pub fewer: usize,
    /// The changes, in the order of their owners' names, up to the requested number.
    pub changes: Vec<Change>,
    /// The cursor of the next page: the ID of the last listed submission; null on the last page.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub next: Option<i64>,
    /// Whether the suite of the regrade hides groups.
    #[serde(skip)]
    pub(crate) hides_groups: bool,
}

impl Regrade {
    /// Returns the reasons for the change, if all shown changes have the same ones.
    pub fn shared_differences(&self) -> Option<String> {
        let (first, rest) = self.changes.split_first()?;
        rest.iter().all(|change| change.why == first.why).then(|| first.why.join("; "))
    }
}

/// A grade that staff set, which a regrade does not change.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct StaffGrade {
    /// The submission's ID.
    pub submission: i64,
    /// The submission's number among its owner's submissions to this assignment, starting at 1.
    pub number: i64,
    /// The login of the owner.
    pub login: String,
    /// The points that staff set.
    pub points: String,
    /// The maximum number of points before the regrade.
    pub old_max_points: Option<String>,
    /// The maximum number of points that the regrade gives.
    pub new_max_points: Option<String>,
}

from_row! { StaffGrade { submission, number, login, points, old_max_points, new_max_points } }

/// A grade that the regrade changes, with the likely reasons.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Change {
    /// The submission's ID.
    pub submission: i64,
    /// The submission's number among its owner's submissions to this assignment, starting at 1.
    pub number: i64,
    /// The login of the owner.
    pub login: String,
    /// The name of the owner.
    #[serde(skip)]
    pub(crate) name: String,
    /// The code of the verdict that counts at present.
    pub old_code: Option<String>,
    /// The points that count at present.
    pub old_points: Option<String>,
    /// The maximum number of points at present.
    pub old_max_points: Option<String>,
    /// The result that counts at present, in one line.
    pub old_summary: Option<String>,
    /// The code of the regrade's verdict.
    pub new_code: String,
    /// The points that the regrade gives.
    pub new_points: Option<String>,
    /// The maximum number of points that the regrade gives.
    pub new_max_points: Option<String>,
    /// The regrade's result, in one line.
    pub new_summary: String,
    /// The differences between the two gradings that may explain the change, such as another version, suite, rule book
    /// or limit.
    pub why: Vec<String>,
}

/// Selects regrades, without their changes. The argument is the end of the statement.
macro_rules! regrades {
    ($which:literal) => {
        concat!(
            "SELECT campaign.id, campaign.state, campaign.reason, campaign.settings, campaign.created_at, account.login
             FROM campaign JOIN account ON account.id = campaign.started_by WHERE ",
            $which
        )
    };
}

impl Staff {
    /// Begins a regrade of all submissions to an assignment, with given settings.
    ///
    /// # Errors
    ///
    /// Fails if another regrade of the assignment is open.
    pub async fn regrade(&self, slug: &str, reason: &str, settings: &Settings) -> Result<Regrade, Problem> {
        crate::domain::accounts::identity::check_title("a reason", reason)?;
        let assignment = self.assignment(slug).await?;
        let settings = settings.validate(&self.app.suites)?;
        let mut transaction = self.begin().await?;
        self.check_suite(&mut transaction, &settings).await?;
        transaction.one("SELECT id FROM assignment WHERE id = ? {for update}", values![assignment.id]).await?;
        let statement = "SELECT id FROM campaign WHERE assignment = ? AND state = 'open'";
        ensure(
            transaction.row(statement, values![assignment.id]).await?.is_none(),
            Problem::conflict("another regrade is open", "apply or discard it first"),
        )?;
        let statement = "INSERT INTO campaign (assignment, state, reason, settings, started_by, created_at)
            VALUES (?, 'open', ?, ?, ?, {now}) RETURNING id";
        let values = values![assignment.id, reason, settings.to_json(), self.account.id];
        let id = transaction.one(statement, values).await?.int("id")?;
        let regraded = Assignment { settings, ..assignment };
        let count = regrade_steps::enqueue_missing(&mut transaction, id, &regraded).await?;
        let text = format!("began regrade {id} of {count} submissions: {reason}");
        self.log_event(&mut transaction, "regrade", Some(regraded.id), &text).await?;
        self.app.0.notifier.commit(transaction).await?;
        self.show_regrade(slug, id, None).await
    }

    /// Returns the regrades of an assignment, newest first, without their changes.
    ///
    /// # Errors
    /// Fails if there is no such assignment.
    pub async fn regrades(&self, slug: &str) -> Result<Vec<Regrade>, Problem> {
        let (mut transaction, assignment) = self.read_assignment(slug).await?;
        let statement = regrades!("campaign.assignment = ? ORDER BY campaign.id DESC LIMIT 100");
        Ok(transaction.all(statement, values![assignment.id]).await?)
    }

    /// Returns a regrade and its changes, beginning after the submission with the ID `after`.
    ///
    /// # Errors
    /// Fails if there is no regrade with this ID.
    pub async fn show_regrade(&self, slug: &str, id: i64, after: Option<i64>) -> Result<Regrade, Problem> {
        let (mut transaction, assignment) = self.read_assignment(slug).await?;
        let uploaded = read_suites(&mut transaction, self.course).await?;
        find(&mut transaction, &assignment, id, after.unwrap_or(0), &uploaded).await
    }

    /// Adds the submissions that arrived after an open regrade began.
    ///
    /// # Errors
    ///
    /// Fails if there is no such regrade, or it was applied or discarded.
    pub async fn regrade_newcomers(&self, slug: &str, id: i64) -> Result<(), Problem> {
        let assignment = self.assignment(slug).await?;
        let mut transaction = self.begin().await?;
        let (settings, _) = self.lock_open(&mut transaction, &assignment, id).await?;
        regrade_steps::enqueue_missing(&mut transaction, id, &Assignment { settings, ..assignment }).await?;
        Ok(self.app.0.notifier.commit(transaction).await?)
    }

    /// Makes the results of a regrade count, and copies its grading settings to the assignment. If the grader failed on
    /// a submission, its old grade stays. If the suite changes, published groups are withheld again.
    ///
    /// # Errors
    ///
    /// Fails if the regrade is not finished, or if submissions have arrived in the meantime that are not graded yet.
    pub async fn apply_regrade(&self, slug: &str, id: i64) -> Result<Regrade, Problem> {
        let assignment = self.assignment(slug).await?;
        let mut transaction = self.begin().await?;
        let (settings, reason) = self.lock_open(&mut transaction, &assignment, id).await?;
        let regraded = Assignment { settings: settings.clone(), ..assignment };
        let missing = regrade_steps::enqueue_missing(&mut transaction, id, &regraded).await?;
        if missing > 0 {
            self.app.0.notifier.commit(transaction).await?;
            return Err(Problem::conflict(
                match missing {
                    1 => "1 submission arrived in the meantime, and is being graded".to_owned(),
                    _ => format!("{missing} submissions arrived since the regrade began, and are being graded"),
                },
                "check them, then apply",
            ));
        }
        let statement = "SELECT count(*) AS n FROM job WHERE campaign = ? AND state IN ('waiting', 'running')";
        let waiting = transaction.one(statement, values![id]).await?.int("n")?;
        ensure(waiting == 0, Problem::conflict(format!("{waiting} submissions are not graded yet"), "wait"))?;
        // Later submissions are graded by these settings.
        let before = "SELECT settings, published_at FROM assignment WHERE id = ? {for update}";
        let row = transaction.one(before, values![regraded.id]).await?;
        let before = Settings::from_json(&row.text("settings")?)?;
        let mut changes = before.grading_changes(&settings, &read_suites(&mut transaction, self.course).await?);
        // The groups that the new suite hides are not those that were published.
        let withholds_groups = row.maybe_int("published_at")?.is_some()
            && !before.has_suite_of(&settings)
            && hides_groups(&mut transaction, id).await?;
        let statement = "UPDATE assignment SET settings = ?, revision = revision + 1,
            published_at = CASE WHEN ? = 0 THEN published_at END WHERE id = ?";
        let new = before.with_grading_of(&settings).to_json();
        transaction.execute(statement, values![new, withholds_groups, regraded.id]).await?;
        regrade_steps::apply(&mut transaction, id, (self.account.id, self.course, regraded.id), &reason).await?;
        if withholds_groups {
            changes.push("withheld hidden groups".to_owned());
        }
        self.decide(transaction, regraded.id, id, "applied", &changes.join("; ")).await?;
        self.show_regrade(slug, id, None).await
    }

    /// Discards a regrade: its waiting jobs are canceled, and no grade changes.
    ///
    /// # Errors
    ///
    /// Fails if there is no such regrade, or it was applied or discarded.
    pub async fn discard_regrade(&self, slug: &str, id: i64) -> Result<Regrade, Problem> {
        let assignment = self.assignment(slug).await?;
        let mut transaction = self.begin().await?;
        self.lock_open(&mut transaction, &assignment, id).await?;
        regrade_steps::cancel(&mut transaction, id).await?;
        self.decide(transaction, assignment.id, id, "discarded", "").await?;
        self.show_regrade(slug, id, None).await
    }

    /// Locks an open regrade, so that no other decision about it can be made at the same time. Returns its settings and
    /// reason.
    async fn lock_open(
        &self,
        transaction: &mut Transaction,
        assignment: &Assignment,
        id: i64,
    ) -> Result<(Settings, String), Problem> {
        let statement = "SELECT state, settings, reason FROM campaign WHERE id = ? AND assignment = ? {for update}";
        let row = transaction.row(statement, values![id, assignment.id]).await?;
        let row = row.ok_or_else(|| Problem::not_found("regrade"))?;
        match row.text("state")?.as_str() {
            "open" => Ok((Settings::from_json(&row.text("settings")?)?, row.text("reason")?)),
            state => Err(Problem::conflict(format!("this regrade is {state}"), "begin a new one")),
        }
    }

    /// Stores whether a regrade was applied or discarded, and by whom.
    async fn decide(
        &self,
        mut transaction: Transaction,
        assignment: i64,
        id: i64,
        state: &'static str,
        changes: &str,
    ) -> Result<(), Problem> {
        let statement = "UPDATE campaign SET state = ?, decided_by = ?, decided_at = {now} WHERE id = ?";
        transaction.execute(statement, values![state, self.account.id, id]).await?;
        let text = format!("{state} regrade {id}; {changes}");
        self.log_event(&mut transaction, "regrade", Some(assignment), text.trim_end_matches("; ")).await?;
        Ok(self.app.0.notifier.commit(transaction).await?)
    }
}

impl FromRow for Regrade {
    fn from_row(row: &Row) -> Result<Self, DbError> {
        Ok(read_row!(row => Self {
            id, reason, by = "login", created_at;
            state: match row.text("state")?.as_str() {
                "applied" => RegradeState::Applied,
                "discarded" => RegradeState::Discarded,
                _ => RegradeState::Open,
            },
            settings: Settings::from_json(&row.text("settings")?)?,
            ..Self::default()
        }))
    }
}

/// Selects the jobs of a regrade, with their results and the results that count. After the regrade is applied, these
/// are the results that counted previously.
macro_rules! regraded {
    ($columns:literal, $rest:expr) => {
        concat!(
            "SELECT ",
            $columns,
            " FROM job
             JOIN submission ON submission.id = job.submission
             JOIN account ON account.id = submission.account
             JOIN result AS new ON new.job = job.id
             LEFT JOIN grade ON grade.submission = submission.id
             LEFT JOIN grade_change ON grade_change.submission = submission.id AND grade_change.campaign = job.campaign
             LEFT JOIN result AS old ON old.id =
                CASE WHEN grade_change.id IS NULL THEN grade.result ELSE grade_change.old_result END
             LEFT JOIN mark ON mark.submission = submission.id
             WHERE job.campaign = ? AND new.code <> 'JE' ",
            $rest
        )
    };
    // Selects the grades that differ. The points that staff set stay.
    (changed $columns:literal, $rest:literal) => {
        regraded!(
            $columns,
            concat!(
                "AND mark.points IS NULL AND (old.id IS NULL OR old.code <> new.code
                    OR coalesce(old.points, '') <> coalesce(new.points, '')) ",
                $rest
            )
        )
    };
}

/// Returns whether a result of a regrade has groups that students do not see immediately.
async fn hides_groups(transaction: &mut Transaction, id: i64) -> Result<bool, DbError> {
    let statement = "SELECT id FROM result
        WHERE campaign = ? AND coalesce(shown, 'unknown') <> '' AND code <> ? LIMIT 1";
    Ok(transaction.row(statement, values![id, JUDGE_ERROR]).await?.is_some())
}

async fn find(
    transaction: &mut Transaction,
    assignment: &Assignment,
    id: i64,
    after: i64,
    uploaded: &[UploadedSuite],
) -> Result<Regrade, Problem> {
    let statement = regrades!("campaign.id = ? AND campaign.assignment = ?");
    let found: Option<Regrade> = transaction.find(statement, values![id, assignment.id]).await?;
    let mut regrade = found.ok_or_else(|| Problem::not_found("regrade"))?;
    let count = |number: i64| usize::try_from(number).unwrap_or(0);
    let statement = "SELECT count(*) AS n, count(CASE WHEN state IN ('waiting', 'running') THEN 1 END) AS waiting
        FROM job WHERE campaign = ?";
    let jobs = transaction.one(statement, values![id]).await?;
    let statement = "SELECT count(*) AS n FROM result WHERE campaign = ? AND code = ?";
    let failed = transaction.one(statement, values![id, JUDGE_ERROR]).await?;
    regrade.submissions = count(jobs.int("n")?);
    regrade.left = count(jobs.int("waiting")?);
    regrade.failed = count(failed.int("n")?);
    regrade.hides_groups = hides_groups(transaction, id).await?;
    if regrade.state == RegradeState::Open {
        let statement = "SELECT count(*) AS n FROM submission WHERE assignment = ? AND removed_at IS NULL
            AND NOT EXISTS (SELECT 1 FROM job WHERE job.submission = submission.id AND +job.campaign = ?)";
        regrade.arrived = count(transaction.one(statement, values![assignment.id, id]).await?.int("n")?);
    }
    let statement = regraded!(
        "job.submission, submission.number, account.login, mark.points, old.max_points AS old_max_points,
            new.max_points AS new_max_points",
        "AND mark.points IS NOT NULL ORDER BY job.submission LIMIT ?"
    );
    regrade.set_by_staff = transaction.all(statement, values![id, MAX_CHANGES]).await?;
    let statement = regraded!(
        changed "count(*) AS n, count(CASE WHEN CAST(new.points AS REAL) > CAST(old.points AS REAL) THEN 1 END) AS more,
            count(CASE WHEN CAST(new.points AS REAL) < CAST(old.points AS REAL) THEN 1 END) AS fewer",
        ""
    );
    let counts = transaction.one(statement, values![id]).await?;
    regrade.changed = count(counts.int("n")?);
    (regrade.more, regrade.fewer) = (count(counts.int("more")?), count(counts.int("fewer")?));
    let statement = regraded!(
        changed "job.submission, submission.number, account.login, account.name, new.code AS new_code,
            new.points AS new_points, new.max_points AS new_max_points, new.summary AS new_summary,
            new.version AS new_version, new.task AS new_task, old.code AS old_code, old.points AS old_points,
            old.max_points AS old_max_points, old.summary AS old_summary, old.version AS old_version,
            old.task AS old_task",
        "AND job.submission > ? ORDER BY job.submission LIMIT ?"
    );
    let rows = transaction.rows(statement, values![id, after, MAX_CHANGES]).await?;
    regrade.changes = rows.iter().map(|row| read_change(row, uploaded)).collect::<Result<_, DbError>>()?;
    let is_full = i64::try_from(regrade.changes.len()).is_ok_and(|changes| changes == MAX_CHANGES);
    regrade.next = regrade.changes.last().filter(|_| is_full).map(|change| change.submission);
    // The page of the class has the same order.
    regrade.changes.sort_by_cached_key(|change| (change.name.to_lowercase(), change.number));
    Ok(regrade)
}

fn read_change(row: &Row, uploaded: &[UploadedSuite]) -> Result<Change, DbError> {
    Ok(read_row!(row => Change {
        submission, number, login, name, old_code, old_points, old_max_points, old_summary, new_code, new_points,
        new_max_points, new_summary;
        why: describe_differences(row, uploaded)?,
    }))
}

/// Returns sentences about the values that differ.
fn list_changed<const N: usize>(values: [(&str, String, String); N]) -> impl Iterator<Item = String> {
    let changed = values.into_iter().filter(|(_, old, new)| old != new);
    changed.map(|(what, old, new)| format!("{what}: from {old} to {new}"))
}

/// Returns the name of rules in settings.
fn describe_rules(rules: &Option<String>) -> String {
    match rules.as_deref() {
        None => "the suite's",
        Some("parity") => "the original's",
        Some("both") => "the original's with the fair ones shown",
        Some(other) => other,
    }
    .to_owned()
}

impl Settings {
    /// Returns what differs in the way of grading. `uploaded` contains the suites of the course.
    pub(crate) fn grading_changes(&self, new: &Self, uploaded: &[UploadedSuite]) -> Vec<String> {
        let suite = |settings: &Self| describe_suite(&settings.suite(), uploaded);
        let hints = |settings: &Self| settings.hints.clone().unwrap_or_else(|| "the suite's".to_owned());
        let changed = list_changed([
            ("suite", suite(self), suite(new)),
            ("rules", describe_rules(&self.rules), describe_rules(&new.rules)),
            ("hints", hints(self), hints(new)),
            ("smallest scenes", self.smallest.to_string(), new.smallest.to_string()),
            ("program", self.program.clone(), new.program.clone()),
            ("seconds", self.seconds.to_string(), new.seconds.to_string()),
        ]);
        changed.collect()
    }
}

/// Returns the differences between two gradings of one submission, as sentences.
fn describe_differences(row: &Row, uploaded: &[UploadedSuite]) -> Result<Vec<String>, DbError> {
    let (Some(old_version), Some(old_task)) = (row.maybe_text("old_version")?, row.maybe_text("old_task")?) else {
        return Ok(vec!["there was no earlier grade".to_owned()]);
    };
    let mut differences: Vec<String> = list_changed([("version", old_version, row.text("new_version")?)]).collect();
    let read = |text: &str| serde_json::from_str::<Task>(text).ok();
    if let (Some(old), Some(new)) = (read(&old_task), read(&row.text("new_task")?)) {
        differences.extend(list_changed([
            ("suite", describe_suite(&old.suite, uploaded), describe_suite(&new.suite, uploaded)),
            ("rules", describe_rules(&old.rules), describe_rules(&new.rules)),
            ("seconds", old.seconds.to_string(), new.seconds.to_string()),
            ("program", old.program, new.program),
        ]));
    }
    if differences.is_empty() {
        let unexplained = "graded in the same way, with another result: the program's output varies, or it was slow";
        differences.push(unexplained.to_owned());
    }
    Ok(differences)
}
