//! HTTP: the API, the pages, and the rules for both.

pub mod api;
mod description;
mod download;
mod guard;
mod input;
mod look;
pub mod pages;
mod refusal;
mod upload;
mod who;

pub use upload::{look_through, receive_form};

use crate::domain::App;
use axum::{Extension, Router, extract::DefaultBodyLimit, middleware};
use axum_client_ip::ClientIpSource;
use utoipa_axum::router::OpenApiRouter;

/// The largest body of a request that is no upload.
const BODY: usize = 1 << 20;

/// The limit before sign-in: a token, or a learning platform's message. Thousands may be sent at the same time.
const BODY_OF_NOBODY: usize = 32 << 10;

fn api_router() -> (Router<App>, utoipa::openapi::OpenApi) {
    let (router, mut description) =
        OpenApiRouter::with_openapi(description::base()).merge(api::routes()).split_for_parts();
    description::complete(&mut description);
    (router, description)
}

/// Returns the description of the API, as it is served and committed.
pub fn openapi() -> String {
    let mut text = api_router().1.to_pretty_json().unwrap_or_default();
    text.push('\n');
    text
}

/// Returns everything that is served.
pub fn router(app: App) -> Router {
    let (api, _) = api_router();
    let client_address = app.client_address.clone().unwrap_or(ClientIpSource::ConnectInfo);
    let pages = pages::router().layer(middleware::from_fn(pages::show_problems));
    Router::new()
        .merge(api)
        .merge(pages)
        .fallback(pages::missing)
        .method_not_allowed_fallback(pages::wrong_method)
        // Every reader of a body counts it: the limits differ.
        .layer(DefaultBodyLimit::disable())
        .layer(middleware::from_fn_with_state(app.clone(), guard::same_site))
        .layer(middleware::from_fn(pages::show_others))
        .layer(middleware::from_fn_with_state(app.clone(), guard::renew))
        .layer(middleware::from_fn_with_state(app.clone(), guard::headers))
        .layer(middleware::from_fn_with_state(app.clone(), guard::log))
        .layer(Extension(client_address))
        .with_state(app)
}
