//! Errors as clients receive them: each describes the problem, and what the client can do about it (RFC 9457,
//! problem+json).
use crate::{db::DbError, store::StoreError};
use serde::Serialize;
use utoipa::ToSchema;

/// The reason why a request was rejected, as the client receives it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Problem {
    /// The identifier of the kind of problem. It never changes.
    #[serde(rename = "type")]
    pub kind: String,
    /// The kind of problem, in words.
    pub title: String,
    /// The HTTP status of the answer.
    pub status: u16,
    /// The description of the fault in this request.
    pub detail: String,
    /// The action by which the client can solve the problem.
    pub remedy: String,
    /// The number of seconds after which a retry may succeed; null if it is unknown.
    #[serde(skip)]
    pub wait: Option<u64>,
}

/// Declares the reasons for rejections. Each has a status, an identifier, a title, a detail and a remedy. If the caller
/// gives the detail or the remedy, it is an argument.
macro_rules! problems {
    ($($(#[doc = $doc:literal])* $name:ident($($argument:ident: $type:ty),*):
        $status:literal, $kind:literal, $title:literal, $detail:expr, $remedy:expr;)*) => {
        impl Problem {
            $($(#[doc = $doc])*
            pub fn $name($($argument: $type),*) -> Self {
                Self {
                    kind: concat!("urn:fosssim:", $kind).to_owned(),
                    title: $title.to_owned(),
                    status: $status,
                    detail: $detail.into(),
                    remedy: $remedy.to_owned(),
                    wait: None,
                }
            })*
        }
    };
}

problems! {
    /// The sender of the request is not signed in.
    not_signed_in(): 401, "not-signed-in", "Not signed in",
        "this needs a sign-in",
        "sign in, or send a token: Bearer fso_...";
    /// The token, session or link is unknown or no longer valid.
    unknown_secret(what: &str, remedy: &str): 401, "unknown-secret", "Not signed in",
        format!("this {what} is unknown, used, too old or revoked"),
        remedy;
    /// The person is known, but lacks the permission.
    not_allowed(detail: impl Into<String>): 403, "not-allowed", "Not allowed",
        detail,
        "ask a person whose role allows it";
    /// The sign-in is not recent. The person must sign in again, because somebody else may be using the browser.
    sign_in_again(detail: impl Into<String>): 403, "sign-in-again", "Sign in again",
        detail,
        "sign in again on this server's pages, and repeat the action there";
    /// The request may have been sent by another site through the browser.
    cross_site(): 403, "cross-site", "Sent from another site",
        "the request came from another site, or does not say where it came from",
        "send it from this site's own pages, or with a token instead of a cookie";
    /// A sign-in from a learning platform is rejected.
    rejected_launch(detail: impl Into<String>): 403, "launch-refused", "This sign-in is not possible",
        detail,
        "go back to the platform and open it there again; if it happens again, tell the server's administrator";
    /// A sign-in from a learning platform is not possible until somebody does what the remedy says.
    rejected_until(detail: impl Into<String>, remedy: &str): 403, "launch-refused", "This sign-in is not possible",
        detail,
        remedy;
    /// A sign-in at a provider is rejected.
    rejected_sign_in(detail: impl Into<String>): 403, "sign-in-refused", "This sign-in is not possible",
        detail,
        "sign in again, or with a link from the course's staff; if it happens again, tell the administrator";
    /// A learning platform did not fulfill a request.
    platform_failed(detail: impl Into<String>): 502, "platform-failed", "The learning platform failed",
        detail,
        "try again later; if it happens again, tell the server's administrator";
    /// The named thing does not exist, or the sender must not learn whether it exists.
    not_found(what: &str): 404, "not-found", "Not found",
        format!("there is no such {what}, or you may not see it"),
        "check the URL, or go back and check what you typed";
    /// The named thing existed, but has been removed.
    removed(): 410, "removed", "Removed",
        "the upload and its reports were removed; the grade and its history stay",
        "ask the course's staff about the grade";
    /// A part of the request is invalid.
    invalid(detail: impl Into<String>): 400, "invalid", "Invalid request",
        detail,
        "correct it and send it again";
    /// The action is not possible in the present state.
    conflict(detail: impl Into<String>, remedy: &str): 409, "conflict", "Not possible now",
        detail,
        remedy;
    /// Somebody else has changed the same thing since the sender saw it.
    changed(detail: impl Into<String>): 409, "conflict", "Not possible now",
        detail,
        "go back: what you typed is kept; check it, and save again";
    /// Administrators cannot close, remove or demote their own account.
    own_account(): 409, "conflict", "Not possible now",
        "this is your own account",
        "ask another administrator";
    /// The uploaded file is not a submission.
    unusable(detail: impl Into<String>): 422, "unusable-upload", "This can't be graded",
        detail,
        "choose another file; this did not count as an attempt";
    /// The uploaded file is not a suite.
    no_suite(detail: impl Into<String>): 422, "unusable-upload", "This is not a suite",
        detail,
        "correct the suite and upload it again; the assignment keeps its suite";
    /// The upload is larger than allowed.
    too_large(max_bytes: u64): 413, "too-large", "Too large",
        format!("more than the {} that are allowed", format_size(max_bytes)),
        "send less: leave out build folders, and traces in an archive of sources";
    /// A request other than an upload is too large.
    too_long(max_bytes: usize): 413, "too-large", "Too large",
        format!("more than the {} that are allowed", format_size(max_bytes as u64)),
        "send less in one request";
    /// The URL does not support the method.
    wrong_method(method: &str): 405, "wrong-method", "Not supported here",
        format!("this URL does not accept {method}"),
        "go back, and use the button on the page; programs find the methods in /api/openapi.json";
    /// The disk is nearly full.
    no_room(): 507, "no-room", "Not enough space",
        "the server's disk is nearly full; nothing was stored",
        "tell the administrator, and send the request again later";
    /// The limit of stored bytes is reached.
    quota(detail: impl Into<String>): 507, "quota", "No space for more uploads",
        detail,
        "ask the course's staff: the server's administrator can increase the limit, or remove old uploads; nothing \
                      was stored";
    /// The request's body arrived too slowly.
    too_slow(): 408, "too-slow", "Too slow",
        "the rest of the request did not arrive in time",
        "send it again";
    /// There were too many requests or submissions.
    too_many(detail: impl Into<String>): 429, "too-many", "Too many",
        detail,
        "wait, and try again";
    /// The server cannot answer at present; a retry may succeed.
    unavailable(detail: impl Into<String>): 503, "unavailable", "Not available",
        detail,
        "try again in a moment; accepted uploads are safe";
    /// The server failed, because of an error in it.
    fault(): 500, "fault", "The server failed",
        "something went wrong here",
        "try again, and tell the administrator; the log has details";
}

/// Checks a condition.
///
/// # Errors
/// Fails with `otherwise` if the condition does not hold.
pub(crate) fn ensure<E>(holds: bool, otherwise: E) -> Result<(), E> {
    if holds { Ok(()) } else { Err(otherwise) }
}

/// Formats a number of bytes with a short unit, such as `1.5 MiB`.
pub(crate) fn format_size(bytes: u64) -> String {
    match bytes {
        few @ ..1024 => format!("{few} B"),
        some @ ..1_048_576 => format!("{} KiB", (some + 512) / 1024),
        many => match (many + 524_288) / 1_048_576 {
            whole if whole % 1_048_576 == 0 => format!("{} TiB", whole / 1_048_576),
            whole if whole % 1024 == 0 || whole > 10_240 => format!("{} GiB", (whole + 512) / 1024),
            some => format!("{some} MiB"),
        },
    }
}

impl From<DbError> for Problem {
    fn from(error: DbError) -> Self {
        if error.is_transient() {
            tracing::warn!(%error, "the database did not answer");
            return Self::unavailable("the database does not answer");
        }
        tracing::error!(%error, "a statement failed");
        Self::fault()
    }
}

impl From<StoreError> for Problem {
    fn from(error: StoreError) -> Self {
        tracing::error!(%error, "the store failed");
        match error {
            StoreError::Missing(_) => Self::not_found("file"),
            StoreError::Damaged(_) => Self::fault(),
            StoreError::Failed(_) => Self::unavailable("the file store does not work"),
        }
    }
}

impl From<std::io::Error> for Problem {
    fn from(error: std::io::Error) -> Self {
        tracing::error!(%error, "a file could not be used");
        Self::unavailable("the server can't use its folder")
    }
}
