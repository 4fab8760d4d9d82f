//! Sending artefacts: in pieces as they are read, whole or a range, and not at all to who has them.
use crate::{
    access::{Member, Transfer},
    problem::Problem,
    store::{Artefact, Opened},
};
use axum::{
    body::Body,
    http::{HeaderMap, HeaderValue, StatusCode, header},
    response::{IntoResponse, Response},
};
use futures_util::TryStreamExt;
use std::ops::Range;

/// Answers with an artefact, as far as the request's headers ask for it.
pub(super) async fn send(member: &Member, asked: &HeaderMap, artefact: &Artefact) -> Result<Response, Problem> {
    let transfer = member.transfer()?;
    let tag = format!("\"{}\"", artefact.digest);
    let of_request = |name| asked.get(name).and_then(|value: &HeaderValue| value.to_str().ok());
    let names_it =
        |tags: &str| tags == "*" || tags.split(',').any(|other| other.trim().trim_start_matches("W/") == tag);
    let mut response = if of_request(header::IF_NONE_MATCH).is_some_and(names_it) {
        StatusCode::NOT_MODIFIED.into_response()
    } else {
        // A part of what it was before would be of no use.
        let same = of_request(header::IF_RANGE).is_none_or(|other| other == tag);
        let range = of_request(header::RANGE).filter(|_| same).map(|range| part(range, artefact.size));
        match range.unwrap_or(Part::All) {
            Part::All => whole(member.open(artefact, None).await?, Some(transfer)),
            Part::Of(range) => {
                let said = format!("bytes {}-{}/{}", range.start, range.end - 1, artefact.size);
                let mut response = body(member.open(artefact, Some(range.clone())).await?, range, Some(transfer));
                *response.status_mut() = StatusCode::PARTIAL_CONTENT;
                insert(&mut response, header::CONTENT_RANGE, &said);
                response
            }
            Part::Beyond => {
                let mut response = Problem::beyond(artefact.size).into_response();
                insert(&mut response, header::CONTENT_RANGE, &format!("bytes */{}", artefact.size));
                return Ok(response);
            }
        }
    };
    insert(&mut response, header::ETAG, &tag);
    insert(&mut response, header::ACCEPT_RANGES, "bytes");
    Ok(response)
}

/// All of an artefact.
pub(super) fn whole(opened: Opened, transfer: Option<Transfer>) -> Response {
    let range = 0..opened.size;
    body(opened, range, transfer)
}

fn body(opened: Opened, range: Range<u64>, transfer: Option<Transfer>) -> Response {
    let pieces = opened.pieces.inspect_err(move |error| {
        // The answer breaks off; anybody who gets it sees that bytes are missing.
        tracing::error!(%error, "an answer broke off");
        let _of_this_answer = &transfer;
    });
    let mut response = Body::from_stream(pieces).into_response();
    insert(&mut response, header::CONTENT_LENGTH, &(range.end - range.start).to_string());
    response
}

fn insert(response: &mut Response, name: header::HeaderName, value: &str) {
    if let Ok(value) = HeaderValue::from_str(value) {
        response.headers_mut().insert(name, value);
    }
}

/// The range that `Range` asks for.
#[derive(Debug, PartialEq, Eq)]
enum Part {
    /// Everything: also where it asks for something that is not understood, or for several parts.
    All,
    Of(Range<u64>),
    /// Nothing that is there.
    Beyond,
}

fn part(text: &str, size: u64) -> Part {
    let Some((first, last)) = text.strip_prefix("bytes=").and_then(|range| range.trim().split_once('-')) else {
        return Part::All;
    };
    let range = match (first.parse::<u64>(), last.parse::<u64>()) {
        (Ok(first), Ok(last)) if first <= last => first..last.saturating_add(1).min(size),
        (Ok(first), Err(_)) if last.is_empty() => first..size,
        (Err(_), Ok(count)) if first.is_empty() => size.saturating_sub(count)..size,
        _ => return Part::All,
    };
    if range.start < range.end { Part::Of(range) } else { Part::Beyond }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_understood_or_ignored() {
        for (text, expected) in [
            ("bytes=0-9", Part::Of(0..10)),
            ("bytes=90-", Part::Of(90..100)),
            ("bytes=-10", Part::Of(90..100)),
            ("bytes=-1000", Part::Of(0..100)),
            ("bytes=90-18446744073709551615", Part::Of(90..100)),
            ("bytes=100-", Part::Beyond),
            ("bytes=-0", Part::Beyond),
            ("bytes=5-3", Part::All),
            ("bytes=0-1,5-6", Part::All),
            ("lines=1-2", Part::All),
        ] {
            assert_eq!(part(text, 100), expected, "{text}");
        }
    }
}
