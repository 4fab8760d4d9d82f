//! The pages about a class's grades, and about regrades.
use super::{
    super::input::{Fields, ListStart, QueryInput, UrlPathParts},
    Page, PageFrame, render, scenes,
    settings::{Grading, SuiteOption, list_suites},
    statistics::{self, Statistics},
    text,
};
use crate::{
    domain::{Assignment, Regrade, RegradeState, ScoreInfo, ShortStanding, Staff, Standing, StoredResult},
    problem::Problem,
};
use askama::Template;
use axum::response::Redirect;
use serde::Deserialize;
use std::collections::BTreeMap;

/// The rows of small colored scenes. Reports of `grade` contain the same code.
#[path = "../../../../report/src/page/heat.rs"]
mod heat;

#[derive(Template)]
#[template(path = "class.html")]
struct GradesPage {
    frame: PageFrame,
    slug: String,
    assignment: Assignment,
    standings: Vec<Standing>,
    filter: GradesQuery,
    /// The number of students who match the filter.
    match_count: usize,
    previous_page: Option<String>,
    next_page: Option<String>,
    regrades: Vec<Regrade>,
    scores: Vec<ScoreInfo>,
    requests: Vec<crate::domain::Request>,
    statistics: Statistics,
    /// The details that are stored with the results that count, by the IDs of the results.
    stored_results: BTreeMap<i64, StoredResult>,
    /// The wrong scenes of the students on the page. Each is listed with the logins of the students for whom it is
    /// wrong.
    scenes: Vec<(String, Vec<String>)>,
    suites: Vec<SuiteOption>,
    /// Whether the assignment has hidden groups, so that students see less than staff until these are published.
    hides_groups: bool,
}

impl GradesPage {
    /// Returns whether a regrade waits to be applied or discarded.
    fn is_regrading(&self) -> bool {
        self.regrades.iter().any(|regrade| regrade.state == RegradeState::Open)
    }
}

#[derive(Template)]
#[template(path = "regrade.html")]
struct RegradePage {
    frame: PageFrame,
    slug: String,
    assignment: Assignment,
    regrade: Regrade,
    /// The settings that the regrade changes.
    changes: Vec<String>,
}

/// The maximum number of students on a page.
const PAGE_SIZE: usize = 100;

/// The filter and the order of the students, and the number of the page.
#[derive(Deserialize)]
pub(super) struct GradesQuery {
    #[serde(default)]
    q: String,
    #[serde(default)]
    sort: String,
    /// The category of students that the page shows, such as `missing`; empty for all students.
    #[serde(default, rename = "part")]
    section: String,
    /// A likely mistake. The page shows only students who made it.
    #[serde(default)]
    mistake: String,
    page: Option<usize>,
}

impl GradesQuery {
    /// Returns the students on this page, the number of students on all pages, and the URLs of the previous and
    /// the next page.
    fn select_page(&self, standings: &[ShortStanding]) -> (Vec<ShortStanding>, usize, [Option<String>; 2]) {
        let search = self.q.trim().to_lowercase();
        let made_mistake =
            |row: &ShortStanding| row.counts.as_ref().is_some_and(|counts| counts.mistakes.contains(&self.mistake));
        let is_selected = |standing: &&ShortStanding| {
            (standing.login.contains(&search) || standing.name.to_lowercase().contains(&search))
                && statistics::is_in_section(standing, &self.section)
                && (self.mistake.is_empty() || made_mistake(standing))
        };
        let mut standings: Vec<&ShortStanding> = standings.iter().filter(is_selected).collect();
        let points = |standing: &ShortStanding| {
            let points = standing.counts.as_ref().and_then(|counts| counts.points.as_ref());
            points.and_then(|points| points.parse::<f64>().ok()).unwrap_or(-1.0)
        };
        match self.sort.as_str() {
            "points" => standings.sort_by(|standing, other| points(other).total_cmp(&points(standing))),
            "submissions" => standings.sort_by_key(|standing| std::cmp::Reverse(standing.submissions)),
            _ => standings.sort_by_cached_key(|standing| standing.name.to_lowercase()),
        }
        let match_count = standings.len();
        let pages = match_count.div_ceil(PAGE_SIZE).max(1);
        let page = self.page.unwrap_or(1).clamp(1, pages);
        let address = |page: usize| {
            let mut query = url::form_urlencoded::Serializer::for_suffix("?".to_owned(), 1);
            query.append_pair("q", &self.q).append_pair("sort", &self.sort).append_pair("part", &self.section);
            query.append_pair("mistake", &self.mistake).append_pair("page", &page.to_string());
            query.finish()
        };
        let standings = standings.into_iter().skip((page - 1) * PAGE_SIZE).take(PAGE_SIZE).cloned().collect();
        (standings, match_count, [(page > 1).then(|| address(page - 1)), (page < pages).then(|| address(page + 1))])
    }
}

#[derive(Deserialize)]
pub(super) struct NewRegrade {
    reason: String,
    #[serde(flatten)]
    grading: Grading,
}

/// Returns the frame for pages about the class's grades.
pub(super) fn class_frame(staff: &Staff, assignment: &Assignment) -> PageFrame {
    let frame = PageFrame::assignment(staff, assignment);
    frame.with_parent(format!("/c/{}/a/{}/class", staff.slug, assignment.slug), "Class")
}

pub(super) async fn show_class(
    staff: Staff,
    UrlPathParts { course: slug, assignment, .. }: UrlPathParts,
    QueryInput(query): QueryInput<GradesQuery>,
) -> Page {
    let assignment = staff.assignment(&assignment).await?;
    let standings = staff.short_standings(&assignment).await?;
    let statistics = Statistics::from_standings(&standings);
    let (standings, found, [before, after]) = query.select_page(&standings);
    let standings = staff.whole_standings(&standings).await?;
    let results: Vec<i64> =
        standings.iter().filter_map(|standing| Some(standing.counts.as_ref()?.grade.as_ref()?.result)).collect();
    let stored_results = staff.stored_results(&results).await?;
    render(&GradesPage {
        frame: class_frame(&staff, &assignment),
        slug,
        filter: query,
        match_count: found,
        previous_page: before,
        next_page: after,
        regrades: staff.regrades(&assignment.slug).await?,
        scores: staff.scores(&assignment.slug).await?,
        requests: staff.requests(&assignment.slug).await?,
        statistics,
        scenes: scenes::wrong_scenes(&standings, &stored_results),
        stored_results,
        standings,
        suites: list_suites(&staff, &assignment.settings).await?,
        hides_groups: staff.is_hidden(&assignment).await?,
        assignment,
    })
}

pub(super) async fn begin_regrade(
    staff: Staff,
    UrlPathParts { course: slug, assignment, .. }: UrlPathParts,
    Fields(form): Fields<NewRegrade>,
) -> Result<Redirect, Problem> {
    let settings = form.grading.apply_to(&staff.assignment(&assignment).await?.settings)?;
    let regrade = staff.regrade(&assignment, form.reason.trim(), &settings).await?;
    Ok(Redirect::to(&format!("/c/{slug}/a/{assignment}/regrades/{}", regrade.id)))
}

pub(super) async fn show_regrade(
    staff: Staff,
    UrlPathParts { course: slug, assignment, id, .. }: UrlPathParts,
    QueryInput(query): QueryInput<ListStart>,
) -> Page {
    let assignment = staff.assignment(&assignment).await?;
    let regrade = staff.show_regrade(&assignment.slug, id, query.after).await?;
    let address = format!("/c/{slug}/a/{}/regrades/{id}", assignment.slug);
    render(&RegradePage {
        frame: class_frame(&staff, &assignment).with_parent(address, "Regrade"),
        slug,
        changes: assignment.settings.grading_changes(&regrade.settings, &staff.suites().await?),
        assignment,
        regrade,
    })
}

actions! {
    publish(staff: Staff, { course, assignment }):
        staff.publish(&assignment, true) => "/c/{course}/a/{assignment}/class";
    withhold(staff: Staff, { course, assignment }):
        staff.publish(&assignment, false) => "/c/{course}/a/{assignment}/class";
    regrade_newcomers(staff: Staff, { course, assignment, id }):
        staff.regrade_newcomers(&assignment, id) => "/c/{course}/a/{assignment}/regrades/{id}";
    apply(staff: Staff, { course, assignment, id }):
        staff.apply_regrade(&assignment, id) => "/c/{course}/a/{assignment}/regrades/{id}";
    discard(staff: Staff, { course, assignment, id }):
        staff.discard_regrade(&assignment, id) => "/c/{course}/a/{assignment}/regrades/{id}";
    grade_errors_again(staff: Staff, { course, assignment }):
        staff.grade_errors_again(Some(&assignment)) => "/c/{course}/a/{assignment}/class";
}
