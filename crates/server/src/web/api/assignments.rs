//! The API of assignments, and of the results of a whole class.
use super::super::{
    archive_check,
    input::{Body, QueryInput, SeenEvent, UrlPathParts, read_fields},
    upload,
};
use crate::{
    domain::{
        Assignment, AssignmentChange, Member, NewSuite, Settings, Staff, Standing, SuiteGroup, read_moment, time_schema,
    },
    problem::{Problem, ensure},
    schema::Title,
    worker,
};
use axum::{
    Json,
    body::Body as HttpBody,
    extract::Request,
    http::{StatusCode, header},
    response::{IntoResponse, Response},
};
use serde::Deserialize;
use serde_json::{Map, Value};
use std::path::Path;
use utoipa::ToSchema;

/// The maximum size of a suite's archive, in bytes.
const MAX_SUITE_BYTES: u64 = 64 << 20;

/// The new state of an assignment. Parts and settings that the request does not name stay as they are. A setting that
/// is null is removed.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(as = AssignmentWish)]
pub(super) struct AssignmentInput {
    #[schema(value_type = Title)]
    title: String,
    /// Whether students see the assignment; by default it is hidden.
    visible: Option<bool>,
    #[serde(default, deserialize_with = "read_fields")]
    #[schema(value_type = Settings, required = false)]
    settings: Map<String, Value>,
    /// The revision on which the change is based. If there is a later revision, the change is rejected. Without this
    /// field, it is not checked.
    #[schema(minimum = 0, maximum = 9_007_199_254_740_991_i64)]
    revision: Option<i64>,
}

/// The revision on which a change of an assignment is based, as a query parameter.
#[derive(Deserialize)]
pub(in crate::web) struct Revision {
    revision: Option<i64>,
}

impl AssignmentInput {
    fn change(&self) -> AssignmentChange<'_> {
        let Self { title, visible, revision, .. } = self;
        AssignmentChange { title: Some(title), visible: *visible, revision: *revision, suite: None }
    }
}

/// The format of an export, as a query parameter: `csv` or `jsonl`.
#[derive(Deserialize)]
pub(super) struct GradesFormat {
    format: Option<String>,
}

/// The request that sets a student's own due date.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Extension {
    /// The due date in milliseconds since 1970, or as a date with its time zone.
    #[serde(deserialize_with = "read_moment")]
    #[schema(schema_with = time_schema, required = true)]
    due_at: Option<i64>,
    /// The ID of the newest event of the audit log that the sender has seen. If this extension was changed after
    /// it, the request is rejected. Without this field, nothing is checked.
    #[schema(minimum = 0, maximum = 9_007_199_254_740_991_i64)]
    #[serde(rename = "seen")]
    seen_event: Option<i64>,
}

/// Uploads a `suite.toml`, or an archive (zip, tar, tar.gz) with one at its top, as the assignment's suite. The groups
/// that it hides are withheld, even if groups of the earlier suite were published.
#[utoipa::path(put, path = "/api/v1/courses/{course}/assignments/{assignment}/suite", tag = "assignments",
    params(("revision" = Option<i64>, Query, description = "The revision that the change is based on")),
    request_body(content = Vec<u8>, content_type = "application/octet-stream"),
    responses((status = 200, body = Assignment)))]
pub(super) async fn set_suite(
    staff: Staff,
    UrlPathParts { assignment, .. }: UrlPathParts,
    QueryInput(query): QueryInput<Revision>,
    request: Request,
) -> Result<Json<Assignment>, Problem> {
    Ok(Json(receive_suite(&staff, &assignment, &query, request).await?))
}

/// Receives an archive with a suite, and makes it the assignment's suite.
pub(in crate::web) async fn receive_suite(
    staff: &Staff,
    assignment: &str,
    query: &Revision,
    request: Request,
) -> Result<Assignment, Problem> {
    let received = upload::receive(&staff.app, request, MAX_SUITE_BYTES).await?;
    let app = &staff.app;
    ensure(std::fs::metadata(&received.file)?.len() > 0, Problem::no_suite("the file is empty"))?;
    pack_lone_suite(&received.file)?;
    let folder = tempfile::tempdir_in(&app.incoming)?;
    archive_check::unpack(staff, &received.file, folder.path()).await?;
    let suite = check_scenes(folder.path())?;
    if let Some(grader) = app.grader.as_deref() {
        worker::check_suite(grader, folder.path()).await.map_err(Problem::no_suite)?;
    }
    staff.set_suite(assignment, &received.file, suite, query.revision).await
}

/// The maximum size of a `suite.toml`, in bytes.
const MAX_SUITE_FILE_BYTES: u64 = 1 << 20;

/// Puts a `suite.toml` that was uploaded without an archive into an archive.
fn pack_lone_suite(file: &Path) -> std::io::Result<()> {
    let is_small = std::fs::metadata(file)?.len() <= MAX_SUITE_FILE_BYTES;
    let text = is_small.then(|| std::fs::read_to_string(file).ok()).flatten();
    let Some(text) = text.filter(|text| !text.contains('\0')) else { return Ok(()) };
    let mut archive = tar::Builder::new(std::fs::File::create(file)?);
    let mut header = tar::Header::new_gnu();
    header.set_size(text.len() as u64);
    header.set_mode(0o644);
    archive.append_data(&mut header, "suite.toml", text.as_bytes())?;
    archive.finish()
}

/// Checks that each scene of a suite is in the archive, or is a scene of the grader. Otherwise a worker would read
/// other files on its machine. Returns the suite, without its digest.
fn check_scenes(folder: &Path) -> Result<NewSuite, Problem> {
    let file = folder.join("suite.toml");
    if std::fs::metadata(&file).is_ok_and(|file| file.len() > MAX_SUITE_FILE_BYTES) {
        return Err(Problem::no_suite("suite.toml is larger than a mebibyte"));
    }
    let Ok(text) = std::fs::read_to_string(&file) else {
        return Err(Problem::no_suite("the archive has no suite.toml at its top, in UTF-8"));
    };
    let suite: toml::Table =
        text.parse().map_err(|error| Problem::no_suite(format!("suite.toml can't be read: {error}")))?;
    let groups = || suite.get("group").and_then(toml::Value::as_array).into_iter().flatten();
    let scenes = groups().filter_map(|group| group.get("scenes")?.as_array()).flatten().filter_map(toml::Value::as_str);
    for scene in scenes {
        if scene.starts_with('/') || scene.split('/').any(|part| part == "..") {
            return Err(Problem::no_suite(format!("the scene {scene} is not in the archive")));
        }
    }
    let name = suite.get("name").and_then(toml::Value::as_str).unwrap_or_default().chars().take(200).collect();
    Ok(NewSuite { name, groups: groups().map(SuiteGroup::from_toml).collect(), ..NewSuite::default() })
}

/// Returns the class's grades as a table (`csv`, one line per student), or all submissions as JSON lines (`jsonl`, one
/// line per submission).
#[utoipa::path(get, path = "/api/v1/courses/{course}/assignments/{assignment}/export", tag = "assignments",
    params(("format" = Option<String>, Query, description = "csv (the default) or jsonl")),
    responses((status = 200, description = "The grades")))]
pub(super) async fn export(
    staff: Staff,
    UrlPathParts { assignment, .. }: UrlPathParts,
    QueryInput(query): QueryInput<GradesFormat>,
) -> Result<Response, Problem> {
    let format = query.format.as_deref().unwrap_or("csv");
    let disposition = format!("attachment; filename=\"{}-{assignment}.{format}\"", staff.slug);
    let (kind, body) = match format {
        "csv" => ("text/csv; charset=utf-8", HttpBody::from(grades_csv(&staff, &assignment).await?)),
        "jsonl" => ("application/jsonl; charset=utf-8", submissions_jsonl(staff, &assignment).await?),
        _ => return Err(Problem::invalid("format must be csv or jsonl")),
    };
    Ok(([(header::CONTENT_TYPE, kind), (header::CONTENT_DISPOSITION, disposition.as_str())], body).into_response())
}

/// Returns the standings of all students as a table, with the points of groups and the likely mistakes.
async fn grades_csv(staff: &Staff, assignment: &str) -> Result<String, Problem> {
    let standings = staff.standings(assignment).await?;
    let grades = standings.iter().filter_map(|standing| standing.counts.as_ref()?.grade.as_ref());
    let stored_results = staff.stored_results(&grades.map(|grade| grade.result).collect::<Vec<_>>()).await?;
    super::export_csv(&standings, &stored_results)
}

/// Returns all submissions as JSON, one per line. They are read from the database while they are sent.
async fn submissions_jsonl(staff: Staff, assignment: &str) -> Result<HttpBody, Problem> {
    let transfer = staff.transfer()?;
    let assignment = staff.assignment(assignment).await?;
    let pages = futures_util::stream::try_unfold((staff, 0), move |(staff, after)| {
        let (assignment, _of_this_answer) = (assignment.id, &transfer);
        async move {
            let page = staff.submissions_after(assignment, after).await;
            let page = page.map_err(|problem| std::io::Error::other(problem.detail))?;
            let Some(last) = page.last() else { return Ok::<_, std::io::Error>(None) };
            let after = last.id;
            let mut text = String::new();
            for submission in &page {
                text.push_str(&serde_json::to_string(submission)?);
                text.push('\n');
            }
            Ok(Some((text, (staff, after))))
        }
    });
    Ok(HttpBody::from_stream(pages))
}

answers! { OK:
    /// Creates an assignment or changes it. Existing grades do not change until a regrade. However, a change of the
    /// rule for late work counts immediately.
    put "/api/v1/courses/{course}/assignments/{assignment}" "assignments"
        set_assignment(staff: Staff, { assignment }, input: AssignmentInput) -> Assignment:
            staff.set_assignment(&assignment, input.change(), |before| before.with_changes(&input.settings));
    /// Lists the assignments of a course that the person may see.
    get "/api/v1/courses/{course}/assignments" "assignments"
        assignments(member: Member) -> Vec<Assignment>: member.assignments();
    /// Returns an assignment and its settings.
    get "/api/v1/courses/{course}/assignments/{assignment}" "assignments"
        assignment(member: Member, { assignment }) -> Assignment: member.assignment(&assignment);
    /// Publishes the groups that the suite hides. From then on, students see them, and they count for students.
    put "/api/v1/courses/{course}/assignments/{assignment}/published" "assignments"
        publish(staff: Staff, { assignment }) -> Assignment: staff.publish(&assignment, true);
    /// Withholds the suite's hidden groups again.
    delete "/api/v1/courses/{course}/assignments/{assignment}/published" "assignments"
        withhold(staff: Staff, { assignment }) -> Assignment: staff.publish(&assignment, false);
    /// Returns the standings of all students, each with the submission that counts.
    get "/api/v1/courses/{course}/assignments/{assignment}/class" "assignments"
        standings(staff: Staff, { assignment }) -> Vec<Standing>: staff.standings(&assignment);
}

actions! { NO_CONTENT:
    /// Sets a student's own due date.
    put "/api/v1/courses/{course}/assignments/{assignment}/extensions/{login}" "assignments"
        extend(staff: Staff, { assignment, login }, input: Extension) -> "Set":
            staff.extend(&assignment, &login, input.due_at, input.seen_event);
    /// Removes an assignment with all its submissions. This cannot be undone.
    delete "/api/v1/courses/{course}/assignments/{assignment}" "assignments"
        remove_assignment(staff: Staff, { assignment }) -> "Removed": staff.remove_assignment(&assignment);
    /// Removes a student's own due date, so that the assignment's due date applies.
    delete "/api/v1/courses/{course}/assignments/{assignment}/extensions/{login}" "assignments"
        extend_no_more(staff: Staff, { assignment, login }, ?query: SeenEvent) -> "Set":
            staff.extend(&assignment, &login, None, query.event());
}
