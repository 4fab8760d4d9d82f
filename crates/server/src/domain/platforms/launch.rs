//! Launches from a learning platform. The service requests the person's identity from the platform (SEC 5.1.1), accepts
//! one answer, and signs the person in with their account on this server. Then it opens the page of the course that is
//! linked to the platform's course.
use crate::domain::{
    App, NewSecret, Visitor,
    accounts::{
        identity::{self, SignInMethod},
        newcomer::Newcomer,
        pending_sign_in::{StartedSignIn, UNKNOWN_SIGN_IN},
    },
    view::{self, LogEntry},
};
use crate::{
    db::{DbError, FromRow, Transaction, from_row},
    lti::{Arrival, LtiPerson, LtiRole, Message, Platform, Rejection, score},
    problem::{Problem, ensure},
    values,
};
use serde::Deserialize;
use url::Url;

/// The time within which staff must choose, in milliseconds.
const CHOICE_LIFETIME: i64 = 3600 * 1000;

/// A platform's message about a person who wants to sign in (LTI 4.1, SEC 5.1.1.1).
#[derive(Debug, Clone, Deserialize)]
pub struct LoginRequest {
    /// The platform's issuer.
    pub iss: String,
    /// Text about the person, which the service returns to the platform unchanged.
    pub login_hint: String,
    /// The page that the person wants to open.
    pub target_link_uri: Option<String>,
    /// Text about the message, which the service returns to the platform unchanged.
    pub lti_message_hint: Option<String>,
    /// The client ID of this service on the platform, if the platform sent it.
    pub client_id: Option<String>,
    /// The ID of this service's deployment on the platform.
    pub lti_deployment_id: Option<String>,
}

/// A redirect to the service at which the person signs in.
#[derive(Debug, Clone)]
pub struct LoginAnswer {
    /// The URL to which the browser is redirected.
    pub address: String,
    /// The secret that the browser stores as a cookie, and must send when it returns.
    pub browser: String,
}

/// The page that opens after a launch.
#[derive(Debug, Clone)]
pub struct LaunchTarget {
    /// The secret of the session that begins.
    pub session: NewSecret,
    /// The path of the page on this service.
    pub path: String,
}

impl From<Rejection> for Problem {
    fn from(refused: Rejection) -> Self {
        match &refused {
            Rejection::Deployment(_) => {
                Self::rejected_until(refused.to_string(), "ask the server's administrator to add this deployment")
            }
            _ => Self::rejected_launch(refused.to_string()),
        }
    }
}

impl App {
    /// Checks that this service can be launched from platforms: browsers must send its cookies with requests from
    /// another site.
    fn check_launchable(&self) -> Result<(), Problem> {
        if self.is_secure() || self.lti.allows_http() {
            return Ok(());
        }
        let remedy = "start the server with --public-url https://...";
        Err(Problem::conflict("learning platforms can be used only over HTTPS", remedy))
    }

    /// Returns the URL on this service to which platforms send people.
    pub fn launch_address(&self) -> String {
        format!("{}/lti/launch", self.public)
    }
}

impl Visitor {
    /// Returns the platform that a sign-in request names.
    ///
    /// # Errors
    ///
    /// Fails if no platform with this name is registered.
    pub async fn platform(&self, request: &LoginRequest) -> Result<Platform, Problem> {
        self.app.check_launchable()?;
        let mut transaction = self.app.0.database.read().await?;
        let statement = "SELECT id, name, settings FROM platform
            WHERE issuer = ? AND disabled_at IS NULL AND (CAST(? AS TEXT) IS NULL OR client = ?) ORDER BY id LIMIT 2";
        let client = request.client_id.as_deref();
        let rows = transaction.rows(statement, values![&request.iss, client, client]).await?;
        match rows.as_slice() {
            [row] => Ok(Platform::from_row(row)?),
            [] => Err(Problem::rejected_launch("no administrator has registered this platform")),
            _ => Err(Problem::rejected_launch("the platform has several registrations, and sent no client ID")),
        }
    }

    /// Begins a sign-in, and returns the URL to which the browser is redirected.
    ///
    /// # Errors
    ///
    /// Fails if there are too many sign-ins, or the database does not answer.
    pub async fn begin_login(&self, platform: &Platform, request: &LoginRequest) -> Result<LoginAnswer, Problem> {
        let browser = (&self.secrets, self.secrets.platform_secret.as_ref());
        let StartedSignIn { state, browser } =
            self.app.begin_sign_in(&platform.id.to_string(), browser, (0, "")).await?;
        let nonce = self.app.compute_secret("nonce", &state).await?;
        let settings = &platform.settings;
        let mut address = Url::parse(&settings.login_url).map_err(|_| Problem::fault())?;
        address
            .query_pairs_mut()
            .append_pair("scope", "openid")
            .append_pair("response_type", "id_token")
            .append_pair("response_mode", "form_post")
            .append_pair("prompt", "none")
            .append_pair("client_id", &settings.client_id)
            .append_pair("redirect_uri", &self.app.launch_address())
            .append_pair("login_hint", &request.login_hint)
            .append_pair("state", &state)
            .append_pair("nonce", &nonce);
        if let Some(hint) = &request.lti_message_hint {
            address.query_pairs_mut().append_pair("lti_message_hint", hint);
        }
        Ok(LoginAnswer { address: address.into(), browser })
    }

    /// Signs in the person whom a platform names. `state` must belong to a sign-in that this browser
    /// began and that is not used yet.
    ///
    /// # Errors
    ///
    /// Fails if the answer does not belong to such a sign-in or platform, or the person may not sign in this way.
    pub async fn launch(&self, state: &str, token: &str) -> Result<LaunchTarget, Problem> {
        let pending =
            self.app.pending_sign_in(state, self.secrets.platform_secret.as_ref(), Problem::rejected_launch).await?;
        let statement = "SELECT id, name, settings FROM platform WHERE id = ? AND disabled_at IS NULL";
        let number: i64 = pending.service.parse().unwrap_or_default();
        let platform = self.app.0.database.read().await?.find(statement, values![number]).await?;
        let platform: Platform = platform.ok_or_else(|| Problem::rejected_launch(UNKNOWN_SIGN_IN))?;
        let nonce = identity::digest(&self.app.compute_secret("nonce", state).await?);
        let message = self.app.lti.receive(&platform, token, &nonce).await?;
        let Some(role) = message.person.role else {
            let detail = "the platform says that you neither learn nor teach in this course";
            return Err(Problem::rejected_until(detail, "ask the course's teacher there to make you a student"));
        };
        let mut transaction = self.app.0.database.begin().await?;
        ensure(pending.mark_used(&mut transaction).await?, Problem::rejected_launch(UNKNOWN_SIGN_IN))?;
        let launched = accept_launch(&mut transaction, &platform, &message, role).await?;
        self.app.0.notifier.commit(transaction).await?;
        Ok(launched)
    }
}

/// A course of a platform, and the course on this server that belongs to it.
pub(in crate::domain) struct KnownCourse {
    pub(in crate::domain) id: i64,
    pub(in crate::domain) course: i64,
    pub(in crate::domain) slug: String,
    pub(in crate::domain) title: String,
}

from_row! { KnownCourse { id, course, slug, title } }

/// Returns the course on this server that belongs to the platform's course from which a person comes.
pub(in crate::domain) async fn find_course(
    transaction: &mut Transaction,
    platform: i64,
    arrival: &Arrival,
) -> Result<Option<KnownCourse>, DbError> {
    let statement = "SELECT platform_course.id, platform_course.course, course.slug, course.title FROM platform_course
        JOIN course ON course.id = platform_course.course
        WHERE platform_course.platform = ? AND platform_course.deployment = ? AND platform_course.context = ?";
    transaction.find(statement, values![platform, &arrival.deployment, &arrival.context.id]).await
}

/// Finds or creates the person's account, updates the person's role, and returns the page that opens.
async fn accept_launch(
    transaction: &mut Transaction,
    platform: &Platform,
    message: &Message,
    role: LtiRole,
) -> Result<LaunchTarget, Problem> {
    let arrival = &message.arrival;
    let staff = role == LtiRole::Staff;
    let Some(KnownCourse { id, course, slug, .. }) = find_course(transaction, platform.id, arrival).await? else {
        let detail = "this course is not connected with the grading server yet";
        ensure(
            staff,
            Problem::rejected_until(detail, "ask your teacher to open this link once, and then open it again"),
        )?;
        let account = resolve(transaction, platform, &message.person).await?;
        return choose(transaction, platform, arrival, account).await;
    };
    let account = resolve(transaction, platform, &message.person).await?;
    if let Some(memberships) = &arrival.memberships {
        let statement = "UPDATE platform_course SET memberships = ? WHERE id = ?";
        transaction.execute(statement, values![memberships, id]).await?;
    }
    enroll(transaction, platform.id, id, course, account, role).await?;
    let Some(resource) = &arrival.resource else {
        ensure(staff, Problem::rejected_launch("only teachers of the course can create links"))?;
        return choose(transaction, platform, arrival, account).await;
    };
    let statement = "SELECT platform_link.id, assignment.slug FROM platform_link
        JOIN assignment ON assignment.id = platform_link.assignment
        WHERE platform_link.platform_course = ? AND platform_link.resource = ?";
    let link = transaction.row(statement, values![id, &resource.id]).await?;
    let link = match link {
        Some(link) => Some((link.int("id")?, link.text("slug")?)),
        None => find_named_assignment(transaction, id, course, arrival).await?,
    };
    match link {
        Some((link, assignment)) => {
            store_score_columns(transaction, link, arrival).await?;
            if !staff {
                score::queue_arrival_score(transaction, link, account).await?;
            }
            let session = identity::begin_session(transaction, account, SignInMethod::Own).await?;
            Ok(LaunchTarget { session, path: format!("/c/{slug}/a/{assignment}") })
        }
        None if staff => choose(transaction, platform, arrival, account).await,
        None => Err(Problem::rejected_until(
            "no assignment was chosen for this link yet",
            "ask your teacher to open this link once, then open it again",
        )),
    }
}

/// Returns the assignment that the link itself names. Staff chose it by deep linking, or wrote it into the link.
async fn find_named_assignment(
    transaction: &mut Transaction,
    platform_course: i64,
    course: i64,
    arrival: &Arrival,
) -> Result<Option<(i64, String)>, DbError> {
    let (Some(slug), Some(resource)) = (&arrival.assignment, &arrival.resource) else { return Ok(None) };
    let found =
        transaction.row("SELECT id FROM assignment WHERE course = ? AND slug = ?", values![course, slug]).await?;
    let Some(found) = found else { return Ok(None) };
    let link = make_link(transaction, platform_course, &resource.id, found.int("id")?).await?;
    Ok(Some((link, slug.clone())))
}

/// Stores that a link opens an assignment.
pub(in crate::domain) async fn make_link(
    transaction: &mut Transaction,
    platform_course: i64,
    resource: &str,
    assignment: i64,
) -> Result<i64, DbError> {
    let statement =
        "INSERT INTO platform_link (platform_course, resource, assignment, created_at) VALUES (?, ?, ?, {now})
        ON CONFLICT (platform_course, resource) DO UPDATE SET assignment = excluded.assignment RETURNING id";
    transaction.one(statement, values![platform_course, resource, assignment]).await?.int("id")
}

/// Stores the score columns of a link, as the platform's message names them. A column that this service created is
/// kept.
pub(in crate::domain) async fn store_score_columns(
    transaction: &mut Transaction,
    link: i64,
    arrival: &Arrival,
) -> Result<(), DbError> {
    let statement =
        "UPDATE platform_link SET line_item = coalesce(CAST(? AS TEXT), line_item), line_items = ? WHERE id = ?";
    transaction.execute(statement, values![arrival.line_item.clone(), arrival.line_items.clone(), link]).await.map(drop)
}

/// Signs staff in, and asks them to choose a course, an assignment, or a link.
async fn choose(
    transaction: &mut Transaction,
    platform: &Platform,
    arrival: &Arrival,
    account: i64,
) -> Result<LaunchTarget, Problem> {
    let secret = NewSecret::new("");
    let text = serde_json::to_string(arrival).map_err(|_| Problem::fault())?;
    let expired = "DELETE FROM platform_choice
        WHERE digest IN (SELECT digest FROM platform_choice WHERE expires_at < {now} {skip locked})";
    transaction.execute(expired, values![]).await?;
    let statement =
        "INSERT INTO platform_choice (digest, account, platform, arrival, expires_at) VALUES (?, ?, ?, ?, {now} + ?)";
    transaction.execute(statement, values![secret.digest(), account, platform.id, text, CHOICE_LIFETIME]).await?;
    // The choice could make a student's account staff.
    if !identity::is_trusted(transaction, account).await? {
        identity::end_all_access(transaction, account).await?;
    }
    let session = identity::begin_session(transaction, account, SignInMethod::Own).await?;
    Ok(LaunchTarget { session, path: format!("/lti/choose/{}", secret.reveal()) })
}

async fn resolve(transaction: &mut Transaction, platform: &Platform, person: &LtiPerson) -> Result<i64, Problem> {
    let account = find_or_make(transaction, platform, person).await?;
    let row = transaction.one("SELECT is_admin, disabled_at FROM account WHERE id = ?", values![account]).await?;
    ensure(row.maybe_int("disabled_at")?.is_none(), Problem::rejected_launch("your account here is closed"))?;
    // Without this check, the owner of any registered platform could act as an administrator here.
    ensure(
        !row.flag("is_admin")?,
        Problem::rejected_launch("you are an administrator of this server: sign in on its own pages"),
    )?;
    Ok(account)
}

/// Finds a person's account, or creates it with the name that the platform reports.
pub(in crate::domain) async fn find_or_make(
    transaction: &mut Transaction,
    platform: &Platform,
    person: &LtiPerson,
) -> Result<i64, DbError> {
    let newcomer = Newcomer {
        issuer: &platform.settings.issuer,
        subject: &person.subject,
        name: person.name.as_deref(),
        nickname: person.email.as_deref(),
    };
    newcomer.find_or_make(transaction).await
}

/// Makes a person a member of the course, or changes their role, as a platform requests. Roles that staff set on this
/// server do not change.
pub(in crate::domain) async fn enroll(
    transaction: &mut Transaction,
    platform: i64,
    platform_course: i64,
    course: i64,
    account: i64,
    role: LtiRole,
) -> Result<(), DbError> {
    let statement = "INSERT INTO platform_member (platform_course, account) VALUES (?, ?)
        ON CONFLICT (platform_course, account) DO NOTHING";
    transaction.execute(statement, values![platform_course, account]).await?;
    let statement = "SELECT role, platform FROM member WHERE course = ? AND account = ?";
    let before = transaction.row(statement, values![course, account]).await?;
    if let Some(was) = &before
        && (was.maybe_int("platform")?.is_none() || was.text("role")? == role.name())
    {
        return Ok(());
    }
    // Earlier links and sessions must not get the rights of staff.
    if role == LtiRole::Staff && !identity::is_trusted(transaction, account).await? {
        identity::end_all_access(transaction, account).await?;
    } else {
        identity::end_staff_access(transaction, account).await?;
    }
    let statement = "INSERT INTO member (course, account, role, platform, created_at) VALUES (?, ?, ?, ?, {now})
        ON CONFLICT (course, account) DO UPDATE SET role = excluded.role, platform = excluded.platform";
    transaction.execute(statement, values![course, account, role.name(), platform]).await?;
    let login = transaction.one("SELECT login FROM account WHERE id = ?", values![account]).await?.text("login")?;
    let text = format!("learning platform: {login} became {}", role.name());
    view::log_event(transaction, &LogEntry { course: Some(course), ..LogEntry::new("member", account, &text) }).await
}

/// A launch that waits until a member of staff has chosen the course, the assignment or the link.
pub(in crate::domain) struct PendingLaunch {
    pub(in crate::domain) platform: Platform,
    pub(in crate::domain) arrival: Arrival,
}

/// Returns the waiting launch that belongs to a secret and an account.
pub(in crate::domain) async fn find_pending_launch(
    transaction: &mut Transaction,
    account: i64,
    secret: &str,
) -> Result<PendingLaunch, Problem> {
    let statement = "SELECT platform.id, platform.name, platform.settings, platform_choice.arrival FROM platform_choice
        JOIN platform ON platform.id = platform_choice.platform AND platform.disabled_at IS NULL
        WHERE platform_choice.digest = ? AND platform_choice.account = ? AND platform_choice.expires_at > {now}";
    let row = transaction.row(statement, values![identity::digest(secret), account]).await?;
    let row = row.ok_or_else(|| Problem::not_found("choice"))?;
    let arrival = serde_json::from_str(&row.text("arrival")?).map_err(|_| Problem::fault())?;
    Ok(PendingLaunch { platform: Platform::from_row(&row)?, arrival })
}
