//! Handing in, and what came of it.
use super::{
    super::{
        api,
        input::{Asked, At},
    },
    Frame,
    course::OwnWork,
    heat, see, show, text,
};
use crate::{
    access::{Assignment, History, Member, Staff, Submission},
    problem::Problem,
    secret,
    worker::STAFF_PAGE,
};
use askama::Template;
use axum::{
    extract::Request,
    http::HeaderMap,
    response::{Html, Redirect, Response},
};
use serde::Deserialize;

/// How much of a report a page shows; the rest is behind its link.
const SHOWN: u64 = 200_000;

#[derive(Template)]
#[template(path = "assignment.html")]
struct AssignmentPage {
    frame: Frame,
    slug: String,
    is_staff: bool,
    is_archived: bool,
    assignment: Assignment,
    work: OwnWork,
    key: String,
}

#[derive(Template)]
#[template(path = "submission.html")]
struct SubmissionPage {
    frame: Frame,
    slug: String,
    is_own: bool,
    is_staff: bool,
    submission: Submission,
    /// The work of its owner, and how much they may still do; nothing for others.
    work: Option<OwnWork>,
    is_moving: bool,
    history: Vec<History>,
    /// The change that it has made since the one before it.
    change: Option<String>,
    /// Scenes in which the reference may be wrong, as staff says.
    doubts: Vec<String>,
    report: Option<String>,
    /// The page that is shown: staff's own, where there is one.
    page: Option<&'static str>,
}

pub(super) async fn assignment(
    member: Member,
    At { course: slug, assignment, .. }: At,
) -> Result<Html<String>, Problem> {
    let assignment = member.assignment(&assignment).await?;
    let frame = Frame::assignment(&member, &assignment.slug, &assignment.title);
    let work = OwnWork::of(&member, &assignment).await?;
    let key = secret::random_hex();
    let (is_staff, is_archived) = (member.is_staff, member.is_archived);
    show(&AssignmentPage { frame, slug, is_staff, is_archived, assignment, work, key })
}

pub(super) async fn submit(
    member: Member,
    At { course: slug, assignment, .. }: At,
    request: Request,
) -> Result<Redirect, Problem> {
    let (submission, _) = api::receive(&member, &assignment, request, None, None, None).await?;
    Ok(see(&format!("/c/{slug}/s/{}", submission.id)))
}

/// The assignment of a submission, where the member sees it.
async fn find_assignment(member: &Member, submission: &Submission) -> Result<Option<Assignment>, Problem> {
    Ok(member.assignments().await?.into_iter().find(|assignment| assignment.slug == submission.assignment))
}

/// The frame of a submission's pages.
async fn frame(member: &Member, submission: &Submission) -> Result<Frame, Problem> {
    let frame = match find_assignment(member, submission).await? {
        Some(assignment) => Frame::assignment(member, &assignment.slug, &assignment.title),
        None => Frame::course(member),
    };
    let address = format!("/c/{}/s/{}", member.course().slug, submission.id);
    Ok(frame.then(address, &format!("Submission {}", submission.number)))
}

pub(super) async fn submission(member: Member, At { course: slug, id, .. }: At) -> Result<Html<String>, Problem> {
    let submission = member.submission(id).await?;
    let frame = frame(&member, &submission).await?;
    let has =
        |name: &str| submission.grade.as_ref().is_some_and(|grade| grade.files.iter().any(|file| file.name == name));
    let report = if has("report.txt") {
        let file = member.report(id, "report.txt").await?;
        Some(String::from_utf8_lossy(&member.beginning(&file.artefact, SHOWN).await?).into_owned())
    } else {
        None
    };
    let is_own = submission.login == member.account.login;
    let work = match is_own && !member.is_staff {
        // Staff may have hidden the assignment again.
        true => match find_assignment(&member, &submission).await? {
            Some(assignment) => Some(OwnWork::of(&member, &assignment).await?),
            None => None,
        },
        false => None,
    };
    show(&SubmissionPage {
        frame,
        slug,
        is_staff: member.is_staff,
        is_own,
        work,
        is_moving: matches!(submission.state.as_str(), "waiting" | "running"),
        history: member.history(id).await?,
        change: member.change(&submission).await?.as_ref().map(heat::change),
        doubts: member.doubts(id).await?,
        page: page_of(&submission),
        report,
        submission,
    })
}

#[derive(Template)]
#[template(path = "beside.html")]
struct BesidePage {
    frame: Frame,
    slug: String,
    is_staff: bool,
    /// Other attempts of the same person: their numbers of submission and attempt.
    attempts: Vec<(i64, i64)>,
    /// The submissions, each with its page.
    shown: Vec<(Submission, Option<&'static str>)>,
}

/// The submission that is to stand beside another one.
#[derive(Deserialize)]
pub(super) struct Beside {
    #[serde(default)]
    attempt: String,
    #[serde(default)]
    login: String,
}

pub(super) async fn beside(
    member: Member,
    At { course: slug, id, .. }: At,
    Asked(Beside { attempt, login }): Asked<Beside>,
) -> Result<Html<String>, Problem> {
    let one = member.submission(id).await?;
    let attempts = member.attempts_beside(&one).await?;
    let other = match (attempt.trim(), login.trim()) {
        ("", "") => None,
        ("", login) => Some(member.latest_beside(&one, login).await?),
        (attempt, _) => Some(attempt.parse().map_err(|_| Problem::not_found("submission"))?),
    };
    let other = match other {
        Some(other) => Some(member.submission(other).await?),
        None => None,
    };
    let frame = frame(&member, &one).await?;
    let shown = std::iter::once(one).chain(other).map(|one| {
        let page = page_of(&one);
        (one, page)
    });
    show(&BesidePage { frame, is_staff: member.is_staff, attempts, shown: shown.collect(), slug })
}

/// The page that is shown of a submission: staff's own, where there is one that the reader may see.
fn page_of(submission: &Submission) -> Option<&'static str> {
    let files = submission.grade.iter().flat_map(|grade| &grade.files);
    let names: Vec<&str> = files.map(|file| file.name.as_str()).collect();
    [STAFF_PAGE, "report.html"].into_iter().find(|name| names.contains(name))
}

pub(super) async fn report(member: Member, At { id, name, .. }: At, headers: HeaderMap) -> Result<Response, Problem> {
    api::report_response(&member, id, &name, &headers).await
}

pub(super) async fn upload(member: Member, At { id, .. }: At, headers: HeaderMap) -> Result<Response, Problem> {
    api::upload_response(&member, id, &headers).await
}

deeds! {
    grade_again(staff: Staff, { course, id }): staff.grade_again(id) => "/c/{course}/s/{id}";
}
