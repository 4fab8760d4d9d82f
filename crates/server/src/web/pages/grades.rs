//! The class, and regrades.
use super::{
    super::input::{Fields, Params},
    Frame, see,
    settings::{Grading, GradingFields},
    show, text,
};
use crate::{
    access::{Assignment, Regrade, RegradeState, ScoreInfo, Staff, Standing, Suspicion},
    problem::Problem,
};
use askama::Template;
use axum::response::{Html, Redirect};
use serde::Deserialize;

#[derive(Template)]
#[template(path = "class.html")]
struct ClassPage {
    frame: Frame,
    slug: String,
    assignment: Assignment,
    standings: Vec<Standing>,
    regrades: Vec<Regrade>,
    suspicions: Vec<Suspicion>,
    scores: Vec<ScoreInfo>,
    grading: GradingFields,
}

#[derive(Template)]
#[template(path = "regrade.html")]
struct RegradePage {
    frame: Frame,
    slug: String,
    assignment: Assignment,
    regrade: Regrade,
}

#[derive(Deserialize)]
pub(super) struct NewRegrade {
    reason: String,
    #[serde(flatten)]
    grading: Grading,
}

pub(super) async fn class(
    staff: Staff,
    Params((slug, assignment)): Params<(String, String)>,
) -> Result<Html<String>, Problem> {
    let assignment = staff.member().assignment(&assignment).await?;
    let frame = Frame::course(staff.member())
        .then(format!("/c/{slug}/a/{}", assignment.slug), &assignment.title)
        .then(format!("/c/{slug}/a/{}/class", assignment.slug), "Class");
    let standings = staff.standings(&assignment.slug).await?;
    let regrades = staff.regrades(&assignment.slug).await?;
    let grading = GradingFields::of(&assignment.settings, staff.member().house().suites().names());
    let suspicions = staff.suspicions(&assignment.slug).await?;
    let scores = staff.scores(&assignment.slug).await?;
    show(&ClassPage { frame, slug, assignment, standings, regrades, suspicions, scores, grading })
}

pub(super) async fn begin(
    staff: Staff,
    Params((slug, assignment)): Params<(String, String)>,
    Fields(form): Fields<NewRegrade>,
) -> Result<Redirect, Problem> {
    let settings = form.grading.over(&staff.member().assignment(&assignment).await?.settings)?;
    let regrade = staff.regrade(&assignment, form.reason.trim(), Some(&settings)).await?;
    Ok(see(&format!("/c/{slug}/a/{assignment}/regrades/{}", regrade.id)))
}

pub(super) async fn publish(
    staff: Staff,
    Params((slug, assignment)): Params<(String, String)>,
) -> Result<Redirect, Problem> {
    staff.publish(&assignment, true).await?;
    Ok(see(&format!("/c/{slug}/a/{assignment}/class")))
}

pub(super) async fn withhold(
    staff: Staff,
    Params((slug, assignment)): Params<(String, String)>,
) -> Result<Redirect, Problem> {
    staff.publish(&assignment, false).await?;
    Ok(see(&format!("/c/{slug}/a/{assignment}/class")))
}

async fn show_page(staff: &Staff, slug: String, assignment: &str, id: i64) -> Result<Html<String>, Problem> {
    let assignment = staff.member().assignment(assignment).await?;
    let regrade = staff.show_regrade(&assignment.slug, id).await?;
    let frame = Frame::course(staff.member())
        .then(format!("/c/{slug}/a/{}", assignment.slug), &assignment.title)
        .then(format!("/c/{slug}/a/{}/class", assignment.slug), "Class")
        .then(format!("/c/{slug}/a/{}/regrades/{id}", assignment.slug), "Regrade");
    show(&RegradePage { frame, slug, assignment, regrade })
}

pub(super) async fn show_regrade(
    staff: Staff,
    Params((slug, assignment, id)): Params<(String, String, i64)>,
) -> Result<Html<String>, Problem> {
    show_page(&staff, slug, &assignment, id).await
}

pub(super) async fn apply(
    staff: Staff,
    Params((slug, assignment, id)): Params<(String, String, i64)>,
) -> Result<Redirect, Problem> {
    staff.apply_regrade(&assignment, id).await?;
    Ok(see(&format!("/c/{slug}/a/{assignment}/regrades/{id}")))
}

pub(super) async fn discard(
    staff: Staff,
    Params((slug, assignment, id)): Params<(String, String, i64)>,
) -> Result<Redirect, Problem> {
    staff.discard_regrade(&assignment, id).await?;
    Ok(see(&format!("/c/{slug}/a/{assignment}/regrades/{id}")))
}

pub(super) async fn dismiss(
    staff: Staff,
    Params((slug, assignment, id)): Params<(String, String, i64)>,
) -> Result<Redirect, Problem> {
    staff.decide_suspicion(&assignment, id, false).await?;
    Ok(see(&format!("/c/{slug}/a/{assignment}/class")))
}

pub(super) async fn tell(
    staff: Staff,
    Params((slug, assignment, id)): Params<(String, String, i64)>,
) -> Result<Redirect, Problem> {
    staff.decide_suspicion(&assignment, id, true).await?;
    Ok(see(&format!("/c/{slug}/a/{assignment}/class")))
}
