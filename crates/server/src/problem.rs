//! What goes wrong, as those who asked are told: what it is, and how to mend it (RFC 9457, problem+json).
use crate::{db::DbError, store::StoreError};
use axum::{
    http::{HeaderValue, StatusCode, header},
    response::{IntoResponse, Response},
};
use serde::Serialize;
use utoipa::ToSchema;

/// Why a request was refused.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, ToSchema)]
pub struct Problem {
    /// A name that programs may go by.
    #[serde(rename = "type")]
    pub kind: String,
    /// The same in words.
    pub title: String,
    /// The status of the answer.
    pub status: u16,
    /// What is wrong with this request.
    pub detail: String,
    /// What to do about it.
    pub remedy: String,
}

impl Problem {
    fn new(status: StatusCode, kind: &str, title: &str, detail: impl Into<String>, remedy: &str) -> Self {
        Self {
            kind: format!("urn:fosssim:{kind}"),
            title: title.to_owned(),
            status: status.as_u16(),
            detail: detail.into(),
            remedy: remedy.to_owned(),
        }
    }

    /// Nobody has said who asks.
    #[must_use]
    pub fn not_signed_in() -> Self {
        Self::new(
            StatusCode::UNAUTHORIZED,
            "not-signed-in",
            "Not signed in",
            "this needs somebody who is signed in",
            "sign in, or send a token: Authorization: Bearer fso_...",
        )
    }

    /// The token, session or link is none of ours, or not any more.
    #[must_use]
    pub fn unknown_secret(what: &str) -> Self {
        Self::new(
            StatusCode::UNAUTHORIZED,
            "unknown-secret",
            "Not signed in",
            format!("this {what} is unknown, used, too old or revoked"),
            "ask for a new one",
        )
    }

    /// No account has this login and this password.
    #[must_use]
    pub fn wrong_password() -> Self {
        let detail = "there is no account of this login with this password";
        let remedy = "try again, or ask the course's staff for a link that signs you in";
        Self::new(StatusCode::UNAUTHORIZED, "wrong-password", "Not signed in", detail, remedy)
    }

    /// Known, and not allowed.
    #[must_use]
    pub fn not_allowed(detail: impl Into<String>) -> Self {
        let remedy = "ask somebody whose role allows it";
        Self::new(StatusCode::FORBIDDEN, "not-allowed", "Not allowed", detail, remedy)
    }

    /// Known, but it is not certain that it is the person.
    #[must_use]
    pub fn sign_in_again(detail: impl Into<String>) -> Self {
        let remedy = "sign in again on this server's pages, and do it there";
        Self::new(StatusCode::FORBIDDEN, "sign-in-again", "Sign in again", detail, remedy)
    }

    /// A request that another site may have made a browser send.
    #[must_use]
    pub fn cross_site() -> Self {
        Self::new(
            StatusCode::FORBIDDEN,
            "cross-site",
            "Sent from another site",
            "the browser says that another site sent this, or nothing says who did",
            "send it from this site's own pages, or with a token instead of a cookie",
        )
    }

    /// Somebody can't come from a learning platform so.
    #[must_use]
    pub fn refused_launch(detail: impl Into<String>) -> Self {
        let remedy =
            "go back to the platform and open it there again; if this comes again, show it to who runs this server";
        Self::new(StatusCode::FORBIDDEN, "launch-refused", "You can't come in so", detail, remedy)
    }

    /// A learning platform did not do what it was asked.
    #[must_use]
    pub fn platform_failed(detail: impl Into<String>) -> Self {
        let remedy = "try again later; if this comes again, show it to who runs this server";
        Self::new(StatusCode::BAD_GATEWAY, "platform-failed", "The learning platform failed", detail, remedy)
    }

    /// There is no such thing, or none that whoever asks may know of.
    #[must_use]
    pub fn not_found(what: &str) -> Self {
        let detail = format!("there is no such {what}, or you may not see it");
        Self::new(StatusCode::NOT_FOUND, "not-found", "Not found", detail, "check the address")
    }

    /// It was there, and is not kept any longer.
    #[must_use]
    pub fn removed() -> Self {
        let detail = "the upload and its reports are not kept any longer; the grade and its history are";
        Self::new(StatusCode::GONE, "removed", "Not kept any longer", detail, "ask the course's staff about the grade")
    }

    /// Something in the request is not as it must be.
    #[must_use]
    pub fn invalid(detail: impl Into<String>) -> Self {
        Self::new(StatusCode::BAD_REQUEST, "invalid", "Not understood", detail, "correct it and send it again")
    }

    /// It can't be done in the state that things are in.
    #[must_use]
    pub fn conflict(detail: impl Into<String>, remedy: &str) -> Self {
        Self::new(StatusCode::CONFLICT, "conflict", "Not possible now", detail, remedy)
    }

    /// The upload is no submission.
    #[must_use]
    pub fn unusable(detail: impl Into<String>) -> Self {
        let remedy = "mend the file and upload it again; nothing was counted";
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, "unusable-upload", "This can't be graded", detail, remedy)
    }

    /// More bytes than allowed.
    #[must_use]
    pub fn too_large(most: u64) -> Self {
        let detail = format!("more than the {} bytes that are allowed", most);
        let remedy = "send less: no build folders, no traces in an archive of sources";
        Self::new(StatusCode::PAYLOAD_TOO_LARGE, "too-large", "Too large", detail, remedy)
    }

    /// The disk is nearly full.
    #[must_use]
    pub fn no_room() -> Self {
        let detail = "the server's disk is nearly full; nothing was stored";
        let remedy = "tell the administrator, and send it again later";
        Self::new(StatusCode::INSUFFICIENT_STORAGE, "no-room", "No room", detail, remedy)
    }

    /// As many bytes are kept as may be.
    #[must_use]
    pub fn quota(detail: impl Into<String>) -> Self {
        let remedy = "ask the course's staff: the server's administrator can give more room, or have old uploads removed; \
                      nothing was stored";
        Self::new(StatusCode::INSUFFICIENT_STORAGE, "quota", "No room for more uploads", detail, remedy)
    }

    /// A range of a file that does not reach so far.
    #[must_use]
    pub fn beyond(size: u64) -> Self {
        let detail = format!("the file has {size} bytes, and none in this range");
        Self::new(StatusCode::RANGE_NOT_SATISFIABLE, "range", "Not that long", detail, "ask for an earlier range")
    }

    /// The body came too slowly.
    #[must_use]
    pub fn too_slow() -> Self {
        let detail = "the rest of the request did not come in time";
        Self::new(StatusCode::REQUEST_TIMEOUT, "too-slow", "Too slow", detail, "send it again")
    }

    /// Too many requests or submissions.
    #[must_use]
    pub fn too_many(detail: impl Into<String>) -> Self {
        Self::new(StatusCode::TOO_MANY_REQUESTS, "too-many", "Too many", detail, "wait, and try again")
    }

    /// Our fault, and it may pass.
    #[must_use]
    pub fn unavailable(detail: impl Into<String>) -> Self {
        let remedy = "try again in a moment; what was accepted is safe";
        Self::new(StatusCode::SERVICE_UNAVAILABLE, "unavailable", "Not available", detail, remedy)
    }

    /// Our fault.
    #[must_use]
    pub fn fault() -> Self {
        let remedy = "try again, and tell the administrator: the log says more";
        Self::new(StatusCode::INTERNAL_SERVER_ERROR, "fault", "The server failed", "something went wrong here", remedy)
    }

    /// The status of the answer.
    #[must_use]
    pub fn status(&self) -> StatusCode {
        StatusCode::from_u16(self.status).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR)
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
            StoreError::TooLarge(most) => Self::too_large(most),
            StoreError::Missing(_) => Self::not_found("file"),
            StoreError::Damaged(_) => Self::fault(),
            StoreError::Failed(_) => Self::unavailable("the store of files does not work"),
        }
    }
}

impl From<std::io::Error> for Problem {
    fn from(error: std::io::Error) -> Self {
        tracing::error!(%error, "a file could not be used");
        Self::unavailable("the server can't use its folder")
    }
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let body = serde_json::to_vec(&self).unwrap_or_default();
        let mut response = (self.status(), body).into_response();
        let headers = response.headers_mut();
        headers.insert(header::CONTENT_TYPE, HeaderValue::from_static("application/problem+json"));
        match self.status() {
            StatusCode::UNAUTHORIZED => {
                headers.insert(header::WWW_AUTHENTICATE, HeaderValue::from_static("Bearer"));
            }
            StatusCode::SERVICE_UNAVAILABLE | StatusCode::TOO_MANY_REQUESTS => {
                headers.insert(header::RETRY_AFTER, HeaderValue::from_static("5"));
            }
            _ => {}
        }
        // Pages show it in their own way.
        response.extensions_mut().insert(self);
        response
    }
}
