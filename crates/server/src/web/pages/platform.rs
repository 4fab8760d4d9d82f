//! Coming from a learning platform.
use super::{
    super::{
        input::{Asked, At, Fields},
        who::browser_cookie,
    },
    Frame, see, show, sign_in,
};
use crate::{
    access::{Admin, App, Assignment, Choice, Chosen, Course, LoginRequest, Person, Staff, Visitor},
    problem::Problem,
};
use askama::Template;
use axum::{
    Json,
    extract::State,
    http::{HeaderMap, HeaderValue, header},
    response::{Html, IntoResponse, Redirect, Response},
};
use serde::Deserialize;
use serde_json::{Value, json};

/// The request that a platform sends when somebody wants to come.
#[derive(Deserialize)]
pub(super) struct Login {
    iss: String,
    login_hint: String,
    target_link_uri: Option<String>,
    lti_message_hint: Option<String>,
    client_id: Option<String>,
    lti_deployment_id: Option<String>,
}

/// The platform's answer.
#[derive(Deserialize)]
pub(super) struct Answer {
    state: Option<String>,
    id_token: Option<String>,
    error: Option<String>,
    error_description: Option<String>,
}

#[derive(Template)]
#[template(path = "platform/window.html")]
struct WindowPage {
    frame: Frame,
    address: String,
}

#[derive(Template)]
#[template(path = "platform/course.html")]
struct CoursePage {
    frame: Frame,
    secret: String,
    platform: String,
    title: String,
    slug: String,
    courses: Vec<Course>,
}

#[derive(Template)]
#[template(path = "platform/assignment.html")]
struct AssignmentPage {
    frame: Frame,
    secret: String,
    course: Course,
    title: Option<String>,
    assignments: Vec<Assignment>,
}

#[derive(Template)]
#[template(path = "platform/answer.html")]
struct AnswerPage {
    frame: Frame,
    address: String,
    token: String,
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
    assignment: String,
}

#[derive(Deserialize)]
pub(super) struct NewPlatform {
    name: String,
    issuer: String,
    client_id: String,
    login_url: String,
    token_url: String,
    keys_url: String,
    #[serde(default)]
    audience: String,
    deployments: String,
    #[serde(default)]
    hosts: String,
}

/// The browser's word while it comes from a platform: sent with what another site makes it send, which is what the
/// platform's answer is. In a frame many browsers keep it apart, or drop it; so nobody comes in by a frame.
fn browser_word(app: &App, word: &str) -> String {
    let secure = app.is_secure();
    let rest = if secure { "SameSite=None; Secure; Partitioned" } else { "SameSite=Lax" };
    format!("{}={word}; Path=/; HttpOnly; Max-Age=600; {rest}", browser_cookie(secure))
}

fn with_policy(response: Response, policy: &str) -> Response {
    let mut response = response;
    if let Ok(policy) = HeaderValue::from_str(policy) {
        response.headers_mut().insert(header::CONTENT_SECURITY_POLICY, policy);
    }
    response
}

pub(super) async fn login(
    visitor: Visitor,
    headers: HeaderMap,
    Asked(login): Asked<Login>,
) -> Result<Response, Problem> {
    begin(&visitor, &headers, login).await
}

pub(super) async fn login_by_form(
    visitor: Visitor,
    headers: HeaderMap,
    Fields(login): Fields<Login>,
) -> Result<Response, Problem> {
    begin(&visitor, &headers, login).await
}

async fn begin(visitor: &Visitor, headers: &HeaderMap, login: Login) -> Result<Response, Problem> {
    let request = LoginRequest {
        issuer: login.iss.clone(),
        client: login.client_id.clone(),
        hint: login.login_hint.clone(),
        message_hint: login.lti_message_hint.clone(),
    };
    let platform = visitor.platform(&request).await?;
    let app = &visitor.app;
    let framed = headers.get("sec-fetch-dest").is_some_and(|place| place == "iframe" || place == "frame");
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
        // A link and no form: where a form may lead is asked of all redirections, too, and this one goes on to the
        // platform.
        let address = format!("/lti/login?{}", query.finish());
        let page = show(&WindowPage { frame: Frame::nobody(), address })?.into_response();
        let origins = platform.origins(app.lti.over_http());
        let policy = format!(
            "default-src 'none'; style-src 'self'; form-action 'self'; base-uri 'none'; frame-ancestors {origins}"
        );
        return Ok(with_policy(page, &policy));
    }
    let answer = visitor.begin_login(&platform, &request, visitor.browser.as_deref()).await?;
    Ok(sign_in::with_cookie(&browser_word(app, &answer.browser), &answer.address))
}

pub(super) async fn launch(visitor: Visitor, Fields(answer): Fields<Answer>) -> Result<Response, Problem> {
    let (Some(state), Some(token)) = (&answer.state, &answer.id_token) else {
        let said = [answer.error, answer.error_description].into_iter().flatten().collect::<Vec<_>>().join(": ");
        let said: String = said.chars().filter(|c| !c.is_control()).take(300).collect();
        return Err(match said.is_empty() {
            true => Problem::invalid("state and id_token are missing"),
            false => Problem::refused_launch(format!("the platform says: {said}")),
        });
    };
    let launched = visitor.launch(state, token, visitor.browser.as_deref()).await?;
    Ok(sign_in::enter(&visitor.app, &launched.session, &launched.to))
}

/// The service's public keys, where platforms look for them.
pub(super) async fn keys(State(app): State<App>) -> Result<Response, Problem> {
    let keys = app.platform_keys().await?;
    Ok(([(header::CACHE_CONTROL, "public, max-age=300")], Json(keys)).into_response())
}

/// The configuration whose address an administrator of Canvas enters.
pub(super) async fn configuration(State(app): State<App>) -> Json<Value> {
    let public = &app.public;
    let launch = app.launch_address();
    let host = public.split_once("://").map_or(public.as_str(), |(_, host)| host);
    let placement = |place: &str, kind: &str| {
        json!({"placement": place, "message_type": kind, "target_link_uri": launch, "text": "fosssim-oracle",
            "windowTarget": "_blank"})
    };
    Json(json!({
        "title": "fosssim-oracle",
        "description": "Grades simulations of collisions",
        "oidc_initiation_url": format!("{public}/lti/login"),
        "target_link_uri": launch,
        "public_jwk_url": format!("{public}/lti/keys.json"),
        "scopes": [crate::lti::scope::SCORE, crate::lti::scope::LINE_ITEM, crate::lti::scope::MEMBERS],
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

pub(super) async fn choose(person: Person, At { secret, .. }: At) -> Result<Html<String>, Problem> {
    let frame = Frame::of(&person.account);
    match person.choice(&secret).await? {
        Choice::Course { platform, title, slug, courses } => {
            show(&CoursePage { frame, secret, platform, title, slug, courses })
        }
        Choice::Assignment { course, title, assignments } => {
            show(&AssignmentPage { frame, secret, course, title, assignments })
        }
    }
}

pub(super) async fn choose_course(
    person: Person,
    At { secret, .. }: At,
    Fields(choice): Fields<CourseChoice>,
) -> Result<Redirect, Problem> {
    let known = choice.known.as_deref().filter(|slug| !slug.is_empty());
    person.choose_course(&secret, known, (choice.slug.trim(), choice.title.trim())).await?;
    Ok(see(&format!("/lti/choose/{secret}")))
}

pub(super) async fn choose_assignment(
    person: Person,
    At { secret, .. }: At,
    Fields(choice): Fields<AssignmentChoice>,
) -> Result<Response, Problem> {
    match person.choose_assignment(&secret, &choice.assignment).await? {
        Chosen::Assignment(path) => Ok(see(&path).into_response()),
        Chosen::Answer { address, origins, token } => {
            let page = show(&AnswerPage { frame: Frame::of(&person.account), address, token })?.into_response();
            let policy = format!(
                "default-src 'none'; style-src 'self'; form-action 'self' {origins}; base-uri 'none'; frame-ancestors 'none'"
            );
            Ok(with_policy(page, &policy))
        }
    }
}

pub(super) async fn set_platform(admin: Admin, Fields(form): Fields<NewPlatform>) -> Result<Redirect, Problem> {
    let words = |text: &str| -> Vec<String> {
        text.split([' ', ',', '\n', '\r', '\t']).filter(|word| !word.is_empty()).map(str::to_owned).collect()
    };
    let audience = form.audience.trim();
    let wish = crate::lti::PlatformWish {
        issuer: form.issuer.trim().to_owned(),
        client_id: form.client_id.trim().to_owned(),
        login_url: form.login_url.trim().to_owned(),
        token_url: form.token_url.trim().to_owned(),
        keys_url: form.keys_url.trim().to_owned(),
        audience: (!audience.is_empty()).then(|| audience.to_owned()),
        deployments: words(&form.deployments),
        hosts: words(&form.hosts),
    };
    admin.set_platform(form.name.trim(), &wish).await?;
    Ok(see("/admin"))
}

deeds! {
    shut_platform(admin: Admin, { name }): admin.shut_platform(&name) => "/admin";
    new_key(admin: Admin): admin.new_platform_key() => "/admin";
    read_roster(staff: Staff, { course }): staff.read_roster() => "/c/{course}/members";
    send_scores(staff: Staff, { course, assignment }):
        staff.send_scores(&assignment) => "/c/{course}/a/{assignment}/class";
}
