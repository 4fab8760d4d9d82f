//! The API of submissions.
use super::super::{
    archive_check, download,
    input::{ArrivalTime, Body, QueryInput, UrlPathParts},
    upload,
};
use crate::{
    calendar,
    domain::{EnqueuedJobs, History, Member, Staff, Standing, StoredResult, Submission, SubmitResult, Upload},
    problem::Problem,
    queue::millis,
    task::format_points,
};
use axum::{
    Json,
    extract::Request,
    http::{HeaderMap, HeaderValue, StatusCode, header},
    response::{IntoResponse, Response},
};
use serde::Deserialize;
use std::{collections::BTreeMap, time::Instant};
use utoipa::ToSchema;

/// The parameters of an upload whose body is the file itself, not a form.
#[derive(Deserialize)]
pub(super) struct UploadParameters {
    /// The file's name.
    name: Option<String>,
    /// The kind of submission: `program`, `sources` or `traces`. By default it is recognized from the file.
    #[serde(rename = "form")]
    kind: Option<String>,
}

/// Uploads a submission. The body is the file, or a form (`multipart/form-data`) with a field `file`. With an
/// `Idempotency-Key`, repeated uploads count as one submission: the first answer has the status 201, and later ones
/// have 200.
#[utoipa::path(post, path = "/api/v1/courses/{course}/assignments/{assignment}/submissions", tag = "submissions",
    params(("name" = Option<String>, Query, description = "The file's name"),
        ("form" = Option<String>, Query, description = "program, sources or traces; otherwise recognized from the \
            file"),
        ("Idempotency-Key" = Option<String>, Header, description = "The sender's key for this upload")),
    request_body(content = Vec<u8>, content_type = "application/octet-stream"),
    responses((status = 201, body = Submission), (status = 200, body = Submission)))]
pub(super) async fn submit(
    member: Member,
    UrlPathParts { assignment, .. }: UrlPathParts,
    QueryInput(about): QueryInput<UploadParameters>,
    headers: HeaderMap,
    request: Request,
) -> Result<Response, Problem> {
    let key = match headers.get("idempotency-key") {
        None => None,
        Some(key) => Some(key.to_str().map_err(|_| Problem::invalid("Idempotency-Key is not ASCII"))?),
    };
    let SubmitResult { submission, repeated } =
        receive(&member, &assignment, request, about.name.as_deref(), about.kind.as_deref(), key).await?;
    let status = if repeated { StatusCode::OK } else { StatusCode::CREATED };
    let address = format!("/api/v1/courses/{}/submissions/{}", member.slug, submission.id);
    Ok((status, [(header::LOCATION, address)], Json(submission)).into_response())
}

/// Receives an upload and submits it.
pub(in crate::web) async fn receive(
    member: &Member,
    assignment: &str,
    request: Request,
    name: Option<&str>,
    form: Option<&str>,
    key: Option<&str>,
) -> Result<SubmitResult, Problem> {
    let _transfer = member.transfer()?;
    let settings = member.assignment(assignment).await?.settings;
    let max_bytes = settings.max_bytes;
    let since = request.extensions().get::<ArrivalTime>().map_or_else(Instant::now, |ArrivalTime(since)| *since);
    // The key in a form is not known before the body is read.
    let announced = (!upload::is_form(&request)).then(|| (key, upload::announced_size(&request).unwrap_or(0)));
    let arrived_at = match member.check_announcement(assignment, announced, since).await {
        Ok(arrived_at) => arrived_at,
        Err(problem) => return Err(upload::reject(&member.app, request, max_bytes, problem).await),
    };
    let received = upload::receive(&member.app, request, max_bytes).await?;
    let excess = since.elapsed().saturating_sub(upload::allowed_time(std::fs::metadata(&received.file)?.len()));
    let arrived_at = arrived_at.saturating_add(millis(excess));
    let form = archive_check::examine(member, &received.file, received.form.as_deref().or(form), &settings).await?;
    let name = upload::plain_name(received.name.as_deref().or(name).unwrap_or("submission"));
    // The page's key is combined with the file, because another file from the same page is another submission.
    let page_key = match &received.key {
        Some(key) => Some(format!("{key} {}", crate::store::digest_of_file(&received.file).await?.digest)),
        None => None,
    };
    let key = page_key.as_deref().or(key);
    if key.is_some_and(|key| !(1..=200).contains(&key.len()) || key.chars().any(char::is_control)) {
        return Err(Problem::invalid("a key must have 1 to 200 characters"));
    }
    member.submit(assignment, &Upload { form, name: &name, file: &received.file, key, arrived_at }).await
}

/// The points and the comment that staff give a submission.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(as = MarkWish)]
pub(super) struct MarkInput {
    /// The points that count instead of the grader's. Null restores the grader's points.
    #[serde(default)]
    #[schema(minimum = 0, maximum = 1_000_000)]
    points: Option<f64>,
    /// The reason for the points, or another comment; the student reads it.
    #[serde(default)]
    #[schema(max_length = 2000, pattern = r"^[^\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f]*$")]
    comment: String,
    /// The time of the newest mark that the sender has seen, in milliseconds since 1970. If there is a later mark, the
    /// request is rejected. Without this field, nothing is checked.
    #[schema(minimum = 0, maximum = 9_007_199_254_740_991_i64)]
    marked_at: Option<i64>,
}

/// A student's request for a review.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(as = RequestWish)]
pub(in crate::web) struct ReviewRequest {
    /// The student's question about the grade.
    #[schema(min_length = 1, max_length = 2000, pattern = r"^[^\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f]*$")]
    pub(in crate::web) text: String,
}

/// Returns a report on a submission, such as `grade.json` or `report.txt`, as the grader wrote it.
#[utoipa::path(get, path = "/api/v1/courses/{course}/submissions/{id}/files/{name}", tag = "submissions",
    responses((status = 200, description = "The report")))]
pub(super) async fn report(
    member: Member,
    UrlPathParts { id, name, .. }: UrlPathParts,
    request_headers: HeaderMap,
) -> Result<Response, Problem> {
    let file = member.report(id, &name).await?;
    let kind = HeaderValue::from_str(&file.media_type).unwrap_or(HeaderValue::from_static("application/octet-stream"));
    // The report contains text from an untrusted program. Therefore the browser must not treat the report as a page of
    // this site, which could use the site's cookies.
    let policy = if file.media_type.starts_with("text/html") {
        "sandbox allow-scripts allow-downloads; default-src 'none'; script-src 'unsafe-inline'; style-src \
        'unsafe-inline'; img-src data:"
    } else {
        "sandbox; default-src 'none'"
    };
    let headers = [(header::CONTENT_TYPE, kind), (header::CONTENT_SECURITY_POLICY, HeaderValue::from_static(policy))];
    Ok((headers, download::send(&member, &request_headers, &file.artifact).await?).into_response())
}

/// Returns the uploaded file.
#[utoipa::path(get, path = "/api/v1/courses/{course}/submissions/{id}/upload", tag = "submissions",
    responses((status = 200, description = "The file")))]
pub(super) async fn upload(
    member: Member,
    UrlPathParts { id, .. }: UrlPathParts,
    request_headers: HeaderMap,
) -> Result<Response, Problem> {
    let (submission, artifact) = member.upload(id).await?;
    // The uploaded file is not trusted, so browsers must save it instead of showing it. Unsafe characters were removed
    // from its name when it arrived.
    let disposition = format!("attachment; filename=\"{}\"", submission.file_name);
    let headers = [
        (header::CONTENT_TYPE, HeaderValue::from_static("application/octet-stream")),
        (
            header::CONTENT_DISPOSITION,
            HeaderValue::from_str(&disposition).unwrap_or(HeaderValue::from_static("attachment")),
        ),
        (header::CONTENT_SECURITY_POLICY, HeaderValue::from_static("sandbox; default-src 'none'")),
    ];
    Ok((headers, download::send(&member, &request_headers, &artifact).await?).into_response())
}

/// Returns a class's grades as a table, with a column for each group. Cells that spreadsheets would read as a formula
/// are marked as text.
///
/// # Errors
///
/// Fails only if memory runs out.
pub fn export_csv(standings: &[Standing], stored_results: &BTreeMap<i64, StoredResult>) -> Result<String, Problem> {
    let head = "login,name,submissions,submission,verdict,points,grader_points,max_points,graded_at,likely_mistake";
    let mut groups: Vec<&str> = Vec::new();
    for (group, _) in stored_results.values().flat_map(|kept| &kept.parts.groups) {
        if !groups.contains(&group.as_str()) {
            groups.push(group);
        }
    }
    let mut rows = vec![head.split(',').chain(groups.iter().copied()).map(str::to_owned).collect()];
    for standing in standings {
        let counts = standing.counts.as_ref();
        let grade = counts.and_then(|counts| counts.grade.as_ref());
        let staff_mark = counts.and_then(|counts| counts.mark.as_ref()).filter(|mark| mark.points.is_some());
        let or_empty = |text: Option<&String>| text.map(format_points).unwrap_or_default();
        let parts = grade.and_then(|grade| Some(&stored_results.get(&grade.result)?.parts));
        let points = groups.iter().map(|name| {
            let found = parts.and_then(|parts| parts.groups.iter().find(|(group, _)| group == name));
            found.and_then(|(_, points)| points.map(format_points)).unwrap_or_default()
        });
        let row = [
            standing.login.clone(),
            standing.name.clone(),
            standing.submissions.to_string(),
            counts.map(|counts| counts.id.to_string()).unwrap_or_default(),
            grade.map(|grade| grade.verdict.clone()).unwrap_or_default(),
            or_empty(grade.and_then(|grade| grade.points.as_ref())),
            or_empty(staff_mark.and_then(|mark| mark.grader_points.as_ref())),
            or_empty(grade.and_then(|grade| grade.max_points.as_ref())),
            grade.map(|grade| calendar::format_iso(grade.created_at)).unwrap_or_default(),
            parts.map(|parts| parts.mistakes.join(" ")).unwrap_or_default(),
        ];
        rows.push(row.into_iter().chain(points).collect());
    }
    write_csv(rows)
}

/// Writes a table. Text that a spreadsheet would read as a formula is marked, so that it is read as text.
pub(in crate::web) fn write_csv(rows: Vec<Vec<String>>) -> Result<String, Problem> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let is_formula = |cell: &String| cell.starts_with(['=', '+', '-', '@', '\t']);
    for row in rows {
        let cells = row.into_iter().map(|cell| if is_formula(&cell) { format!("'{cell}") } else { cell });
        writer.write_record(cells).map_err(|_| Problem::fault())?;
    }
    let bytes = writer.into_inner().map_err(|_| Problem::fault())?;
    String::from_utf8(bytes).map_err(|_| Problem::fault())
}

answers! { ACCEPTED:
    /// Grades a submission again, with the assignment's present settings.
    post "/api/v1/courses/{course}/submissions/{id}/again" "submissions"
        grade_again(staff: Staff, { id }) -> EnqueuedJobs: staff.grade_again(id);
    /// Grades all submissions to an assignment again if the grader failed on them.
    post "/api/v1/courses/{course}/assignments/{assignment}/judge-errors/again" "submissions"
        grade_errors_again(staff: Staff, { assignment }) -> EnqueuedJobs: staff.grade_errors_again(Some(&assignment));
    /// Grades all submissions of a course again if the grader failed on them.
    post "/api/v1/courses/{course}/judge-errors/again" "submissions"
        grade_all_errors_again(staff: Staff) -> EnqueuedJobs: staff.grade_errors_again(None);
}

answers! { OK:
    /// Replaces the grader's points of a submission, with a comment, or restores them.
    put "/api/v1/courses/{course}/submissions/{id}/mark" "submissions"
        mark(staff: Staff, { id }, input: MarkInput) -> Submission:
            staff.mark(
                id,
                input.points.map(|points| points.to_string()).as_deref(),
                &input.comment,
                input.marked_at.map(Some)
            );
    /// Lists the submissions of the person who is signed in, newest first.
    get "/api/v1/courses/{course}/assignments/{assignment}/submissions" "submissions"
        own(member: Member, { assignment }) -> Vec<Submission>: member.submissions(&assignment);
    /// Returns a submission with its position in the queue and its result.
    get "/api/v1/courses/{course}/submissions/{id}" "submissions"
        submission(member: Member, { id }) -> Submission: member.submission(id);
    /// Returns the changes of a submission's grade. Each has its time, its reason, the person who caused it, and the
    /// version and rules of the grading.
    get "/api/v1/courses/{course}/submissions/{id}/history" "submissions"
        history(member: Member, { id }) -> Vec<History>: member.history(id);
}

actions! { NO_CONTENT:
    /// Requests that staff review a submission of the person who is signed in.
    post "/api/v1/courses/{course}/submissions/{id}/request" "submissions"
        request(member: Member, { id }, input: ReviewRequest) -> "Staff see it": member.request(id, &input.text);
    /// Removes a submission with its grades and reports. This cannot be undone.
    delete "/api/v1/courses/{course}/submissions/{id}" "submissions"
        remove_submission(staff: Staff, { id }) -> "Removed": staff.remove_submission(id);
}
