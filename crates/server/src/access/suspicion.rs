//! Where the reference may be wrong: what staff is told, and decides.
use super::{Member, Staff};
use crate::{
    db::{DbError, Row, read_row},
    problem::Problem,
    shown::Shown,
    values,
};
use serde::Serialize;
use utoipa::ToSchema;

/// Many students who are right otherwise answer the same in a scene, and not what the reference does.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Suspicion {
    /// Its number.
    pub id: i64,
    /// The scene.
    pub scene: String,
    /// How many agree.
    pub agreeing: i64,
    /// How many students are right otherwise, these included.
    pub nearly_right: i64,
    /// `open`, `dismissed` (the reference is right) or `told` (students know).
    pub state: String,
    /// When it was found, in milliseconds since 1970.
    pub found_at: i64,
    /// Students who handed in what answers so.
    pub logins: Vec<String>,
}

impl Staff {
    /// Where the reference of an assignment is suspected, latest first.
    ///
    /// # Errors
    /// When there is no such assignment.
    pub async fn suspicions(&self, slug: &str) -> Result<Vec<Suspicion>, Problem> {
        let (mut transaction, assignment) = self.read_at(slug).await?;
        let statement = "SELECT id, scene, answer, agreeing, nearly_right, state, found_at FROM suspicion
            WHERE assignment = ? ORDER BY id DESC";
        let rows = transaction.rows(statement, values![assignment.id]).await?;
        let mut suspicions = Vec::new();
        for row in &rows {
            let (scene, answer) = (row.text("scene")?, row.text("answer")?);
            let statement = "SELECT DISTINCT account.login FROM wrong_scene
                JOIN grade ON grade.result = wrong_scene.result
                JOIN submission ON submission.id = grade.submission AND submission.assignment = ?
                JOIN account ON account.id = submission.account
                JOIN member ON member.account = account.id AND member.course = ? AND member.role = 'student'
                WHERE wrong_scene.scene = ? AND wrong_scene.answer = ? ORDER BY account.login";
            let logins = transaction.rows(statement, values![assignment.id, self.course, &scene, &answer]).await?;
            let read = |row: &Row| row.text("login");
            let logins = logins.iter().map(read).collect::<Result<_, DbError>>()?;
            suspicions.push(read_row!(row => Suspicion { id, agreeing, nearly_right, state, found_at; scene, logins }));
        }
        Ok(suspicions)
    }

    /// Decides on a suspicion: the reference is right (`dismissed`), or students whose submissions answer so are told
    /// that it may not be (`told`). Either may be taken back by the other.
    ///
    /// # Errors
    /// When there is none of this number.
    pub async fn decide_suspicion(&self, slug: &str, id: i64, told: bool) -> Result<(), Problem> {
        let assignment = self.assignment(slug).await?;
        let mut transaction = self.begin().await?;
        let state = if told { "told" } else { "dismissed" };
        let statement = "UPDATE suspicion SET state = ?, decided_by = ?, decided_at = {now}
            WHERE id = ? AND assignment = ? RETURNING scene";
        let row = transaction.row(statement, values![state, self.account.id, id, assignment.id]).await?;
        let Some(row) = row else { return Err(Problem::not_found("suspicion")) };
        let scene = row.text("scene")?;
        let text = match told {
            true => format!("students are told that the reference may be wrong in {scene}"),
            false => format!("the reference is right in {scene}"),
        };
        self.note(&mut transaction, "suspicion", Some(assignment.id), &text).await?;
        Ok(transaction.commit().await?)
    }
}

impl Member {
    /// Scenes in which the reference may be wrong, of a submission that answers what many answer: those of which staff
    /// says that students are to know.
    ///
    /// # Errors
    /// When they may see none of this number.
    pub async fn doubts(&self, id: i64) -> Result<Vec<String>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let submission = self.find_submission(&mut transaction, id).await?;
        let kept = submission.grade.filter(|_| submission.is_withheld).and_then(|grade| grade.outcome.shown);
        let shown = kept.as_deref().and_then(Shown::read);
        let statement = "SELECT DISTINCT wrong_scene.scene FROM grade
            JOIN submission ON submission.id = grade.submission
            JOIN wrong_scene ON wrong_scene.result = grade.result
            JOIN suspicion ON suspicion.assignment = submission.assignment AND suspicion.scene = wrong_scene.scene
               AND suspicion.answer = wrong_scene.answer AND suspicion.state = 'told'
            WHERE grade.submission = ? ORDER BY wrong_scene.scene";
        let rows = transaction.rows(statement, values![id]).await?;
        let mut scenes = rows.iter().map(|row| row.text("scene")).collect::<Result<Vec<_>, DbError>>()?;
        scenes.retain(|scene| shown.as_ref().is_none_or(|shown| shown.tells_of(scene)));
        Ok(scenes)
    }
}
