//! A course: its assignments, members, queue and audit log.
use super::{
    super::input::{Asked, At, Before, Fields},
    Page, PageFrame, see, show, text,
};
use crate::{
    access::{Assignment, Event, Member, MemberInfo, Overview, Queue, Settings, Staff, Submission},
    problem::Problem,
};
use askama::Template;
use axum::response::Redirect;
use serde::Deserialize;
use std::time::{SystemTime, UNIX_EPOCH};

#[derive(Template)]
#[template(path = "course.html")]
struct CoursePage {
    frame: PageFrame,
    member: Member,
    assignments: Vec<Row>,
}

/// An assignment in the table of its course.
struct Row {
    assignment: Assignment,
    work: OwnWork,
    /// How the class stands, for staff.
    overview: Option<Overview>,
}

/// The work of a member in an assignment, and how much they may still do.
pub(super) struct OwnWork {
    /// Until when they may hand in.
    pub(super) due: Option<i64>,
    /// Whether that has passed.
    pub(super) is_late: bool,
    /// Whether nothing is taken any more, not even late.
    pub(super) is_over: bool,
    /// How often they may still hand in, where that is limited.
    pub(super) left: Option<usize>,
    /// All that they handed in, newest first.
    pub(super) submissions: Vec<Submission>,
    /// The submission with the most points, the later one of equals.
    pub(super) best: Option<Submission>,
}

impl OwnWork {
    pub(super) async fn of(member: &Member, assignment: &Assignment) -> Result<Self, Problem> {
        let due = member.due(assignment).await?;
        let submissions = member.submissions(&assignment.slug).await?;
        let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_millis());
        let late = u128::from(assignment.settings.late_days) * 86_400_000;
        let passed = |late: u128| due.is_some_and(|due| u128::try_from(due).is_ok_and(|due| due + late < now));
        let attempts = assignment.settings.attempts as usize;
        let points = |one: &Submission| one.grade.as_ref()?.points.as_ref()?.parse::<f64>().ok();
        let graded = submissions.iter().rev().filter_map(|one| Some((points(one)?, one)));
        let best = graded.max_by(|(one, _), (other, _)| one.total_cmp(other)).map(|(_, one)| one.clone());
        Ok(Self {
            due,
            is_late: passed(0),
            is_over: passed(late),
            left: (attempts > 0).then(|| attempts.saturating_sub(submissions.len())),
            submissions,
            best,
        })
    }

    /// Whether they may hand in now.
    pub(super) fn is_open(&self) -> bool {
        !self.is_over && self.left != Some(0)
    }
}

#[derive(Template)]
#[template(path = "members.html")]
struct MembersPage {
    frame: PageFrame,
    slug: String,
    members: Vec<MemberInfo>,
    platforms: Vec<String>,
    /// A link to be handed on: to whom, what it is, and its address.
    link: Option<(String, &'static str, String)>,
}

#[derive(Template)]
#[template(path = "audit.html")]
struct AuditPage {
    frame: PageFrame,
    slug: String,
    events: Vec<Event>,
}

#[derive(Template)]
#[template(path = "queue.html")]
struct QueuePage {
    frame: PageFrame,
    queue: Queue,
}

const SIGNS_IN: &str = "a link that signs in once, good for a week";
const INVITES: &str = "an invitation: they have an account, and accept by this link, signed in as ever";

#[derive(Deserialize)]
pub(super) struct NewAssignment {
    slug: String,
    title: String,
}

#[derive(Deserialize)]
pub(super) struct NewMember {
    login: String,
    name: String,
    role: String,
}

pub(super) async fn course(member: Member) -> Page {
    let mut assignments = Vec::new();
    for assignment in member.assignments().await? {
        let (work, overview) = (OwnWork::of(&member, &assignment).await?, member.overview(&assignment).await?);
        assignments.push(Row { assignment, work, overview });
    }
    show(&CoursePage { frame: PageFrame::course(&member), member, assignments })
}

pub(super) async fn new_assignment(staff: Staff, Fields(form): Fields<NewAssignment>) -> Result<Redirect, Problem> {
    let slug = form.slug.trim();
    if staff.assignments().await?.iter().any(|assignment| assignment.slug == slug) {
        return Err(Problem::conflict("there is an assignment of this name", "give it another name"));
    }
    staff.set_assignment(slug, form.title.trim(), Some(false), Some(&Settings::default())).await?;
    Ok(see(&format!("/c/{}/a/{slug}/settings", staff.slug)))
}

async fn members_page(staff: &Staff, link: Option<(String, &'static str, String)>) -> Page {
    let slug = staff.slug.clone();
    let frame = PageFrame::course(staff).then(format!("/c/{slug}/members"), "Members");
    show(&MembersPage { frame, slug, members: staff.members().await?, platforms: staff.platforms().await?, link })
}

pub(super) async fn members(staff: Staff) -> Page {
    members_page(&staff, None).await
}

pub(super) async fn set_member(staff: Staff, Fields(form): Fields<NewMember>) -> Page {
    let login = form.login.trim();
    let links = staff.set_member(login, form.name.trim(), &form.role).await?;
    let (signs_in, invites) = (links.link.map(|link| (SIGNS_IN, link)), links.invitation.map(|link| (INVITES, link)));
    members_page(&staff, signs_in.or(invites).map(|(what, link)| (login.to_owned(), what, link))).await
}

pub(super) async fn member_link(staff: Staff, At { login, .. }: At) -> Page {
    let link = staff.new_link(&login).await?.link;
    members_page(&staff, link.map(|link| (login, SIGNS_IN, link))).await
}

pub(super) async fn audit(staff: Staff, Asked(asked): Asked<Before>) -> Page {
    let slug = staff.slug.clone();
    let frame = PageFrame::course(&staff).then(format!("/c/{slug}/audit"), "Audit log");
    show(&AuditPage { frame, slug, events: staff.audit(asked.before).await? })
}

pub(super) async fn queue(staff: Staff) -> Page {
    let frame = PageFrame::course(&staff).then(format!("/c/{}/queue", staff.slug), "Queue");
    show(&QueuePage { frame, queue: staff.queue().await? })
}

deeds! {
    remove_member(staff: Staff, { course, login }): staff.remove_member(&login) => "/c/{course}/members";
    grade_errors_again(staff: Staff, { course }): staff.grade_errors_again(None) => "/c/{course}/queue";
}
