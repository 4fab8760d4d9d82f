//! A platform's message about a person who signs in (LTI 5), and the parts of it that are trusted after all
//! checks.
use super::{
    Platform,
    client::{now_seconds, scope},
    crypto::{self, CLOCK_LEEWAY, PublicKey},
    keys,
};
use crate::{
    db::{Database, DbError},
    problem::ensure,
};
use jsonwebtoken::{Algorithm, errors::ErrorKind};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use thiserror::Error;

/// The maximum age of an accepted message, in seconds.
const MAX_MESSAGE_AGE: u64 = 3600;

/// The reason why a message is rejected.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Rejection {
    /// The message is not signed with RS256.
    #[error("the message is not signed by RS256 with a named key")]
    Form,
    /// The platform has no key with this ID.
    #[error("the platform publishes no key with the ID that the message names")]
    UnknownKey,
    /// The platform's keys can't be read.
    #[error("the platform's keys can't be read now")]
    NoKeys,
    /// The signature does not match the platform's key.
    #[error("the message was not signed by the platform")]
    Signature,
    /// The message is too old, or from the future.
    #[error("the message is too old, or a clock is wrong")]
    Time,
    /// The message answers another request; the value names the part that differs.
    #[error("the message is not for this sign-in: {0} differs")]
    Foreign(&'static str),
    /// The message comes from a deployment that is not registered; the value is its ID.
    #[error("deployment {0} is not registered; an administrator can add it")]
    Deployment(String),
    /// A part of the message is missing or invalid; the value describes it.
    #[error("the message is invalid: {0}")]
    Content(String),
}

/// The role of a person in a platform's course.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum LtiRole {
    /// The person is a learner.
    Student,
    /// The person is an instructor, a teaching assistant, or an administrator.
    Staff,
}

impl LtiRole {
    /// Returns the role as this service stores it, `student` or `staff`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Student => "student",
            Self::Staff => "staff",
        }
    }
}

/// A person, as a platform describes them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LtiPerson {
    /// The platform's identifier of the person. It never changes.
    pub subject: String,
    /// The person's role in the platform's course; `None` for parents, guests and others, and for people who left.
    pub role: Option<LtiRole>,
    /// The person's name; `None` if the platform withholds it.
    pub name: Option<String>,
    /// The person's e-mail address; `None` if the platform withholds it. It is used only to propose a login.
    pub email: Option<String>,
}

/// A platform's message about a person who opens a link.
#[derive(Debug, Clone)]
pub struct Message {
    /// The person who signs in.
    pub person: LtiPerson,
    /// The course and the link on the platform where the person started.
    pub arrival: Arrival,
}

/// The course and the link on a platform where a person started a sign-in.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Arrival {
    /// The LTI deployment ID (`deployment_id`).
    pub deployment: String,
    /// The course on the platform.
    pub context: Context,
    /// The link that the person followed; `None` if the person is about to create a link.
    pub resource: Option<Resource>,
    /// The assignment that the link names.
    pub assignment: Option<String>,
    /// The URL of the link's column in the grade book; `None` if scores may not be sent there.
    pub line_item: Option<String>,
    /// The URL for creating columns; `None` if this is not permitted.
    pub line_items: Option<String>,
    /// The URL of the course's list of members; `None` if the platform does not offer it.
    pub memberships: Option<String>,
    /// The platform's request to choose what a new link opens.
    pub deep_linking: Option<DeepLinking>,
}

/// A course of a platform.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Context {
    /// The course's identifier on the platform.
    pub id: String,
    /// The course's title on the platform.
    #[serde(default)]
    pub title: Option<String>,
    /// The course's short name on the platform, such as a number.
    #[serde(default)]
    pub label: Option<String>,
}

/// A link in a platform's course.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Resource {
    /// The link's identifier on the platform.
    pub id: String,
    /// The link's title on the platform.
    #[serde(default)]
    pub title: Option<String>,
}

/// The parameters with which a platform requests a new link (DL 4.4.1).
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct DeepLinking {
    /// The platform's URL for the answer.
    pub deep_link_return_url: String,
    /// The types of items that the platform accepts.
    #[serde(default)]
    pub accept_types: Vec<String>,
    /// Text that the answer must return unchanged.
    #[serde(default)]
    pub data: Option<String>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
enum TokenAudience {
    One(String),
    Many(Vec<String>),
}

#[derive(Debug, Clone, Default, Deserialize)]
struct Endpoint {
    #[serde(default)]
    scope: Vec<String>,
    lineitem: Option<String>,
    lineitems: Option<String>,
}

#[derive(Debug, Clone, Deserialize)]
struct MembershipService {
    context_memberships_url: String,
}

#[derive(Debug, Clone, Deserialize)]
struct Claims {
    sub: String,
    aud: TokenAudience,
    azp: Option<String>,
    iat: u64,
    nonce: String,
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/message_type")]
    message_type: String,
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/version")]
    version: String,
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/deployment_id")]
    deployment: String,
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/roles", default)]
    roles: Vec<String>,
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/context")]
    context: Option<Context>,
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/resource_link")]
    resource: Option<Resource>,
    #[serde(rename = "https://purl.imsglobal.org/spec/lti/claim/custom", default)]
    custom: Map<String, Value>,
    #[serde(rename = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint")]
    endpoint: Option<Endpoint>,
    #[serde(rename = "https://purl.imsglobal.org/spec/lti-nrps/claim/namesroleservice")]
    names: Option<MembershipService>,
    #[serde(rename = "https://purl.imsglobal.org/spec/lti-dl/claim/deep_linking_settings")]
    deep_linking: Option<DeepLinking>,
    name: Option<String>,
    given_name: Option<String>,
    family_name: Option<String>,
    email: Option<String>,
}

/// Returns the ID of the key with which a message claims to be signed.
pub(super) fn read_key_id(token: &str) -> Result<String, Rejection> {
    let header = jsonwebtoken::decode_header(token).map_err(|_| Rejection::Form)?;
    ensure(header.alg == Algorithm::RS256, Rejection::Form)?;
    header.kid.filter(|kid| !kid.is_empty() && kid.len() <= 500).ok_or(Rejection::Form)
}

/// Reads the content of a message that was signed with `key`. `nonce` is the digest of the nonce that this service
/// sent.
pub(super) fn read(platform: &Platform, token: &str, key: &PublicKey, nonce: &str) -> Result<Message, Rejection> {
    let settings = &platform.settings;
    let claims: Claims =
        crypto::verify(token, key, &settings.issuer, &settings.client_id).map_err(|error| match error.kind() {
            ErrorKind::InvalidSignature => Rejection::Signature,
            ErrorKind::ExpiredSignature | ErrorKind::ImmatureSignature => Rejection::Time,
            ErrorKind::InvalidIssuer => Rejection::Foreign("the issuer"),
            ErrorKind::InvalidAudience => Rejection::Foreign("the audience"),
            ErrorKind::InvalidAlgorithm | ErrorKind::InvalidToken | ErrorKind::InvalidAlgorithmName => Rejection::Form,
            ErrorKind::MissingRequiredClaim(name) => Rejection::Content(format!("{name} is missing")),
            _ => Rejection::Content(error.to_string()),
        })?;
    // SEC 5.1.3, steps 3 to 5: if the message has several audiences or an authorized party, the authorized party must
    // be this service.
    let several = matches!(&claims.aud, TokenAudience::Many(all) if all.len() > 1);
    if matches!(&claims.aud, TokenAudience::One(audience) if *audience != settings.client_id) {
        return Err(Rejection::Foreign("the audience"));
    }
    if (several && claims.azp.is_none()) || claims.azp.as_ref().is_some_and(|azp| *azp != settings.client_id) {
        return Err(Rejection::Foreign("the authorized party"));
    }
    let now = now_seconds();
    ensure(claims.iat <= now + CLOCK_LEEWAY && now <= claims.iat + MAX_MESSAGE_AGE + CLOCK_LEEWAY, Rejection::Time)?;
    ensure(
        crate::store::Digest::from_bytes(claims.nonce.as_bytes()).as_str() == nonce,
        Rejection::Foreign("the nonce"),
    )?;
    ensure(claims.version == "1.3.0", Rejection::Content("the LTI version must be 1.3.0".to_owned()))?;
    if !settings.deployments.contains(&claims.deployment) {
        return Err(Rejection::Deployment(claims.deployment.chars().take(255).collect()));
    }
    ensure((1..=255).contains(&claims.sub.len()), Rejection::Content("sub must have 1 to 255 characters".to_owned()))?;
    let missing = |what: &str| Rejection::Content(format!("{what} is missing"));
    let (resource, deep_linking) = match claims.message_type.as_str() {
        "LtiResourceLinkRequest" => (Some(claims.resource.ok_or_else(|| missing("resource_link"))?), None),
        "LtiDeepLinkingRequest" => {
            let deep_linking = claims.deep_linking.ok_or_else(|| missing("deep_linking_settings"))?;
            if !deep_linking.accept_types.iter().any(|kind| kind == "ltiResourceLink") {
                return Err(Rejection::Content("the platform does not accept links to resources".to_owned()));
            }
            (None, Some(deep_linking))
        }
        _ => return Err(Rejection::Content("this message type is not supported".to_owned())),
    };
    let context = claims.context.ok_or_else(|| missing("context"))?;
    let is_name = |text: &str| (1..=255).contains(&text.len());
    if !is_name(&context.id) || resource.as_ref().is_some_and(|resource| !is_name(&resource.id)) {
        return Err(Rejection::Content("the names of courses and links must have 1 to 255 characters".to_owned()));
    }
    let endpoint = claims.endpoint.unwrap_or_default();
    let may_use = |wanted: &str| endpoint.scope.iter().any(|scope| scope == wanted);
    let scores = may_use(scope::SCORE_SCOPE);
    let columns = scores && may_use(scope::LINE_ITEM);
    Ok(Message {
        person: LtiPerson {
            subject: claims.sub,
            role: find_role(&claims.roles),
            name: join_name(claims.name, [claims.given_name, claims.family_name]),
            email: claims.email,
        },
        arrival: Arrival {
            deployment: claims.deployment,
            context,
            resource,
            assignment: claims.custom.get("assignment").and_then(Value::as_str).map(str::to_owned),
            line_item: endpoint.lineitem.filter(|_| scores),
            line_items: endpoint.lineitems.filter(|_| columns),
            memberships: claims.names.map(|names| names.context_memberships_url),
            deep_linking,
        },
    })
}

/// Returns a person's full name; if the platform does not send it, the first and last name joined.
pub(super) fn join_name(whole: Option<String>, parts: [Option<String>; 2]) -> Option<String> {
    let joined = parts.into_iter().flatten().collect::<Vec<_>>().join(" ");
    whole.or(Some(joined)).filter(|name| !name.trim().is_empty())
}

/// Returns a person's role in the course, according to the roles that the platform sends (LTI A.2.3). A role in the
/// institution or the system gives no role in the course, except to an administrator without any other role.
pub(crate) fn find_role(roles: &[String]) -> Option<LtiRole> {
    const COURSE_ROLES: &str = "http://purl.imsglobal.org/vocab/lis/v2/membership";
    // The simple names are deprecated, but still in use.
    let course_role = |role: &str| -> Option<String> {
        let rest = role.strip_prefix(COURSE_ROLES)?;
        // A principal role such as `#Instructor`, or a sub-role such as `/Instructor#TeachingAssistant`.
        match rest.strip_prefix('/') {
            Some(part) => part.split('#').next().map(str::to_owned),
            None => rest.strip_prefix('#').map(str::to_owned),
        }
    };
    let course_roles: Vec<String> = roles
        .iter()
        .filter_map(|role| if role.contains('/') { course_role(role) } else { Some(role.clone()) })
        .collect();
    let has_role = |name: &str| course_roles.iter().any(|role| role == name);
    if has_role("Instructor") || has_role("Administrator") || has_role("ContentDeveloper") {
        return Some(LtiRole::Staff);
    }
    if has_role("Learner") {
        return Some(LtiRole::Student);
    }
    let is_administrator = |role: &String| {
        let name = role.strip_prefix("http://purl.imsglobal.org/vocab/lis/v2/");
        matches!(name, Some("institution/person#Administrator" | "system/person#Administrator"))
    };
    (course_roles.is_empty() && roles.iter().any(is_administrator)).then_some(LtiRole::Staff)
}

/// Returns the signed answer to a request for a link. It contains one link, which opens an assignment (DL 4.5).
///
/// # Errors
/// Fails if the server's signing key cannot be read.
pub async fn deep_linking_response(
    database: &Database,
    platform: &Platform,
    arrival: &Arrival,
    launch: &str,
    (slug, title): (&str, &str),
) -> Result<String, DbError> {
    let now = now_seconds();
    let mut claims = json!({
        "iss": platform.settings.client_id,
        "aud": [platform.settings.issuer],
        "iat": now,
        "exp": now + 300,
        "nonce": crate::secret::random_hex(),
        "https://purl.imsglobal.org/spec/lti/claim/message_type": "LtiDeepLinkingResponse",
        "https://purl.imsglobal.org/spec/lti/claim/version": "1.3.0",
        "https://purl.imsglobal.org/spec/lti/claim/deployment_id": arrival.deployment,
        "https://purl.imsglobal.org/spec/lti-dl/claim/content_items": [{
            "type": "ltiResourceLink",
            "title": title,
            "url": launch,
            "custom": {"assignment": slug},
            "window": {"targetName": "_blank"},
            "lineItem": {"scoreMaximum": 100, "label": title, "resourceId": slug},
        }],
    });
    if let Some(data) = arrival.deep_linking.as_ref().and_then(|wanted| wanted.data.as_ref()) {
        claims["https://purl.imsglobal.org/spec/lti-dl/claim/data"] = json!(data);
    }
    keys::signing_key(database).await?.sign(&claims)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roles_in_the_course_decide() {
        const MEMBER: &str = "http://purl.imsglobal.org/vocab/lis/v2/membership";
        const PERSON: &str = "http://purl.imsglobal.org/vocab/lis/v2/institution/person";
        let role = |roles: &[String]| find_role(roles);
        assert_eq!(role(&[format!("{MEMBER}#Learner")]), Some(LtiRole::Student));
        assert_eq!(role(&["Learner".to_owned()]), Some(LtiRole::Student));
        assert_eq!(role(&[format!("{MEMBER}#Instructor"), format!("{MEMBER}#Learner")]), Some(LtiRole::Staff));
        assert_eq!(role(&[format!("{MEMBER}/Instructor#TeachingAssistant")]), Some(LtiRole::Staff));
        assert_eq!(role(&[format!("{MEMBER}#Administrator")]), Some(LtiRole::Staff));
        // Teachers of the institution may learn as well, and administrators have their role here.
        assert_eq!(role(&[format!("{PERSON}#Instructor"), format!("{MEMBER}#Learner")]), Some(LtiRole::Student));
        assert_eq!(role(&[format!("{PERSON}#Administrator"), format!("{MEMBER}#Learner")]), Some(LtiRole::Student));
        assert_eq!(role(&[format!("{PERSON}#Administrator")]), Some(LtiRole::Staff));
        for other in [format!("{MEMBER}#Mentor"), format!("{PERSON}#Student"), format!("{PERSON}#Guest"), String::new()]
        {
            assert_eq!(role(std::slice::from_ref(&other)), None, "{other}");
        }
        assert_eq!(role(&[]), None);
        assert_eq!(role(&["https://evil.example/membership#Instructor".to_owned()]), None);
    }
}
