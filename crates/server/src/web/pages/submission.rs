//! The page for submitting, and the page of a submission with its result.
use super::{
    super::{api, input::UrlPathParts},
    Page, PageFrame,
    course::OwnWork,
    render, report, scenes, text,
};
use crate::{
    domain::{Assignment, History, Member, Staff, Submission, SuiteGroup},
    problem::Problem,
    secret,
    visible_grade::{VisibleGrade, verdict},
    worker::{PUBLISHED_PAGE, STAFF_PAGE},
};
use askama::Template;
use axum::{extract::Request, response::Redirect};

#[derive(Template)]
#[template(path = "assignment.html")]
struct AssignmentPage {
    frame: PageFrame,
    member: Member,
    assignment: Assignment,
    work: OwnWork,
    /// The groups of the suite that are not hidden.
    groups: Vec<SuiteGroup>,
    hides_groups: bool,
    key: String,
}

#[derive(Template)]
#[template(path = "submission.html")]
struct SubmissionPage {
    frame: PageFrame,
    member: Member,
    is_own: bool,
    submission: Submission,
    /// The owner's attempts and how many are left; `None` for other readers.
    work: Option<OwnWork>,
    is_pending: bool,
    history: Vec<History>,
    /// A sentence about what changed since the owner's preceding submission.
    change: Option<String>,
    /// All submissions of the owner to this assignment, oldest first.
    attempts: Vec<Submission>,
    /// The file name of the report that the page shows. Staff see their own report, if there is one.
    page: Option<&'static str>,
    /// The report as HTML, if the page can contain it.
    report: Option<String>,
    /// The verdict without hidden groups, and the time at which these were published. Only for staff.
    hidden: Option<(String, Option<i64>)>,
}

pub(super) async fn show_assignment(member: Member, UrlPathParts { assignment, .. }: UrlPathParts) -> Page {
    let assignment = member.assignment(&assignment).await?;
    let address = format!("/c/{}/a/{}", member.slug, assignment.slug);
    let frame = PageFrame::assignment(&member, &assignment).with_parent(address, "Submit");
    let work = OwnWork::read(&member, &assignment).await?;
    let (hidden, groups): (Vec<_>, _) =
        member.suite_groups(&assignment.slug).await?.into_iter().partition(|group| group.is_hidden);
    let hides_groups = !hidden.is_empty();
    render(&AssignmentPage { frame, member, assignment, work, groups, hides_groups, key: secret::random_hex() })
}

pub(super) async fn submit(
    member: Member,
    UrlPathParts { course: slug, assignment, .. }: UrlPathParts,
    request: Request,
) -> Result<Redirect, Problem> {
    let result = api::receive(&member, &assignment, request, None, None, None).await?;
    Ok(Redirect::to(&format!("/c/{slug}/s/{}", result.submission.id)))
}

/// Returns the frame of a submission's pages.
fn submission_frame(member: &Member, assignment: Option<&Assignment>, submission: &Submission) -> PageFrame {
    let assignment_frame = |assignment: &Assignment| {
        let frame = PageFrame::assignment(member, assignment);
        if member.is_staff {
            frame.with_parent(format!("/c/{}/a/{}/class", member.slug, assignment.slug), "")
        } else {
            frame
        }
    };
    let frame = assignment.map_or_else(|| PageFrame::course(member), assignment_frame);
    let address = format!("/c/{}/s/{}", member.slug, submission.id);
    frame.with_parent(address, &format!("Submission {}", submission.number))
}

pub(super) async fn show_submission(member: Member, UrlPathParts { id, .. }: UrlPathParts) -> Page {
    let submission = member.submission(id).await?;
    // The member may no longer see the assignment.
    let assignment = member.assignments().await?.into_iter().find(|one| one.slug == submission.assignment);
    let page = report_page(&submission);
    let report = match page.filter(|_| submission.removed_at.is_none()) {
        Some(name) => report::read_report(&member, &member.report(id, name).await?).await?,
        None => None,
    };
    let visible_grade = submission.grade.as_ref().and_then(|grade| VisibleGrade::from_text(grade.shown.as_deref()?));
    let hidden = visible_grade.filter(|_| member.is_staff).zip(assignment.as_ref());
    let hidden =
        hidden.map(|(visible_grade, assignment)| (verdict(&visible_grade.code).to_owned(), assignment.published_at));
    let is_own = submission.login == member.account.login;
    // Staff may have hidden the assignment after the student submitted.
    let work = match &assignment {
        Some(assignment) if is_own && !member.is_staff => Some(OwnWork::read(&member, assignment).await?),
        _ => None,
    };
    let attempts = match (&work, &assignment) {
        (Some(work), _) => work.submissions.clone(),
        (None, Some(_)) => member.attempts(&submission).await?,
        (None, None) => Vec::new(),
    };
    let changes = member.attempt_changes(&attempts).await?;
    render(&SubmissionPage {
        attempts: attempts.into_iter().rev().collect(),
        frame: submission_frame(&member, assignment.as_ref(), &submission),
        is_own,
        work,
        is_pending: matches!(submission.state.as_str(), "waiting" | "running"),
        history: member.history(id).await?,
        change: changes.get(&id).map(scenes::describe_change),
        page,
        report,
        hidden,
        submission,
        member,
    })
}

/// Returns the file name of the report that a submission's page shows. Staff see their own report, if there is one.
fn report_page(submission: &Submission) -> Option<&'static str> {
    let files = submission.grade.iter().flat_map(|grade| &grade.files);
    let names: Vec<&str> = files.map(|file| file.name.as_str()).collect();
    [STAFF_PAGE, PUBLISHED_PAGE, "report.html"].into_iter().find(|name| names.contains(name))
}

actions! {
    grade_again(staff: Staff, { course, id }): staff.grade_again(id) => "/c/{course}/s/{id}";
}
