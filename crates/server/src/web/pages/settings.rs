//! The form with an assignment's settings.
use super::{
    super::{
        api::{self, Revision},
        input::{Fields, QueryInput, UrlPathParts},
    },
    Page, PageFrame, render, text,
};
use crate::{
    calendar,
    domain::{Assignment, AssignmentChange, Settings, Staff, UploadedSuite},
    problem::{Problem, ensure},
};
use askama::Template;
use axum::{extract::Request, response::Redirect};
use serde::Deserialize;

/// The beginning of the form value that means an uploaded suite. The suite's digest follows.
const UPLOADED_PREFIX: &str = "(uploaded)";

const MIB: f64 = 1_048_576.0;

#[derive(Template)]
#[template(path = "settings.html")]
struct SettingsPage {
    frame: PageFrame,
    slug: String,
    assignment: Assignment,
    suites: Vec<SuiteOption>,
    megabytes: f64,
}

/// A suite in a list to choose from: the form value, the text, and whether it is selected.
pub(super) type SuiteOption = (String, String, bool);

/// Returns the suites from which staff can choose: the ones that were uploaded to the course, and the grader's.
pub(super) async fn list_suites(staff: &Staff, settings: &Settings) -> Result<Vec<SuiteOption>, Problem> {
    let uploaded = staff.suites().await?;
    let option = |suite: &UploadedSuite| {
        let is_selected = settings.suite_archive.as_ref() == Some(&suite.digest);
        (format!("{UPLOADED_PREFIX}{}", suite.digest), suite.describe(), is_selected)
    };
    let mut suites: Vec<SuiteOption> = uploaded.iter().map(option).collect();
    let is_named = settings.suite_archive.is_none();
    let known = &staff.app.suites;
    let other = Some((settings.suite.as_str(), ""))
        .filter(|(suite, _)| known.names_and_titles().all(|(name, _)| name != *suite));
    for (name, title) in known.names_and_titles().chain(other) {
        let text = match (name, title) {
            ("", _) => "the grader's default".to_owned(),
            (name, "") => name.to_owned(),
            (name, title) if title.contains(name) => title.to_owned(),
            (name, title) => format!("{title} ({name})"),
        };
        suites.push((name.to_owned(), text, is_named && *name == settings.suite));
    }
    Ok(suites)
}

/// The fields of the form that concern grading.
#[derive(Deserialize)]
pub(super) struct Grading {
    suite: String,
    rules: String,
    hints: String,
    smallest: Option<String>,
    program: String,
    seconds: String,
}

fn parse<T: std::str::FromStr>(what: &str, text: &str) -> Result<T, Problem> {
    text.trim().parse().map_err(|_| Problem::invalid(format!("{what} must not be {text:?}")))
}

impl Grading {
    /// Returns the settings `before`, with the values of this form.
    pub(super) fn apply_to(&self, before: &Settings) -> Result<Settings, Problem> {
        let non_empty = |text: &str| Some(text.to_owned()).filter(|text| !text.is_empty());
        let (suite, suite_archive) = match self.suite.strip_prefix(UPLOADED_PREFIX) {
            Some(digest) => (before.suite.clone(), Some(digest.to_owned())),
            None => (self.suite.trim().to_owned(), None),
        };
        Ok(Settings {
            suite,
            suite_archive,
            rules: non_empty(&self.rules),
            hints: non_empty(&self.hints),
            smallest: self.smallest.is_some(),
            program: self.program.trim().to_owned(),
            seconds: parse("seconds", &self.seconds)?,
            ..before.clone()
        })
    }
}

/// The fields of the form that concern submitting.
#[derive(Deserialize)]
pub(super) struct NewSettings {
    title: String,
    /// The assignment's revision when the page was rendered.
    #[serde(default)]
    revision: String,
    visible: Option<String>,
    #[serde(flatten)]
    grading: Grading,
    form_program: Option<String>,
    form_sources: Option<String>,
    form_traces: Option<String>,
    megabytes: String,
    attempts: String,
    per_hour: String,
    due: String,
    #[serde(default)]
    due_zone: String,
    late_days: String,
    late_percent: String,
    #[serde(default)]
    time_zone: String,
}

impl NewSettings {
    fn apply_to(&self, before: &Settings) -> Result<Settings, Problem> {
        let megabytes: f64 = parse("the largest upload", &self.megabytes)?;
        ensure((0.0..=1024.0).contains(&megabytes), Problem::invalid("the largest upload must be at most 1024 MiB"))?;
        let forms = [("program", &self.form_program), ("sources", &self.form_sources), ("traces", &self.form_traces)];
        Ok(Settings {
            forms: forms.iter().filter(|(_, ticked)| ticked.is_some()).map(|(name, _)| (*name).to_owned()).collect(),
            // The limit is a gigabyte, so the conversion is exact.
            max_bytes: (megabytes * MIB).round() as u64,
            attempts: parse("attempts", &self.attempts)?,
            per_hour: parse("submissions in an hour", &self.per_hour)?,
            late_days: parse("late days", &self.late_days)?,
            late_percent: parse("the late penalty", &self.late_percent)?,
            due_at: read_due_date(&self.due, &self.due_zone, before.due_at)?,
            time_zone: match self.time_zone.trim() {
                "" => None,
                name => Some(name.parse().map_err(|_| {
                    Problem::invalid(format!("there is no time zone {name:?}; names are like Europe/Berlin"))
                })?),
            },
            ..self.grading.apply_to(before)?
        })
    }
}

/// Reads the time in a date field. If it is in the same minute as `before`, the exact time of `before` is kept.
pub(super) fn read_due_date(field: &str, zone: &str, before: Option<i64>) -> Result<Option<i64>, Problem> {
    if field.trim().is_empty() {
        return Ok(None);
    }
    let east = if zone.is_empty() { 0 } else { parse("the time zone", zone)? };
    let time = calendar::parse_field(field.trim(), east);
    let time = time.ok_or_else(|| Problem::invalid(format!("{field:?} must be a date and time")))?;
    let unchanged = before.filter(|before| before.div_euclid(60_000) == time.div_euclid(60_000));
    Ok(unchanged.or(Some(time)))
}

pub(super) async fn show_page(staff: Staff, UrlPathParts { course: slug, assignment, .. }: UrlPathParts) -> Page {
    let assignment = staff.assignment(&assignment).await?;
    let address = format!("/c/{slug}/a/{}/settings", assignment.slug);
    let frame = PageFrame::assignment(&staff, &assignment).with_parent(address, "Settings");
    let suites = list_suites(&staff, &assignment.settings).await?;
    let megabytes = assignment.settings.max_bytes as f64 / MIB;
    render(&SettingsPage { frame, slug, assignment, suites, megabytes })
}

pub(super) async fn save(
    staff: Staff,
    UrlPathParts { course: slug, assignment, .. }: UrlPathParts,
    Fields(form): Fields<NewSettings>,
) -> Result<Redirect, Problem> {
    // This form changes only existing assignments, so that a mistyped URL does not create one.
    let assignment = staff.assignment(&assignment).await?;
    let (title, visible) = (Some(form.title.trim()), Some(form.visible.is_some()));
    // The form of an earlier server version sends no revision, and is accepted without a check.
    let revision = Some(form.revision.parse().unwrap_or(-1));
    let change = AssignmentChange { title, visible, revision, suite: None };
    staff.set_assignment(&assignment.slug, change, |before| form.apply_to(before)).await?;
    Ok(Redirect::to(&format!("/c/{slug}/a/{}/settings#done", assignment.slug)))
}

pub(super) async fn set_suite(
    staff: Staff,
    UrlPathParts { course: slug, assignment, .. }: UrlPathParts,
    QueryInput(query): QueryInput<Revision>,
    request: Request,
) -> Result<Redirect, Problem> {
    let assignment = api::receive_suite(&staff, &assignment, &query, request).await?;
    Ok(Redirect::to(&format!("/c/{slug}/a/{}/settings#done", assignment.slug)))
}
