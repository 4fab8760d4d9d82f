//! When the reference may be the one that is wrong: many students who are right otherwise answer the same in a scene,
//! and not what the reference does. Then staff is told; students hear of it when staff says so.
use crate::{
    db::{DbError, Transaction},
    values,
};

/// This many have to agree in any case: of a handful of submissions a third says nothing.
const FEWEST: i64 = 3;

/// More than one of this many of those who are otherwise right have to agree.
const SHARE: i64 = 3;

/// Looks at what the students of a course answer in an assignment, after one of them has a new result, and notes what
/// was not suspected before. Each student counts once, with the latest submission that has a grade.
///
/// # Errors
/// An error of the database.
pub async fn look(transaction: &mut Transaction, course: i64, assignment: i64, result: i64) -> Result<(), DbError> {
    // The whole assignment is gone through only where enough results, whosever they are, have an answer of this one.
    let statement = "SELECT own.scene FROM wrong_scene AS own
        JOIN wrong_scene AS other ON other.scene = own.scene AND other.answer = own.answer
        WHERE own.result = ? GROUP BY own.scene HAVING count(*) >= ? LIMIT 1";
    let shared = transaction.row(statement, values![result, FEWEST]).await?;
    if shared.is_none() {
        return Ok(());
    }
    let statement = "WITH latest AS (
           SELECT max(submission.id) AS submission FROM submission
           JOIN grade ON grade.submission = submission.id
           JOIN member ON member.account = submission.account AND member.course = ? AND member.role = 'student'
           WHERE submission.assignment = ? GROUP BY submission.account
        ), nearly AS (
           SELECT grade.result AS result FROM latest
           JOIN grade ON grade.submission = latest.submission
           JOIN result ON result.id = grade.result
           WHERE result.nearly_right = 1
        )
        SELECT wrong_scene.scene, wrong_scene.answer, count(*) AS agreeing,
           (SELECT count(*) FROM nearly) AS nearly_right
        FROM nearly JOIN wrong_scene ON wrong_scene.result = nearly.result
        GROUP BY wrong_scene.scene, wrong_scene.answer
        HAVING count(*) >= ? AND count(*) * ? > (SELECT count(*) FROM nearly)
        ORDER BY wrong_scene.scene, wrong_scene.answer";
    let found = transaction.rows(statement, values![course, assignment, FEWEST, SHARE]).await?;
    for row in found {
        let (scene, answer) = (row.text("scene")?, row.text("answer")?);
        let (agreeing, nearly_right) = (row.int("agreeing")?, row.int("nearly_right")?);
        let statement = "INSERT INTO suspicion (assignment, scene, answer, agreeing, nearly_right, state, found_at)
            VALUES (?, ?, ?, ?, ?, 'open', {now}) ON CONFLICT (assignment, scene, answer) DO NOTHING RETURNING id";
        let new = transaction.row(statement, values![assignment, &scene, &answer, agreeing, nearly_right]).await?;
        if new.is_none() {
            let statement = "UPDATE suspicion SET agreeing = ?, nearly_right = ?
                WHERE assignment = ? AND scene = ? AND answer = ?";
            transaction.execute(statement, values![agreeing, nearly_right, assignment, &scene, &answer]).await?;
            continue;
        }
        let text = format!(
            "is the reference wrong in {scene}? {agreeing} of {nearly_right} students who are right otherwise answer the \
             same there, and not what it does"
        );
        // Of no submission: students follow what happens to theirs.
        let statement = "INSERT INTO event (happened_at, kind, course, assignment, text)
            VALUES ({now}, 'reference suspected', ?, ?, ?)";
        transaction.execute(statement, values![course, assignment, text]).await?;
    }
    Ok(())
}
