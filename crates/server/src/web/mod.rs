//! What is spoken over HTTP: the API, the pages, and what holds for both.

pub mod api;
mod description;
mod download;
mod guard;
mod input;
pub mod pages;
mod refusal;
mod status;
mod upload;
mod who;

use crate::{access::House, problem::Problem};
use axum::{Router, extract::DefaultBodyLimit, middleware};
use utoipa_axum::router::OpenApiRouter;

/// The largest body of a request that is no upload.
const BODY: usize = 1 << 20;

/// The same of somebody who is not signed in: a password, a token, or a learning platform's word. Thousands of them may
/// send one at the same time.
const BODY_OF_NOBODY: usize = 32 << 10;

fn api_router() -> (Router<House>, utoipa::openapi::OpenApi) {
    let (router, mut description) =
        OpenApiRouter::with_openapi(description::base()).merge(api::routes()).split_for_parts();
    description::complete(&mut description);
    (router, description)
}

/// The description of the API, as it is served and committed.
pub fn openapi() -> String {
    let mut text = api_router().1.to_pretty_json().unwrap_or_default();
    text.push('\n');
    text
}

/// Receives a form with an upload that came in pieces of so many bytes, into a folder that is empty again afterwards:
/// what the fuzzer of uploads, and tests, hand bytes to. The size of the file, and what the form says: its name, its
/// kind, and its key.
///
/// # Errors
/// What is wrong with the form.
pub async fn receive_form(
    incoming: &std::path::Path,
    body: &[u8],
    pieces: usize,
    most: u64,
) -> Result<(u64, [Option<String>; 3]), Problem> {
    upload::receive_form(incoming, body, pieces, most).await
}

/// Everything that is served.
pub fn router(house: House) -> Router {
    let (api, _) = api_router();
    let pages = pages::router().layer(middleware::from_fn_with_state(house.clone(), pages::show_problems));
    Router::new()
        .merge(api)
        .merge(pages)
        .fallback(async || Problem::not_found("page"))
        // Whoever reads a body counts it: what is allowed differs.
        .layer(DefaultBodyLimit::disable())
        .layer(middleware::from_fn_with_state(house.clone(), guard::same_site))
        .layer(middleware::from_fn_with_state(house.clone(), guard::renew))
        .layer(middleware::from_fn_with_state(house.clone(), guard::headers))
        .layer(middleware::from_fn_with_state(house.clone(), guard::log))
        .with_state(house)
}
