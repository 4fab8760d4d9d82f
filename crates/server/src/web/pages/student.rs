//! One student's work, as staff sees it; and the table by which a class comes in.
use super::{
    super::{
        api::{RequestWish, cell},
        input::{At, Fields},
    },
    Frame, heat, see,
    settings::moment,
    show, text,
};
use crate::{
    access::{App, Assignment, AttemptChange, Imported, Member, Staff, Submission, Work},
    problem::Problem,
};
use askama::Template;
use axum::response::{Html, Redirect};
use serde::Deserialize;
use std::collections::BTreeMap;
use url::form_urlencoded::byte_serialize;

#[derive(Template)]
#[template(path = "student.html")]
struct StudentPage {
    frame: Frame,
    slug: String,
    assignment: Assignment,
    work: Work,
    /// The changes that attempts have made, by the numbers of their submissions.
    changes: BTreeMap<i64, String>,
}

impl StudentPage {
    fn change(&self, id: &i64) -> &str {
        self.changes.get(id).map_or("", String::as_str)
    }
}

#[derive(Template)]
#[template(path = "import.html")]
struct ImportPage {
    frame: Frame,
    slug: String,
    table: String,
    lines: Vec<Line>,
    is_wrong: bool,
    is_done: bool,
    /// All links as a table, as an address.
    download: String,
}

/// A line of the table, and the link to be handed on.
struct Line {
    of: Imported,
    link: String,
    /// A letter with the link, as an address.
    letter: String,
}

#[derive(Deserialize)]
pub(super) struct NewExtension {
    due: String,
    #[serde(default)]
    due_zone: String,
}

#[derive(Deserialize)]
pub(super) struct NewMark {
    #[serde(default)]
    points: String,
    #[serde(default)]
    comment: String,
}

#[derive(Deserialize)]
pub(super) struct Table {
    table: String,
    import: Option<String>,
}

pub(super) async fn page(
    staff: Staff,
    At { course: slug, assignment, login, .. }: At,
) -> Result<Html<String>, Problem> {
    let assignment = staff.assignment(&assignment).await?;
    let work = staff.work(&assignment.slug, &login).await?;
    let frame = Frame::assignment(&staff, &assignment.slug, &assignment.title)
        .then(format!("/c/{slug}/a/{}/class", assignment.slug), "Class")
        .then(format!("/c/{slug}/a/{}/students/{login}", assignment.slug), &work.name);
    let graded: Vec<(&Submission, i64)> =
        work.submissions.iter().filter_map(|one| Some((one, one.grade.as_ref()?.result))).collect();
    let failed = staff.failed_scenes(&graded.iter().map(|(_, result)| *result).collect::<Vec<_>>()).await?;
    // They come latest first.
    let change = |pair: &[(&Submission, i64)]| {
        let [(later, new), (earlier, old)] = *pair else { return None };
        let change = AttemptChange::between(earlier.number, failed.get(&old)?, failed.get(&new)?);
        Some((later.id, heat::change(&change)))
    };
    let changes = graded.windows(2).filter_map(change).collect();
    show(&StudentPage { frame, slug, assignment, work, changes })
}

pub(super) async fn extend(
    staff: Staff,
    At { course: slug, assignment, login, .. }: At,
    Fields(form): Fields<NewExtension>,
) -> Result<Redirect, Problem> {
    let before = staff.work(&assignment, &login).await?.extended_to;
    staff.extend(&assignment, &login, moment(&form.due, &form.due_zone, before)?).await?;
    Ok(see(&format!("/c/{slug}/a/{assignment}/students/{login}")))
}

pub(super) async fn mark(
    staff: Staff,
    At { course: slug, id, .. }: At,
    Fields(form): Fields<NewMark>,
) -> Result<Redirect, Problem> {
    let points = point(form.points.trim());
    staff.mark(id, Some(points.as_str()).filter(|points| !points.is_empty()), form.comment.trim()).await?;
    Ok(see(&format!("/c/{slug}/s/{id}")))
}

/// A number with a decimal comma, `7,5`, with a point. Three digits behind a comma may be thousands.
fn point(number: &str) -> String {
    match number.split_once(',') {
        Some((whole, part)) if (1..=2).contains(&part.len()) => format!("{whole}.{part}"),
        _ => number.to_owned(),
    }
}

pub(super) async fn request(
    member: Member,
    At { course: slug, id, .. }: At,
    Fields(form): Fields<RequestWish>,
) -> Result<Redirect, Problem> {
    member.request(id, form.text.trim()).await?;
    Ok(see(&format!("/c/{slug}/s/{id}")))
}

fn import_page(staff: &Staff, table: String, lines: Vec<Line>, is_done: bool) -> Result<Html<String>, Problem> {
    let slug = staff.course().slug;
    let frame = Frame::course(staff)
        .then(format!("/c/{slug}/members"), "Members")
        .then(format!("/c/{slug}/members/import"), "Import");
    let is_wrong = lines.iter().any(|line| line.of.error.is_some());
    let mut writer = csv::Writer::from_writer(Vec::new());
    for line in &lines {
        let cells = [&line.of.name, &line.of.login, &line.of.email, &line.of.role, &line.link].map(|text| cell(text));
        writer.write_record(cells).map_err(|_| Problem::fault())?;
    }
    let bytes = writer.into_inner().map_err(|_| Problem::fault())?;
    let download = format!("data:text/csv;charset=utf-8,{}", percent(&bytes));
    show(&ImportPage { frame, slug, table, lines, is_wrong, is_done: is_done && !is_wrong, download })
}

/// Bytes as part of an address.
fn percent(bytes: &[u8]) -> String {
    byte_serialize(bytes).collect::<String>().replace('+', "%20")
}

fn line(app: &App, course: &str, of: Imported) -> Line {
    let link = match (&of.link, &of.invitation) {
        (Some(secret), _) => app.welcome_address(secret),
        (None, Some(secret)) => app.invitation_address(secret),
        (None, None) => String::new(),
    };
    let (subject, body) = (percent(course.as_bytes()), percent(format!("{}:\n{link}\n", of.name).as_bytes()));
    let letter = format!("mailto:{}?subject={subject}&body={body}", percent(of.email.as_bytes()));
    Line { of, link, letter }
}

pub(super) async fn import(staff: Staff) -> Result<Html<String>, Problem> {
    import_page(&staff, String::new(), Vec::new(), false)
}

pub(super) async fn import_table(staff: Staff, Fields(form): Fields<Table>) -> Result<Html<String>, Problem> {
    let is_meant = form.import.is_some();
    let lines = staff.import(&form.table, !is_meant).await?;
    let (app, course) = (&staff.app, staff.course().title);
    let lines = lines.into_iter().map(|one| line(app, &course, one)).collect();
    import_page(&staff, form.table, lines, is_meant)
}
