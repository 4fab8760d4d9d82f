//! The HTTP server: the API, the pages, and rules for both.

pub mod api;
mod archive_check;
mod description;
mod download;
mod guard;
mod identification;
mod input;
pub mod pages;
mod problem_response;
mod upload;

pub use upload::{check_archive, receive_form};

use crate::domain::App;
use axum::{Extension, Router, extract::DefaultBodyLimit, middleware};
use axum_client_ip::ClientIpSource;
use utoipa_axum::router::OpenApiRouter;

/// The maximum size of a request's body that is not an upload, in bytes.
const MAX_BODY: usize = 1 << 20;

/// The maximum size in bytes of a body from a sender who is not signed in, such as a token or a learning platform's
/// message. Thousands may be sent at the same time.
const MAX_GUEST_BODY: usize = 32 << 10;

fn api_router() -> (Router<App>, utoipa::openapi::OpenApi) {
    let (router, mut description) =
        OpenApiRouter::with_openapi(description::base_description()).merge(api::routes()).split_for_parts();
    description::complete(&mut description);
    (router, description)
}

/// Returns the description of the API as JSON. The server serves this text, and `schemas/` contains it.
pub fn openapi() -> String {
    let mut text = api_router().1.to_pretty_json().unwrap_or_default();
    text.push('\n');
    text
}

/// Returns the router for all requests.
pub fn router(app: App) -> Router {
    let (api, _) = api_router();
    let client_ip_source = app.client_ip_source.clone().unwrap_or(ClientIpSource::ConnectInfo);
    let pages = pages::router().layer(middleware::from_fn_with_state(app.clone(), pages::show_problems));
    Router::new()
        .merge(api)
        .merge(pages)
        .fallback(pages::missing_page)
        .method_not_allowed_fallback(pages::wrong_method)
        // Each function that reads a body enforces its own limit.
        .layer(DefaultBodyLimit::disable())
        .layer(middleware::from_fn_with_state(app.clone(), guard::check_site))
        .layer(middleware::from_fn_with_state(app.clone(), pages::show_other_problems))
        .layer(middleware::from_fn_with_state(app.clone(), guard::renew_cookie))
        .layer(middleware::from_fn_with_state(app.clone(), guard::add_headers))
        .layer(middleware::from_fn_with_state(app.clone(), guard::log_request))
        .layer(Extension(client_ip_source))
        .with_state(app)
}
