//! The class, and regrades.
use super::{
    super::input::{Asked, At, Fields},
    Frame,
    heat::Heat,
    see,
    settings::{Grading, GradingFields},
    show,
    statistics::Statistics,
    text,
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
    look: Look,
    /// How many students were found.
    found: usize,
    before: Option<String>,
    after: Option<String>,
    regrades: Vec<Regrade>,
    suspicions: Vec<Suspicion>,
    scores: Vec<ScoreInfo>,
    requests: Vec<crate::access::Request>,
    statistics: Option<Statistics>,
    heat: Heat,
    grading: GradingFields,
    /// Whether students see less than staff until it is published.
    hides: bool,
}

#[derive(Template)]
#[template(path = "regrade.html")]
struct RegradePage {
    frame: Frame,
    slug: String,
    assignment: Assignment,
    regrade: Regrade,
}

/// Students on one page.
const PAGE: usize = 100;

/// Whom to show, in what order, and which page of them.
#[derive(Deserialize)]
pub(super) struct Look {
    #[serde(default)]
    q: String,
    #[serde(default)]
    sort: String,
    page: Option<usize>,
}

impl Look {
    /// Those who are to be shown, how many there are on all pages, and the addresses of the pages before and after.
    fn at(&self, mut standings: Vec<Standing>) -> (Vec<Standing>, usize, [Option<String>; 2]) {
        let words = self.q.trim().to_lowercase();
        standings.retain(|one| one.login.contains(&words) || one.name.to_lowercase().contains(&words));
        let points = |one: &Standing| {
            let grade = one.counts.as_ref().and_then(|counts| counts.grade.as_ref());
            grade.and_then(|grade| grade.points.as_ref()?.parse::<f64>().ok()).unwrap_or(-1.0)
        };
        match self.sort.as_str() {
            "name" => standings.sort_by_cached_key(|one| one.name.to_lowercase()),
            "points" => standings.sort_by(|one, other| points(other).total_cmp(&points(one))),
            "submissions" => standings.sort_by_key(|one| std::cmp::Reverse(one.submissions)),
            // They come by their logins.
            _ => {}
        }
        let found = standings.len();
        let pages = found.div_ceil(PAGE).max(1);
        let page = self.page.unwrap_or(1).clamp(1, pages);
        let address = |page: usize| {
            let mut query = url::form_urlencoded::Serializer::for_suffix("?".to_owned(), 1);
            query.append_pair("q", &self.q).append_pair("sort", &self.sort).append_pair("page", &page.to_string());
            query.finish()
        };
        let shown = standings.into_iter().skip((page - 1) * PAGE).take(PAGE).collect();
        (shown, found, [(page > 1).then(|| address(page - 1)), (page < pages).then(|| address(page + 1))])
    }
}

#[derive(Deserialize)]
pub(super) struct After {
    after: Option<i64>,
}

#[derive(Deserialize)]
pub(super) struct NewRegrade {
    reason: String,
    #[serde(flatten)]
    grading: Grading,
}

pub(super) async fn class(
    staff: Staff,
    At { course: slug, assignment, .. }: At,
    Asked(look): Asked<Look>,
) -> Result<Html<String>, Problem> {
    let assignment = staff.assignment(&assignment).await?;
    let frame = Frame::assignment(&staff, &assignment.slug, &assignment.title)
        .then(format!("/c/{slug}/a/{}/class", assignment.slug), "Class");
    let standings = staff.standings(&assignment.slug).await?;
    let regrades = staff.regrades(&assignment.slug).await?;
    let grading = GradingFields::of(&assignment.settings, staff.app.suites.names());
    let suspicions = staff.suspicions(&assignment.slug).await?;
    let scores = staff.scores(&assignment.slug).await?;
    let (requests, statistics) = (staff.requests(&assignment.slug).await?, Statistics::of(&standings));
    let (standings, found, [before, after]) = look.at(standings);
    let results: Vec<i64> =
        standings.iter().filter_map(|one| Some(one.counts.as_ref()?.grade.as_ref()?.result)).collect();
    let heat = Heat::of(&standings, &staff.failed_scenes(&results).await?);
    let hides = staff.hides(&assignment).await?;
    show(&ClassPage {
        frame,
        slug,
        assignment,
        standings,
        look,
        found,
        before,
        after,
        regrades,
        suspicions,
        scores,
        requests,
        statistics,
        heat,
        grading,
        hides,
    })
}

pub(super) async fn begin(
    staff: Staff,
    At { course: slug, assignment, .. }: At,
    Fields(form): Fields<NewRegrade>,
) -> Result<Redirect, Problem> {
    let settings = form.grading.over(&staff.assignment(&assignment).await?.settings)?;
    let regrade = staff.regrade(&assignment, form.reason.trim(), Some(&settings)).await?;
    Ok(see(&format!("/c/{slug}/a/{assignment}/regrades/{}", regrade.id)))
}

async fn show_page(
    staff: &Staff,
    slug: String,
    assignment: &str,
    id: i64,
    after: Option<i64>,
) -> Result<Html<String>, Problem> {
    let assignment = staff.assignment(assignment).await?;
    let regrade = staff.show_regrade(&assignment.slug, id, after).await?;
    let frame = Frame::assignment(staff, &assignment.slug, &assignment.title)
        .then(format!("/c/{slug}/a/{}/class", assignment.slug), "Class")
        .then(format!("/c/{slug}/a/{}/regrades/{id}", assignment.slug), "Regrade");
    show(&RegradePage { frame, slug, assignment, regrade })
}

pub(super) async fn show_regrade(
    staff: Staff,
    At { course: slug, assignment, id, .. }: At,
    Asked(asked): Asked<After>,
) -> Result<Html<String>, Problem> {
    show_page(&staff, slug, &assignment, id, asked.after).await
}

deeds! {
    publish(staff: Staff, { course, assignment }):
        staff.publish(&assignment, true) => "/c/{course}/a/{assignment}/class";
    withhold(staff: Staff, { course, assignment }):
        staff.publish(&assignment, false) => "/c/{course}/a/{assignment}/class";
    apply(staff: Staff, { course, assignment, id }):
        staff.apply_regrade(&assignment, id) => "/c/{course}/a/{assignment}/regrades/{id}";
    discard(staff: Staff, { course, assignment, id }):
        staff.discard_regrade(&assignment, id) => "/c/{course}/a/{assignment}/regrades/{id}";
    grade_errors_again(staff: Staff, { course, assignment }):
        staff.grade_errors_again(Some(&assignment)) => "/c/{course}/a/{assignment}/class";
    dismiss(staff: Staff, { course, assignment, id }):
        staff.decide_suspicion(&assignment, id, false) => "/c/{course}/a/{assignment}/class";
    tell(staff: Staff, { course, assignment, id }):
        staff.decide_suspicion(&assignment, id, true) => "/c/{course}/a/{assignment}/class";
}
