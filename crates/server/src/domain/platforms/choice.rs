//! Choices that staff make when they come from a learning platform: which course on this server belongs to the
//! platform's course, and which assignment a link opens.
use crate::domain::{
    Member, Person,
    platforms::launch,
    roles::admin,
    view::{self, Assignment, Course, LogEntry},
};
use crate::{
    db::DbError,
    lti::{self, LtiRole},
    problem::{Problem, ensure},
    values,
};

/// The choice that staff must make: a course or an assignment.
#[derive(Debug, Clone)]
pub enum LinkTarget {
    /// Choose the course: one of the person's courses, or a new one.
    Course {
        /// The name of the platform.
        platform: String,
        /// The title of the course or link on the platform.
        title: String,
        /// The proposed name for a new course.
        slug: String,
        /// The person's courses, of which one can be chosen.
        courses: Vec<Course>,
    },
    /// Choose the assignment that a link opens.
    Assignment {
        /// The course of the assignment.
        course: Course,
        /// The title of the link on the platform.
        title: Option<String>,
        /// The assignments of the course.
        assignments: Vec<Assignment>,
    },
}

/// The next step after an assignment was chosen.
#[derive(Debug, Clone)]
pub enum LinkStep {
    /// Redirect to an assignment, given by its path.
    Assignment(String),
    /// Send a form to the platform.
    Answer {
        /// The platform's URL to which the form is sent.
        address: String,
        /// The platform's origins. The page may send forms to them, and they may redirect to each other.
        origins: String,
        /// The signed answer, which the form contains.
        token: String,
    },
}

impl Person {
    /// Returns the choices that belong to a secret.
    ///
    /// # Errors
    ///
    /// Fails if the secret is unknown, or belongs to another person.
    pub async fn choice(&self, secret: &str) -> Result<LinkTarget, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let pending = launch::find_pending_launch(&mut transaction, self.account.id, secret).await?;
        let Some(course) = launch::find_course(&mut transaction, pending.platform.id, &pending.arrival).await? else {
            let context = &pending.arrival.context;
            let title = context.title.clone().or(context.label.clone()).unwrap_or_else(|| context.id.clone());
            let title: String = title.chars().filter(|c| !c.is_control()).take(200).collect();
            let slug = propose_slug(context.label.as_deref().unwrap_or(&title));
            let statement = "SELECT course.slug, course.title FROM course
                JOIN member ON member.course = course.id AND member.account = ? AND member.role = 'staff'
                ORDER BY course.slug";
            let courses = transaction.all(statement, values![self.account.id]).await?;
            return Ok(LinkTarget::Course {
                platform: pending.platform.name,
                title: title.trim().to_owned(),
                slug,
                courses,
            });
        };
        let statement = "SELECT id, slug, title, visible, settings, published_at, revision FROM assignment
            WHERE course = ? ORDER BY id";
        let assignments = transaction.all(statement, values![course.course]).await?;
        Ok(LinkTarget::Assignment {
            course: Course { slug: course.slug, title: course.title },
            title: pending.arrival.resource.and_then(|resource| resource.title),
            assignments,
        })
    }

    /// Connects the platform's course to a course of the person, or to a new one.
    ///
    /// # Errors
    ///
    /// Fails if there is no such course, or the name for the new course is taken.
    pub async fn choose_course(&self, secret: &str, existing: Option<&str>, new: (&str, &str)) -> Result<(), Problem> {
        let mut transaction = self.app.0.database.begin().await?;
        let pending = launch::find_pending_launch(&mut transaction, self.account.id, secret).await?;
        if launch::find_course(&mut transaction, pending.platform.id, &pending.arrival).await?.is_some() {
            return Ok(());
        }
        let course = match existing {
            Some(slug) => {
                let statement = "SELECT course.id FROM course
                    JOIN member ON member.course = course.id AND member.account = ? AND member.role = 'staff'
                    WHERE course.slug = ?";
                let found = transaction.row(statement, values![self.account.id, slug]).await?;
                found.ok_or_else(|| Problem::not_found("course"))?.int("id")?
            }
            None => admin::make_course(&mut transaction, new).await?,
        };
        let arrival = &pending.arrival;
        let title = arrival.context.title.as_deref().unwrap_or(&arrival.context.id);
        let statement =
            "INSERT INTO platform_course (platform, deployment, context, title, course, memberships, created_at)
            VALUES (?, ?, ?, ?, ?, ?, {now}) RETURNING id";
        let (platform, memberships) = (pending.platform.id, arrival.memberships.as_deref());
        let values = values![platform, &arrival.deployment, &arrival.context.id, title, course, memberships];
        let platform_course = transaction.one(statement, values).await?.int("id")?;
        // The session was started by a launch from the platform. If the account was a student's, its other sessions
        // have ended.
        let statement = "INSERT INTO platform_member (platform_course, account) VALUES (?, ?)
            ON CONFLICT (platform_course, account) DO NOTHING";
        transaction.execute(statement, values![platform_course, self.account.id]).await?;
        let statement = "INSERT INTO member (course, account, role, platform, created_at) VALUES (?, ?, ?, ?, {now})
            ON CONFLICT (course, account) DO NOTHING";
        transaction.execute(statement, values![course, self.account.id, LtiRole::Staff.name(), platform]).await?;
        let text = format!("linked to the course {} on {}", arrival.context.id, pending.platform.name);
        let entry = LogEntry { course: Some(course), ..LogEntry::new("platform", self.account.id, &text) };
        view::log_event(&mut transaction, &entry).await?;
        Ok(transaction.commit().await?)
    }

    /// Makes the link open this assignment. If the platform requested a link, the signed answer is returned.
    ///
    /// # Errors
    ///
    /// Fails if the person does not teach the course, or it has no such assignment.
    pub async fn choose_assignment(&self, secret: &str, slug: &str) -> Result<LinkStep, Problem> {
        let mut transaction = self.app.0.database.begin().await?;
        let pending = launch::find_pending_launch(&mut transaction, self.account.id, secret).await?;
        let known_course = launch::find_course(&mut transaction, pending.platform.id, &pending.arrival).await?;
        let known_course = known_course.ok_or_else(|| Problem::not_found("course"))?;
        let statement = "SELECT account FROM member WHERE course = ? AND account = ? AND role = 'staff'";
        let staff = transaction.row(statement, values![known_course.course, self.account.id]).await?;
        ensure(staff.is_some(), Problem::not_allowed("only the course's staff can do this"))?;
        let statement = "SELECT id, slug, title, visible, settings, published_at, revision FROM assignment
                WHERE course = ? AND slug = ?";
        let found: Option<Assignment> = transaction.find(statement, values![known_course.course, slug]).await?;
        let assignment = found.ok_or_else(|| Problem::not_found("assignment"))?;
        let arrival = &pending.arrival;
        let text = format!("linked {} from {}", assignment.slug, pending.platform.name);
        let (course, assignment_id) = (Some(known_course.course), Some(assignment.id));
        let entry = LogEntry::new("platform", self.account.id, &text);
        view::log_event(&mut transaction, &LogEntry { course, assignment: assignment_id, ..entry }).await?;
        let Some(wanted) = &arrival.deep_linking else {
            let resource = arrival.resource.as_ref().ok_or_else(Problem::fault)?;
            let link = launch::make_link(&mut transaction, known_course.id, &resource.id, assignment.id).await?;
            launch::store_score_columns(&mut transaction, link, arrival).await?;
            transaction.commit().await?;
            return Ok(LinkStep::Assignment(format!("/c/{}/a/{}#done", known_course.slug, assignment.slug)));
        };
        transaction.commit().await?;
        let allows_http = self.app.lti.allows_http();
        let Some(address) = pending.platform.parse_registered_url(&wanted.deep_link_return_url, allows_http) else {
            return Err(Problem::rejected_launch("the platform's return URL is on a host that is not configured"));
        };
        let (launch, item) = (self.app.launch_address(), (assignment.slug.as_str(), assignment.title.as_str()));
        let token = lti::deep_linking_response(&self.app.0.database, &pending.platform, arrival, &launch, item).await?;
        let origins = pending.platform.origins(allows_http);
        Ok(LinkStep::Answer { address: address.into(), origins, token })
    }
}

/// Returns a name for URLs that is made from a title.
pub fn propose_slug(title: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let text: String = title.chars().map(plain).take(60).collect();
    text.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
}

impl Member {
    /// Returns the platforms that are connected with this course.
    ///
    /// # Errors
    ///
    /// Fails if the database does not answer.
    pub async fn platforms(&self) -> Result<Vec<String>, Problem> {
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT DISTINCT platform.name FROM platform_course
            JOIN platform ON platform.id = platform_course.platform AND platform.disabled_at IS NULL
            WHERE platform_course.course = ? ORDER BY platform.name";
        let rows = transaction.rows(statement, values![self.course]).await?;
        Ok(rows.iter().map(|row| row.text("name")).collect::<Result<_, DbError>>()?)
    }
}
