//! The standings of a class: for each student, the submission that counts. A database query puts the attempts of each
//! student into one row. Only submissions that are shown are read completely. Simultaneous requests share one answer.
use crate::domain::{
    Staff,
    view::{self, Assignment, Submission},
};
use crate::{
    db::{DbError, Row, Transaction},
    late_policy::LatePolicy,
    problem::Problem,
    values,
    visible_grade::GradeParts,
};
use serde::Serialize;
use std::{
    collections::{BTreeMap, HashMap, HashSet},
    sync::{Arc, Mutex, PoisonError},
    time::Instant,
};
use utoipa::ToSchema;

/// A student's submissions to an assignment, and the one that counts.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Standing {
    /// The login of the student's account.
    pub login: String,
    /// The student's name.
    pub name: String,
    /// The number of the student's submissions.
    pub submissions: usize,
    /// The submission that counts: the one with the most points, and on a tie the latest of these. If no submission has
    /// points, the last one counts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub counts: Option<Submission>,
}

/// The part of a student's standing that statistics need.
#[derive(Debug, Clone)]
pub struct ShortStanding {
    /// The login of the student's account.
    pub login: String,
    /// The student's name.
    pub name: String,
    /// The number of the student's submissions.
    pub submissions: usize,
    /// The part of the submission that counts.
    pub counts: Option<CountedSubmission>,
}

/// The part of a counted submission that statistics need.
#[derive(Debug, Clone)]
pub struct CountedSubmission {
    /// The submission's ID.
    pub id: i64,
    /// The points that count: those that staff set, or the grader's after the deduction for being late.
    pub points: Option<String>,
    /// The code of the submission's verdict; `None` before it is graded.
    pub code: Option<String>,
    /// The digest of the uploaded file, after it is graded.
    pub digest: String,
    /// Whether the submission is late and loses points.
    pub is_late: bool,
    /// The maximum number of points of the suite.
    pub max_points: Option<String>,
    /// The likely mistakes, or the reason why the program was stopped or not run.
    pub mistakes: Vec<String>,
}

/// The standings that simultaneous requests share, by the assignment's ID.
#[derive(Debug, Default)]
pub(in crate::domain) struct SharedStandings(Mutex<HashMap<i64, Arc<SharedAnswer>>>);

/// The last answer, and the time at which its computation began.
type SharedAnswer = tokio::sync::Mutex<Option<(Instant, Arc<Vec<ShortStanding>>)>>;

/// The number of answers in memory above which those are removed for which no request waits.
const MAX_ANSWERS: usize = 32;

/// The number of submissions that one statement reads completely.
const PAGE_SIZE: usize = 500;

impl SharedStandings {
    fn answer_for(&self, assignment: i64) -> Arc<SharedAnswer> {
        let mut answers = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if answers.len() > MAX_ANSWERS {
            answers.retain(|_, answer| Arc::strong_count(answer) > 1);
        }
        answers.entry(assignment).or_default().clone()
    }
}

impl Staff {
    /// Returns the parts of all students' standings that statistics need, ordered by login.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn short_standings(&self, assignment: &Assignment) -> Result<Arc<Vec<ShortStanding>>, Problem> {
        let requested_at = Instant::now();
        let answer = self.app.0.standings.answer_for(assignment.id);
        let mut last = answer.lock().await;
        // An answer whose computation began after the request is recent enough.
        if let Some((_, standings)) = last.as_ref().filter(|(began, _)| *began >= requested_at) {
            return Ok(standings.clone());
        }
        let started_at = Instant::now();
        let mut transaction = self.app.0.database.read().await?;
        let standings = Arc::new(read(&mut transaction, self.course, assignment).await?);
        *last = Some((started_at, standings.clone()));
        Ok(standings)
    }

    /// Returns the standings of all students in an assignment.
    ///
    /// # Errors
    /// Fails if there is no such assignment.
    pub async fn standings(&self, assignment: &str) -> Result<Vec<Standing>, Problem> {
        let assignment = self.assignment(assignment).await?;
        let short_standings = self.short_standings(&assignment).await?;
        self.whole_standings(&short_standings).await
    }

    /// Returns the standings of these students, with all data of the submissions that count.
    ///
    /// # Errors
    /// Fails if the database does not answer.
    pub async fn whole_standings(&self, short: &[ShortStanding]) -> Result<Vec<Standing>, Problem> {
        let ids: Vec<i64> = short.iter().filter_map(|standing| Some(standing.counts.as_ref()?.id)).collect();
        let mut submissions = HashMap::new();
        let mut transaction = self.app.0.database.read().await?;
        for ids in ids.chunks(PAGE_SIZE) {
            let page = view::submissions_named(&mut transaction, ids).await?;
            submissions.extend(page.into_iter().map(|submission| (submission.id, submission)));
        }
        let mut complete = |standing: &ShortStanding| Standing {
            login: standing.login.clone(),
            name: standing.name.clone(),
            submissions: standing.submissions,
            counts: standing.counts.as_ref().and_then(|counts| submissions.remove(&counts.id)),
        };
        Ok(short.iter().map(&mut complete).collect())
    }
}

/// The best of a student's attempts so far, while the list of attempts is read.
#[derive(Clone)]
struct BestAttempt {
    id: i64,
    points: Option<String>,
    is_late: bool,
}

impl BestAttempt {
    /// Returns the best attempt in a list of entries `ID TIME POINTS`, which are separated by commas and in any order.
    fn from_list(
        list: &str,
        staff_points: &HashMap<i64, String>,
        policy: &LatePolicy,
        extended_to: Option<i64>,
    ) -> Option<Self> {
        let mut attempts: Vec<(i64, i64, &str)> = list
            .split(',')
            .filter_map(|attempt| {
                let mut parts = attempt.split(' ');
                Some((parts.next()?.parse().ok()?, parts.next()?.parse().ok()?, parts.next()?))
            })
            .collect();
        attempts.sort_unstable();
        let value = |points: &Option<String>| points.as_ref().and_then(|points| points.parse::<f64>().ok());
        attempts.into_iter().fold(None, |best: Option<Self>, (id, arrived_at, points)| {
            let late = policy.lateness(extended_to, arrived_at);
            let is_late = late.is_some();
            let reduced = || late.map_or(points.to_owned(), |late| late.points_left(points));
            let graded = (points != "-").then(|| staff_points.get(&id).cloned().unwrap_or_else(reduced));
            let attempt = Self { id, points: graded, is_late };
            match best {
                Some(best)
                    if value(&best.points)
                        .is_some_and(|best_points| value(&attempt.points).is_none_or(|new| new < best_points)) =>
                {
                    Some(best)
                }
                _ => Some(attempt),
            }
        })
    }
}

async fn read(
    transaction: &mut Transaction,
    course: i64,
    assignment: &Assignment,
) -> Result<Vec<ShortStanding>, DbError> {
    let id = assignment.id;
    let statement = "SELECT mark.submission, mark.points FROM submission JOIN mark ON mark.submission = submission.id
        WHERE submission.assignment = ? AND mark.points IS NOT NULL";
    let rows = transaction.rows(statement, values![id]).await?;
    let staff_points = collect_by_id(&rows, |row| Ok((row.int("submission")?, row.text("points")?)))?;
    let statement = "SELECT account, due_at FROM extension WHERE assignment = ?";
    let rows = transaction.rows(statement, values![id]).await?;
    let own_due: HashMap<i64, i64> = collect_by_id(&rows, |row| Ok((row.int("account")?, row.int("due_at")?)))?;
    // Members, and people who left the course but have submitted something.
    let statement = "SELECT account.id, account.login, account.name, coalesce(member.role, 'student') AS role
        FROM account LEFT JOIN member ON member.account = account.id AND member.course = ?
        WHERE member.role IS NOT NULL OR account.id IN (SELECT account FROM submission WHERE assignment = ?)";
    let people = transaction.rows(statement, values![course, id]).await?;
    // Staff may also try an assignment, but are not in the standings.
    let staff = people.iter().filter(|row| row.text("role").is_ok_and(|role| role == "staff"));
    let staff = staff.map(|row| row.int("id")).collect::<Result<HashSet<_>, _>>()?;
    let statement = "SELECT submission.account, count(*) AS n, string_agg(submission.id || ' ' || submission.created_at
               || ' ' || coalesce(result.points, '-'), ',') AS attempts
        FROM submission LEFT JOIN grade ON grade.submission = submission.id
        LEFT JOIN result ON result.id = grade.result
        WHERE submission.assignment = ? GROUP BY submission.account";
    let policy = assignment.settings.late_policy();
    let rows = transaction.rows(statement, values![id]).await?;
    let attempts: HashMap<i64, (usize, Option<BestAttempt>)> = collect_by_id(&rows, |row| {
        let account = row.int("account")?;
        let best =
            BestAttempt::from_list(&row.text("attempts")?, &staff_points, &policy, own_due.get(&account).copied());
        Ok((account, (usize::try_from(row.int("n")?).unwrap_or(0), best)))
    })?;
    let counted_ids: Vec<i64> = attempts.values().filter_map(|(_, best)| Some(best.as_ref()?.id)).collect();
    let statement = "SELECT grade.submission, submission.digest, result.code, result.max_points, result.summary,
            result.parts
        FROM {each} JOIN grade ON grade.submission = CAST(wanted.value AS {int})
        JOIN submission ON submission.id = grade.submission JOIN result ON result.id = grade.result";
    let rows = transaction.rows(statement, values![serde_json::to_string(&counted_ids).unwrap_or_default()]).await?;
    let grades: HashMap<i64, &Row> = collect_by_id(&rows, |row| Ok((row.int("submission")?, row)))?;
    let mut standings = BTreeMap::new();
    for row in people.iter().filter(|row| row.int("id").is_ok_and(|id| !staff.contains(&id))) {
        let (submissions, best) = attempts.get(&row.int("id")?).cloned().unwrap_or_default();
        let counts = best.map(|BestAttempt { id, points, is_late }| {
            let grade = grades.get(&id);
            Ok::<_, DbError>(CountedSubmission {
                id,
                points,
                is_late,
                code: grade.map(|grade| grade.text("code")).transpose()?,
                digest: grade.map(|grade| grade.text("digest")).transpose()?.unwrap_or_default(),
                max_points: grade.map(|grade| grade.maybe_text("max_points")).transpose()?.flatten(),
                mistakes: grade.map(|grade| read_mistakes(grade)).transpose()?.unwrap_or_default(),
            })
        });
        let (login, name, counts) = (row.text("login")?, row.text("name")?, counts.transpose()?);
        standings.insert(login.clone(), ShortStanding { login, name, submissions, counts });
    }
    Ok(standings.into_values().collect())
}

/// Returns the likely mistakes of a result, or the other reason that its summary names.
fn read_mistakes(grade: &Row) -> Result<Vec<String>, DbError> {
    let parts = grade.maybe_text("parts")?.and_then(|parts| serde_json::from_str::<GradeParts>(&parts).ok());
    let summary = grade.text("summary")?;
    let reason = summary.split_once("; ").map(|(_, reason)| reason.to_owned());
    Ok(parts
        .map(|parts| parts.mistakes)
        .filter(|list| !list.is_empty())
        .unwrap_or_else(|| reason.into_iter().collect()))
}

fn collect_by_id<'a, T>(
    rows: &'a [Row],
    read: impl Fn(&'a Row) -> Result<(i64, T), DbError>,
) -> Result<HashMap<i64, T>, DbError> {
    rows.iter().map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_attempt_counts_and_the_later_of_equals() {
        let by_hand = HashMap::from([(4, "9".to_owned())]);
        let policy = LatePolicy { due_at: Some(100), late_days: 1, late_percent: 50, ..LatePolicy::default() };
        let best =
            |list: &str| BestAttempt::from_list(list, &by_hand, &policy, None).map(|best| (best.id, best.points));
        let points = |text: &str| Some(text.to_owned());
        assert_eq!(best("2 50 7.5,1 50 7.5"), Some((2, points("7.5"))), "in whatever order they come");
        assert_eq!(best("1 50 8,2 50 7,3 50 -"), Some((1, points("8"))), "one that waits counts for nothing yet");
        assert_eq!(best("1 50 -,2 50 -"), Some((2, None)));
        assert_eq!(best("1 50 6,2 101 10"), Some((1, points("6"))), "half of ten is less");
        assert_eq!(best("1 50 6,4 101 10"), Some((4, points("9"))), "points by hand cost nothing");
    }
}
