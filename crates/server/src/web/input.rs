//! Reads the parts of requests. If a part is invalid, the answer names the fault.
use crate::{
    domain::App,
    problem::{Problem, ensure},
};
use axum::{
    extract::{FromRequest, FromRequestParts, MatchedPath, Path, Query, Request},
    http::{HeaderMap, Method, header, request::Parts},
};
use futures_util::StreamExt;
use serde::{Deserialize, Deserializer, de::DeserializeOwned};
use serde_json::{Map, Value};
use std::time::Instant;
use utoipa::IntoParams;

/// The JSON value in a request's body.
pub(super) struct Body<T>(pub(super) T);

/// The text in a request's body.
pub(super) struct TextBody(pub(super) String);

/// The fields of a form, from the body of a request, or from the query of a GET request.
pub(super) struct Fields<T>(pub(super) T);

/// The names in a URL. Names that the route does not have are empty.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct UrlPathParts {
    pub(super) course: String,
    pub(super) assignment: String,
    pub(super) login: String,
    pub(super) name: String,
    pub(super) digest: String,
    pub(super) secret: String,
    pub(super) id: i64,
}

/// The query parameters in a URL.
pub(super) struct QueryInput<T>(pub(super) T);

/// The query parameter with the newest event that the sender of a change has seen.
#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct SeenEvent {
    /// The ID of the newest event of the audit log that the sender has seen. If the object of the request was
    /// changed after that event, the request is rejected. Without this parameter, it is not checked.
    #[param(maximum = 9_007_199_254_740_991_i64)]
    seen: Option<u64>,
}

impl SeenEvent {
    /// Returns the ID of the event that was seen, if the request names one, in the type of the database.
    pub(super) fn event(&self) -> Option<i64> {
        self.seen.map(|seen| i64::try_from(seen).unwrap_or(i64::MAX))
    }
}

/// The query parameter for the beginning of a list.
#[derive(Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub(super) struct ListStart {
    /// Only changes after the submission with this ID, which is `next` in the previous answer.
    pub(super) after: Option<i64>,
}

/// Rejects a request if the media type of its body is not `media_type`.
fn check_type(headers: &HeaderMap, media_type: &str, message: &str) -> Result<(), Problem> {
    let value = headers.get(header::CONTENT_TYPE).and_then(|value| value.to_str().ok()).unwrap_or_default();
    let is_expected = value.split(';').next().is_some_and(|value| value.trim().eq_ignore_ascii_case(media_type));
    ensure(is_expected, Problem::invalid(message))
}

/// The time at which a request's head arrived.
#[derive(Clone, Copy)]
pub(super) struct ArrivalTime(pub(super) Instant);

/// Marks a request whose sender is signed in, so that a larger body may be read.
#[derive(Clone, Copy)]
pub(super) struct SignedIn;

/// Reads a request's body. It must be small unless the sender is signed in.
async fn read_body(request: Request, app: &App) -> Result<Vec<u8>, Problem> {
    let limit = if request.extensions().get::<SignedIn>().is_some() { super::MAX_BODY } else { super::MAX_GUEST_BODY };
    let reading = async {
        let mut stream = request.into_body().into_data_stream();
        let mut bytes = Vec::new();
        while let Some(chunk) = stream.next().await {
            bytes.extend_from_slice(&chunk.map_err(|_| Problem::invalid("the request was interrupted"))?);
            ensure(bytes.len() <= limit, Problem::too_long(limit))?;
        }
        Ok(bytes)
    };
    tokio::time::timeout(app.max_pause, reading).await.map_err(|_| Problem::too_slow())?
}

/// Converts whole numbers such as `7.0` to integers. Some languages write integers in this form, and JSON Schema
/// accepts it.
fn fix_integers(value: &mut Value) {
    match value {
        Value::Number(number) => {
            let integer = number.as_f64().filter(|x| x.fract() == 0.0 && x.abs() < 9e15);
            // The conversion is exact below 2^53.
            #[expect(clippy::cast_possible_truncation, reason = "whole and small")]
            if let (false, Some(integer)) = (number.is_i64() || number.is_u64(), integer) {
                *value = Value::from(integer as i64);
            }
        }
        Value::Array(values) => values.iter_mut().for_each(fix_integers),
        Value::Object(fields) => fields.values_mut().for_each(fix_integers),
        _ => {}
    }
}

/// Parses JSON in which an integer may be written like `7.0`.
fn parse_with_whole_floats<T: DeserializeOwned>(bytes: &[u8]) -> Option<T> {
    let mut value = serde_json::from_slice(bytes).ok()?;
    fix_integers(&mut value);
    serde_json::from_value(value).ok()
}

/// Reads the fields of an object, in which an integer may be written like `7.0`. Their types are checked later.
pub(super) fn read_fields<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Map<String, Value>, D::Error> {
    let mut fields = Map::deserialize(deserializer)?;
    fields.values_mut().for_each(fix_integers);
    Ok(fields)
}

impl<T: DeserializeOwned> FromRequest<App> for Body<T> {
    type Rejection = Problem;

    async fn from_request(request: Request, state: &App) -> Result<Self, Problem> {
        check_type(request.headers(), "application/json", "the body must be JSON: Content-Type: application/json")?;
        let bytes = read_body(request, state).await?;
        let read = serde_json::from_slice(&bytes);
        let read = read.or_else(|error| parse_with_whole_floats(&bytes).ok_or(error));
        read.map(Self).map_err(|error| Problem::invalid(error.to_string()))
    }
}

impl FromRequest<App> for TextBody {
    type Rejection = Problem;

    async fn from_request(request: Request, state: &App) -> Result<Self, Problem> {
        check_type(request.headers(), "text/csv", "the body must be CSV: Content-Type: text/csv")?;
        let bytes = read_body(request, state).await?;
        String::from_utf8(bytes).map(Self).map_err(|_| Problem::invalid("the table must be in UTF-8"))
    }
}

impl<T: DeserializeOwned> FromRequest<App> for Fields<T> {
    type Rejection = Problem;

    async fn from_request(request: Request, state: &App) -> Result<Self, Problem> {
        if matches!(*request.method(), Method::GET | Method::HEAD) {
            let QueryInput(form) = QueryInput::from_request_parts(&mut request.into_parts().0, state).await?;
            return Ok(Self(form));
        }
        check_type(request.headers(), "application/x-www-form-urlencoded", "the body must be a form")?;
        let bytes = read_body(request, state).await?;
        let request = Request::builder()
            .method("POST")
            .header(header::CONTENT_TYPE, "application/x-www-form-urlencoded")
            .body(axum::body::Body::from(bytes))
            .map_err(|_| Problem::fault())?;
        let form = axum::Form::<T>::from_request(request, state).await;
        form.map(|axum::Form(form)| Self(form)).map_err(|error| Problem::invalid(error.to_string()))
    }
}

impl<S: Send + Sync> FromRequestParts<S> for UrlPathParts {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        let found = Path::<Self>::from_request_parts(parts, state).await;
        // If the text in the URL is not a number, the page does not exist.
        let route = parts.extensions.get::<MatchedPath>().map_or("", MatchedPath::as_str);
        let is_submission = ["/s/{id}", "/submissions/{id}"].iter().any(|part| route.contains(part));
        let what = if is_submission { "submission" } else { "page" };
        found.map(|Path(found)| found).map_err(|_| Problem::not_found(what))
    }
}

impl<T: DeserializeOwned, S: Send + Sync> FromRequestParts<S> for QueryInput<T> {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Problem> {
        let found = Query::<T>::from_request_parts(parts, state).await;
        found.map(|Query(found)| Self(found)).map_err(|error| Problem::invalid(error.body_text()))
    }
}
