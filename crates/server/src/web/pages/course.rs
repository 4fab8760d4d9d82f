//! The pages of a course: its assignments, its members, its queue, and its audit log.
use super::{
    super::input::{Fields, QueryInput, SeenEvent, UrlPathParts},
    Page, PageFrame, render, text,
};
use crate::{
    domain::{
        Assignment, AssignmentChange, Event, EventQuery, Member, MemberInfo, Overview, Queue, Settings, Staff,
        Submission,
    },
    late_policy::Lateness,
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
    assignments: Vec<AssignmentRow>,
    /// Sentences about the space for uploads.
    storage_notes: Vec<String>,
}

/// An assignment as a row in its course's table.
pub(super) struct AssignmentRow {
    pub(super) assignment: Assignment,
    pub(super) work: OwnWork,
    /// The numbers about the class; `None` for students.
    pub(super) overview: Option<Overview>,
}

impl AssignmentRow {
    /// Returns whether no worker is connected that could grade submissions. For students it always returns false.
    pub(super) fn lacks_worker(&self) -> bool {
        self.overview.as_ref().is_some_and(|overview| overview.slots == 0)
    }

    /// Returns whether the assignment still accepts submissions.
    pub(super) fn is_open(&self) -> bool {
        if self.overview.is_some() { !self.work.is_closed } else { self.work.is_open() }
    }
}

/// A student's submissions to an assignment, and what the student may still submit.
pub(super) struct OwnWork {
    /// The student's due date, in milliseconds since 1970.
    pub(super) due: Option<i64>,
    /// Whether the due date has passed.
    pub(super) is_late: bool,
    /// The delay that a submission would have now, and the points that it would cost.
    pub(super) delay: Option<Lateness>,
    /// The time until which late submissions are accepted, in milliseconds since 1970.
    pub(super) closes_at: Option<i64>,
    /// Whether no submissions are accepted, not even late ones.
    pub(super) is_closed: bool,
    /// The number of submissions that the student may still make; `None` if it is not limited.
    pub(super) attempts_left: Option<usize>,
    /// All submissions of the student, newest first.
    pub(super) submissions: Vec<Submission>,
    /// The student's submission with the most points; on a tie, the latest.
    pub(super) best: Option<Submission>,
}

impl OwnWork {
    pub(super) async fn read(member: &Member, assignment: &Assignment) -> Result<Self, Problem> {
        let due = member.due_date(assignment).await?;
        let submissions = member.submissions(&assignment.slug).await?;
        let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_millis());
        let now = i64::try_from(now).unwrap_or(i64::MAX);
        let has_passed = |at: Option<i64>| at.is_some_and(|at| at < now);
        let policy = assignment.settings.late_policy();
        let closes_at = due.map(|due| policy.closes_at(due));
        let attempts = assignment.settings.attempts as usize;
        let points = |submission: &Submission| submission.grade.as_ref()?.points.as_ref()?.parse::<f64>().ok();
        let graded_submissions =
            submissions.iter().rev().filter_map(|submission| Some((points(submission)?, submission)));
        let best = graded_submissions.max_by(|(one, _), (other, _)| one.total_cmp(other)).map(|(_, one)| one.clone());
        Ok(Self {
            due,
            is_late: has_passed(due),
            delay: policy.lateness(due, now),
            closes_at,
            is_closed: has_passed(closes_at),
            attempts_left: (attempts > 0).then(|| attempts.saturating_sub(submissions.len())),
            submissions,
            best,
        })
    }

    /// Returns whether students may submit to the assignment now.
    pub(super) fn is_open(&self) -> bool {
        !self.is_closed && self.attempts_left != Some(0)
    }
}

#[derive(Template)]
#[template(path = "members.html")]
struct MembersPage {
    frame: PageFrame,
    slug: String,
    members: Vec<MemberInfo>,
    students: usize,
    staff_count: usize,
    filter: People,
    /// The URL of the next page of members; `None` on the last page.
    after: Option<String>,
    platforms: Vec<String>,
    /// The ID of the course's newest event when the page was rendered. Each form sends it with the change, to
    /// detect conflicts.
    seen_event: i64,
    /// The login of the person whom the last request changed, and a sign-in link if one was created.
    update: Option<(String, Option<String>)>,
}

#[derive(Template)]
#[template(path = "audit.html")]
struct AuditPage {
    frame: PageFrame,
    events: Vec<Event>,
    query: EventQuery,
}

#[derive(Template)]
#[template(path = "queue.html")]
struct QueuePage {
    frame: PageFrame,
    queue: Queue,
}

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
    /// The ID of the newest event when the page was rendered. The form sends it with the change, to detect conflicts.
    #[serde(rename = "seen")]
    seen_event: Option<i64>,
}

/// Returns the assignments of a course as rows of its table.
pub(super) async fn read_rows(member: &Member) -> Result<Vec<AssignmentRow>, Problem> {
    let mut rows = Vec::new();
    for assignment in member.assignments().await? {
        let (work, overview) = (OwnWork::read(member, &assignment).await?, member.overview(&assignment).await?);
        rows.push(AssignmentRow { assignment, work, overview });
    }
    Ok(rows)
}

pub(super) async fn show_course(member: Member) -> Page {
    let assignments = read_rows(&member).await?;
    let address = format!("/c/{}", member.slug);
    let (frame, storage_notes) =
        (PageFrame::course(&member).with_parent(address, &member.title), member.describe_storage().await?);
    render(&CoursePage { frame, member, assignments, storage_notes })
}

/// Creates an assignment that students cannot see yet, with a suite of the grader.
pub(super) async fn create_assignment(staff: &Staff, slug: &str, title: &str, suite: &str) -> Result<(), Problem> {
    if staff.assignments().await?.iter().any(|assignment| assignment.slug == slug) {
        return Err(Problem::conflict("an assignment with this name already exists", "give it another name"));
    }
    let change = AssignmentChange { title: Some(title), visible: Some(false), ..AssignmentChange::default() };
    let settings = |before: &Settings| Ok(Settings { suite: suite.to_owned(), ..before.clone() });
    staff.set_assignment(slug, change, settings).await.map(drop)
}

/// The filter of a list of people: text in the login or name, and a role in the course. The page begins after the login
/// `after`.
#[derive(Default, Deserialize)]
pub(super) struct People {
    #[serde(default)]
    pub(super) q: String,
    #[serde(default)]
    role: String,
    #[serde(default)]
    pub(super) after: String,
}

/// The number of members that a page shows.
const PEOPLE_PER_PAGE: usize = 200;

impl People {
    /// Returns whether a member matches the filter, and follows the last member of the preceding page.
    fn includes(&self, member: &MemberInfo) -> bool {
        let search = self.q.trim().to_lowercase();
        let matches_search = member.login.contains(&search) || member.name.to_lowercase().contains(&search);
        matches_search && (self.role.is_empty() || member.role == self.role) && member.login > self.after
    }

    /// Returns the URL of the next page, which begins after the login `last`; `None` on the last page.
    pub(super) fn next(&self, last: Option<&str>) -> Option<String> {
        let mut query = url::form_urlencoded::Serializer::for_suffix("?".to_owned(), 1);
        Some(query.append_pair("q", &self.q).append_pair("role", &self.role).append_pair("after", last?).finish())
    }
}

async fn render_members(staff: &Staff, filter: People, update: Option<(String, Option<String>)>) -> Page {
    let slug = staff.slug.clone();
    let frame = PageFrame::course(staff).with_parent(format!("/c/{slug}/members"), "Members");
    // Read the ID of the newest event before the members, so that later changes are detected.
    let seen_event = staff.last_event().await?;
    let mut members = staff.members().await?;
    let staff_count = members.iter().filter(|member| member.role == "staff").count();
    let students = members.len() - staff_count;
    members.retain(|member| filter.includes(member));
    // The database may sort logins differently from this program.
    members.sort_by(|one, other| one.login.cmp(&other.login));
    let has_more = members.len() > PEOPLE_PER_PAGE;
    members.truncate(PEOPLE_PER_PAGE);
    let after = filter.next(members.last().filter(|_| has_more).map(|last| last.login.as_str()));
    let platforms = staff.platforms().await?;
    render(&MembersPage { frame, slug, members, students, staff_count, filter, after, platforms, seen_event, update })
}

pub(super) async fn show_members(staff: Staff, QueryInput(query): QueryInput<People>) -> Page {
    render_members(&staff, query, None).await
}

pub(super) async fn set_member(staff: Staff, Fields(form): Fields<NewMember>) -> Page {
    let login = form.login.trim();
    let link = staff.set_member(login, form.name.trim(), &form.role, form.seen_event).await?.link;
    render_members(&staff, People::default(), Some((login.to_owned(), link))).await
}

pub(super) async fn member_link(staff: Staff, UrlPathParts { login, .. }: UrlPathParts) -> Page {
    let link = staff.new_link(&login).await?.link;
    render_members(&staff, People::default(), Some((login, link))).await
}

pub(super) async fn show_audit(staff: Staff, QueryInput(query): QueryInput<EventQuery>) -> Page {
    let frame = PageFrame::course(&staff).with_parent(format!("/c/{}/audit", staff.slug), "Audit log");
    render(&AuditPage { frame, events: staff.audit(&query).await?, query })
}

pub(super) async fn show_queue(staff: Staff) -> Page {
    let frame = PageFrame::course(&staff).with_parent(format!("/c/{}/queue", staff.slug), "Queue");
    render(&QueuePage { frame, queue: staff.queue().await? })
}

actions! {
    new_assignment(staff: Staff, form: NewAssignment):
        create_assignment(&staff, form.slug.trim(), form.title.trim(), "")
        => "/c/{}/a/{}/settings", staff.slug, form.slug.trim();
    remove_member(staff: Staff, { course, login }, form: SeenEvent):
        staff.remove_member(&login, form.event()) => "/c/{course}/members";
}
