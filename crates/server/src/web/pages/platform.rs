//! The pages for people who come from a learning platform.
use super::{
    super::{
        identification::browser_cookie,
        input::{Fields, UrlPathParts},
    },
    Page, PageFrame, course, render, sign_in, text,
};
use crate::{
    domain::{
        Admin, App, LinkStep, LinkTarget, LoginRequest, Person, RosterMode, RosterRead, Staff, Suites, Visitor,
        propose_slug,
    },
    lti::{PlatformSettings, scope},
    problem::Problem,
};
use askama::Template;
use axum::{
    Json,
    extract::State,
    http::{HeaderMap, HeaderValue, header},
    response::{IntoResponse, Redirect, Response},
};
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;

#[derive(Template)]
#[template(path = "platform/window.html")]
struct WindowPage {
    frame: PageFrame,
    address: String,
}

#[derive(Template)]
#[template(path = "platform/choice.html")]
struct ChoicePage<'a> {
    frame: PageFrame,
    secret: String,
    choice: LinkTarget,
    suites: &'a Suites,
}

#[derive(Template)]
#[template(path = "platform/answer.html")]
struct AnswerPage {
    frame: PageFrame,
    address: String,
    token: String,
}

#[derive(Template)]
#[template(path = "roster.html")]
struct RosterPage {
    frame: PageFrame,
    slug: String,
    changes: RosterRead,
    is_done: bool,
}

#[derive(Deserialize)]
pub(super) struct RosterForm {
    confirm: Option<String>,
}

#[derive(Deserialize)]
pub(super) struct CourseChoice {
    known: Option<String>,
    #[serde(default)]
    slug: String,
    #[serde(default)]
    title: String,
}

#[derive(Deserialize)]
pub(super) struct AssignmentChoice {
    #[serde(default)]
    assignment: String,
    /// The title of a new assignment; empty if an existing assignment was chosen.
    #[serde(default)]
    title: String,
    #[serde(default)]
    suite: String,
}

/// A platform's name and the fields of its registration, as a form sends them.
#[derive(Deserialize)]
pub(super) struct NewPlatform {
    name: String,
    #[serde(flatten)]
    fields: BTreeMap<String, String>,
}

/// Returns the cookie with the browser's secret during a sign-in from a platform. Browsers must send it with requests
/// from other sites, because the platform's answer is such a request. In a frame, many browsers isolate or drop the
/// cookie, so people cannot sign in there.
fn browser_cookie_of(app: &App, secret: &str) -> String {
    let secure = app.is_secure();
    let rest = if secure { "SameSite=None; Secure; Partitioned" } else { "SameSite=Lax" };
    format!("{}={secret}; Path=/; HttpOnly; Max-Age=600; {rest}", browser_cookie(secure))
}

fn with_policy(mut response: Response, policy: &str) -> Response {
    if let Ok(policy) = HeaderValue::from_str(policy) {
        response.headers_mut().insert(header::CONTENT_SECURITY_POLICY, policy);
    }
    response
}

pub(super) async fn begin_login(
    visitor: Visitor,
    headers: HeaderMap,
    Fields(login): Fields<LoginRequest>,
) -> Result<Response, Problem> {
    let platform = visitor.platform(&login).await?;
    let app = &visitor.app;
    let framed =
        headers.get("sec-fetch-dest").is_some_and(|destination| destination == "iframe" || destination == "frame");
    if framed {
        let fields = [
            ("iss", Some(login.iss)),
            ("login_hint", Some(login.login_hint)),
            ("target_link_uri", login.target_link_uri),
            ("lti_message_hint", login.lti_message_hint),
            ("client_id", login.client_id),
            ("lti_deployment_id", login.lti_deployment_id),
        ];
        let mut query = url::form_urlencoded::Serializer::new(String::new());
        for (name, value) in fields {
            value.map(|value| query.append_pair(name, &value));
        }
        // The page uses a link instead of a form, because its content security policy would block a form that redirects
        // to the platform.
        let address = format!("/lti/login?{}", query.finish());
        let page = render(&WindowPage { frame: PageFrame::default(), address })?.into_response();
        let origins = platform.origins(app.lti.allows_http());
        let policy = format!(
            "default-src 'none'; style-src 'self'; script-src 'self'; img-src data:; form-action 'self'; \
             base-uri 'none'; frame-ancestors {origins}"
        );
        return Ok(with_policy(page, &policy));
    }
    let answer = visitor.begin_login(&platform, &login).await?;
    Ok(sign_in::with_cookie(&browser_cookie_of(app, &answer.browser), &answer.address))
}

pub(super) async fn accept(visitor: Visitor, Fields(answer): Fields<sign_in::Answer>) -> Result<Response, Problem> {
    let (state, token) = answer.read("platform", Problem::rejected_launch)?;
    let launched = visitor.launch(&state, &token).await?;
    Ok(sign_in::start_session(&visitor.app, &launched.session, &launched.path))
}

/// Returns the service's public keys. Platforms read them at this URL.
pub(super) async fn send_keys(State(app): State<App>) -> Result<Response, Problem> {
    let keys = app.platform_keys().await?;
    Ok(([(header::CACHE_CONTROL, "public, max-age=300")], Json(keys)).into_response())
}

/// Returns the configuration for Canvas. An administrator enters the URL of this answer there.
pub(super) async fn send_configuration(State(app): State<App>) -> Json<Value> {
    let public = &app.public;
    let launch = app.launch_address();
    let host = public.split_once("://").map_or(public.as_str(), |(_, host)| host);
    let placement = |location: &str, kind: &str| {
        json!({"placement": location, "message_type": kind, "target_link_uri": launch, "text": "fosssim-oracle",
            "windowTarget": "_blank"})
    };
    Json(json!({
        "title": "fosssim-oracle",
        "description": "Grades simulations of collisions",
        "oidc_initiation_url": format!("{public}/lti/login"),
        "target_link_uri": launch,
        "public_jwk_url": format!("{public}/lti/keys.json"),
        "scopes": [scope::SCORE_SCOPE, scope::LINE_ITEM, scope::MEMBERS_SCOPE],
        "extensions": [{
            "platform": "canvas.instructure.com",
            "domain": host,
            "privacy_level": "public",
            "settings": {"placements": [
                placement("link_selection", "LtiDeepLinkingRequest"),
                placement("assignment_selection", "LtiDeepLinkingRequest"),
            ]},
        }],
    }))
}

pub(super) async fn show_choice(person: Person, UrlPathParts { secret, .. }: UrlPathParts) -> Page {
    let (choice, app) = (person.choice(&secret).await?, &person.app);
    render(&ChoicePage { frame: PageFrame::for_account(&person.account), secret, choice, suites: &app.suites })
}

pub(super) async fn choose_assignment(
    person: Person,
    UrlPathParts { secret, .. }: UrlPathParts,
    Fields(choice): Fields<AssignmentChoice>,
) -> Result<Response, Problem> {
    let mut slug = choice.assignment;
    if !choice.title.trim().is_empty() {
        slug = propose_slug(&choice.title);
        let LinkTarget::Assignment { course, .. } = person.choice(&secret).await? else {
            return Err(Problem::not_found("course"));
        };
        let staff = person.clone().into_member(&course.slug).await?.into_staff()?;
        course::create_assignment(&staff, &slug, choice.title.trim(), &choice.suite).await?;
    }
    match person.choose_assignment(&secret, &slug).await? {
        LinkStep::Assignment(path) => Ok(Redirect::to(&path).into_response()),
        LinkStep::Answer { address, origins, token } => {
            let page =
                render(&AnswerPage { frame: PageFrame::for_account(&person.account), address, token })?.into_response();
            let policy = format!(
                "default-src 'none'; style-src 'self'; script-src 'self'; img-src data:; form-action 'self' {origins}; \
                base-uri 'none'; frame-ancestors 'none'"
            );
            Ok(with_policy(page, &policy))
        }
    }
}

impl NewPlatform {
    fn settings(&self) -> Result<PlatformSettings, Problem> {
        let list = |text: &str| -> Vec<String> {
            let items = text.split([' ', ',', '\n', '\r', '\t']).filter(|item| !item.is_empty());
            items.map(str::to_owned).collect()
        };
        let filled = self.fields.iter().map(|(name, text)| (name, text.trim())).filter(|(_, text)| !text.is_empty());
        let fields: Value = filled
            .map(|(name, text)| match name.as_str() {
                "deployments" | "hosts" => (name.clone(), Value::from(list(text))),
                _ => (name.clone(), Value::from(text)),
            })
            .collect();
        serde_json::from_value(fields).map_err(|error| Problem::invalid(error.to_string()))
    }
}

/// Shows who would join and who would leave, before members are changed.
pub(super) async fn read_roster(staff: Staff, Fields(form): Fields<RosterForm>) -> Page {
    let is_done = form.confirm.is_some();
    let changes = staff.read_roster(if is_done { RosterMode::Confirmed } else { RosterMode::Preview }).await?;
    let frame = PageFrame::course(&staff).with_parent(format!("/c/{}/members", staff.slug), "Members");
    render(&RosterPage { frame, slug: staff.slug.clone(), changes, is_done })
}

actions! {
    choose_course(person: Person, { secret }, choice: CourseChoice): {
        let existing_slug = choice.known.as_deref().filter(|slug| !slug.is_empty());
        person.choose_course(&secret, existing_slug, (choice.slug.trim(), choice.title.trim()))
    } => "/lti/choose/{secret}";
    set_platform(admin: Admin, form: NewPlatform):
        async { admin.set_platform(form.name.trim(), &form.settings()?).await } => "/admin/platforms";
    shut_platform(admin: Admin, { name }): admin.close_platform(&name) => "/admin/platforms";
    new_key(admin: Admin): admin.new_platform_key() => "/admin/platforms";
    send_scores(staff: Staff, { course, assignment }):
        staff.send_scores(&assignment) => "/c/{course}/a/{assignment}/class";
}
