//! The page for staff about one student's work, and the pages for importing a class from a table.
use super::{
    super::{
        api::{ReviewRequest, write_csv},
        input::{Fields, UrlPathParts},
        upload,
    },
    Page, PageFrame, grades, render, scenes,
    settings::read_due_date,
    text,
};
use crate::{
    domain::{Assignment, Member, MemberInfo, MemberLine, Staff, StudentHistory},
    problem::Problem,
};
use askama::Template;
use axum::{extract::Request, response::Redirect};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use url::form_urlencoded::byte_serialize;

#[derive(Template)]
#[template(path = "student.html")]
struct StudentPage {
    frame: PageFrame,
    slug: String,
    assignment: Assignment,
    work: StudentHistory,
    /// Sentences about the changes between attempts, by the ID of the later submission.
    changes: BTreeMap<i64, String>,
    /// The ID of the course's newest event when the page was rendered. Each form sends it with the change, to
    /// detect conflicts.
    seen_event: i64,
}

#[derive(Template)]
#[template(path = "import.html")]
struct ImportPage {
    frame: PageFrame,
    slug: String,
    table: String,
    lines: Vec<ImportRow>,
    /// The columns in the table whose values are not stored.
    ignored_columns: BTreeSet<String>,
    is_wrong: bool,
    is_done: bool,
    /// A table of all sign-in links, as a `data:` URL that the browser can save.
    download: String,
    /// The ID of the course's newest event when the page was rendered. Each form sends it with the change, to
    /// detect conflicts.
    seen_event: i64,
}

impl ImportPage {
    /// Describes how many people the import adds and changes.
    fn describe_changes(&self) -> String {
        let count = |change| self.lines.iter().filter(|line| line.change == change).count();
        let [new, role, name, same] = ["new", "other role", "other name", "unchanged"].map(count);
        let renamed = if name > 0 { format!("{name} with another name, ") } else { String::new() };
        format!("{new} new, {role} with another role, {renamed}{same} unchanged")
    }
}

/// A row of an imported table, with the sign-in link if one was created.
struct ImportRow {
    member: MemberLine,
    /// The change that the import makes for this person: `new`, `other role`, `other name` or `unchanged`.
    change: &'static str,
    link: String,
    /// A mail message that contains the sign-in link, as a `mailto:` URL.
    mail: String,
}

#[derive(Deserialize)]
pub(super) struct NewExtension {
    due: String,
    #[serde(default)]
    due_zone: String,
    /// The ID of the newest event when the page was rendered. The form sends it with the change, to detect conflicts.
    #[serde(rename = "seen")]
    seen_event: Option<i64>,
}

#[derive(Deserialize)]
pub(super) struct NewMark {
    #[serde(default)]
    points: String,
    #[serde(default)]
    comment: String,
    /// The time of the mark when the page was rendered. The form sends it with the change, to detect conflicts.
    marked_at: Option<String>,
}

#[derive(Deserialize)]
pub(super) struct ImportedTable {
    table: String,
    import: Option<String>,
    /// The ID of the newest event when the page was rendered. The form sends it with the change, to detect conflicts.
    #[serde(rename = "seen")]
    seen_event: Option<i64>,
}

pub(super) async fn show(staff: Staff, UrlPathParts { course: slug, assignment, login, .. }: UrlPathParts) -> Page {
    let assignment = staff.assignment(&assignment).await?;
    // Read the ID of the newest event before the submissions, so that later changes are detected.
    let seen_event = staff.last_event().await?;
    let work = staff.student_history(&assignment.slug, &login).await?;
    let address = format!("/c/{slug}/a/{}/students/{login}", assignment.slug);
    let frame = grades::class_frame(&staff, &assignment).with_parent(address, &work.name);
    let changes = staff.attempt_changes(&work.submissions).await?;
    let changes = changes.iter().map(|(id, change)| (*id, scenes::describe_change(change))).collect();
    render(&StudentPage { frame, slug, assignment, work, changes, seen_event })
}

/// Reads points from a form field; `None` if the field is empty. A decimal comma, as in `7,5`, is read as a decimal
/// point. Three digits after a comma may be thousands, so such a number is left as it is.
fn read_points(field: &str) -> Option<String> {
    match field.split_once(',') {
        Some((whole, part)) if (1..=2).contains(&part.len()) => Some(format!("{whole}.{part}")),
        _ => Some(field.to_owned()).filter(|field| !field.is_empty()),
    }
}

async fn render_import(staff: &Staff, table: String, lines: Vec<ImportRow>, is_done: bool) -> Page {
    let slug = staff.slug.clone();
    let frame = PageFrame::course(staff)
        .with_parent(format!("/c/{slug}/members"), "Members")
        .with_parent(format!("/c/{slug}/members/import"), "Import a class");
    let is_wrong = lines.iter().any(|line| line.member.error.is_some());
    let mut rows = vec![["Name", "Login", "E-mail", "Role", "Link"].map(str::to_owned).to_vec()];
    rows.extend(lines.iter().map(|ImportRow { member, link, .. }| {
        [&member.name, &member.login, &member.email, &member.role, link].map(String::clone).to_vec()
    }));
    let seen_event = staff.last_event().await?;
    let download = format!("data:text/csv;charset=utf-8,{}", percent_encode(write_csv(rows)?.as_bytes()));
    let is_done = is_done && !is_wrong;
    let ignored_columns = lines.iter().flat_map(|line| line.member.unused.clone()).collect();
    render(&ImportPage { frame, slug, table, lines, ignored_columns, is_wrong, is_done, download, seen_event })
}

/// Encodes bytes for a URL, with percent signs.
fn percent_encode(bytes: &[u8]) -> String {
    byte_serialize(bytes).collect::<String>().replace('+', "%20")
}

fn import_row(course: &str, before: &[MemberInfo], line: MemberLine) -> ImportRow {
    let change = match before.iter().find(|member| member.login == line.login) {
        None => "new",
        Some(member) if member.role != line.role => "other role",
        Some(member) if member.is_ours && member.name != line.name => "other name",
        Some(_) => "unchanged",
    };
    let link = line.link.clone().unwrap_or_default();
    let (subject, body) =
        (percent_encode(course.as_bytes()), percent_encode(format!("{}:\n{link}\n", line.name).as_bytes()));
    let letter = format!("mailto:{}?subject={subject}&body={body}", percent_encode(line.email.as_bytes()));
    ImportRow { member: line, change, link, mail: letter }
}

pub(super) async fn show_import(staff: Staff) -> Page {
    render_import(&staff, String::new(), Vec::new(), false).await
}

/// The maximum size of a file with a table of members, in bytes.
const MAX_TABLE_BYTES: u64 = 1 << 20;

/// Reads a file with a table of members, and shows what importing it would change.
pub(super) async fn import_file(staff: Staff, request: Request) -> Page {
    let received = upload::receive(&staff.app, request, MAX_TABLE_BYTES).await?;
    let table = String::from_utf8_lossy(&tokio::fs::read(&received.file).await?).into_owned();
    render_preview(&staff, table, None, false).await
}

async fn render_preview(staff: &Staff, table: String, seen_event: Option<i64>, is_confirmed: bool) -> Page {
    let before = staff.members().await?;
    let lines = staff.import(&table, !is_confirmed, seen_event).await?;
    let mut lines: Vec<_> = lines.into_iter().map(|line| import_row(&staff.title, &before, line)).collect();
    lines.sort_by_key(|line| line.member.error.is_none());
    render_import(staff, table, lines, is_confirmed).await
}

pub(super) async fn import_table(staff: Staff, Fields(form): Fields<ImportedTable>) -> Page {
    render_preview(&staff, form.table, form.seen_event, form.import.is_some()).await
}

actions! {
    extend(staff: Staff, { course, assignment, login }, form: NewExtension): {
        let before = staff.student_history(&assignment, &login).await?.extended_to;
        staff.extend(&assignment, &login, read_due_date(&form.due, &form.due_zone, before)?, form.seen_event)
    } => "/c/{course}/a/{assignment}/students/{login}";
    mark(staff: Staff, { course, id }, form: NewMark):
        async {
            let seen_mark = form.marked_at.as_ref().map(|moment| moment.parse().ok());
            let points = read_points(form.points.trim());
            staff.mark(id, points.as_deref(), form.comment.trim(), seen_mark).await
        } => "/c/{course}/s/{id}";
    request(member: Member, { course, id }, form: ReviewRequest):
        member.request(id, form.text.trim()) => "/c/{course}/s/{id}";
}
