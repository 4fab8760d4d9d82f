//! The API. Each handler says by its first argument whom it serves.

/// Operations that answer with what was asked for, one a row: method, address, tag, and name; whom it serves, which
/// parts of the address it takes, and its body; and what it answers with.
macro_rules! answers {
    ($($(#[doc = $doc:literal])* $method:ident $path:tt $tag:tt
        $name:ident($who:ident: $role:ty $(, { $($at:ident),* })? $(, $wish:ident: $body:ty)?)
            -> $type:ty: $answer:expr;)*) => {
        $($(#[doc = $doc])*
        #[utoipa::path($method, path = $path, tag = $tag $(, request_body = $body)?,
            responses((status = 200, body = $type)))]
        pub(super) async fn $name(
            $who: $role $(, At { $($at,)* .. }: At)? $(, Body($wish): Body<$body>)?
        ) -> Result<Json<$type>, Problem> {
            Ok(Json($answer.await?.into()))
        })*
    };
}

/// The same for those that only do something: then it is said in words what was done.
macro_rules! deeds {
    ($($(#[doc = $doc:literal])* $method:ident $path:tt $tag:tt
        $name:ident($who:ident: $role:ty $(, { $($at:ident),* })? $(, $wish:ident: $body:ty)?)
            -> $done:tt: $do:expr;)*) => {
        $($(#[doc = $doc])*
        #[utoipa::path($method, path = $path, tag = $tag $(, request_body = $body)?,
            responses((status = 204, description = $done)))]
        pub(super) async fn $name(
            $who: $role $(, At { $($at,)* .. }: At)? $(, Body($wish): Body<$body>)?
        ) -> Result<StatusCode, Problem> {
            $do.await?;
            Ok(StatusCode::NO_CONTENT)
        })*
    };
}

mod accounts;
mod again;
mod assignments;
mod courses;
mod operations;
mod platforms;
mod regrades;
mod submissions;
mod suspicions;
mod workers;

pub(super) use accounts::{PasswordWish, TokenName, WorkerTokenName};
pub(super) use assignments::receive_suite;
pub(super) use courses::CourseWish;
pub use submissions::export_csv;
pub(super) use submissions::{RequestWish, cell, receive, report_response, upload_response};

use crate::access::App;
use utoipa_axum::{router::OpenApiRouter, routes};

pub(super) fn routes() -> OpenApiRouter<App> {
    OpenApiRouter::new()
        .routes(routes!(operations::health))
        .routes(routes!(operations::ready))
        .routes(routes!(operations::metrics))
        .routes(routes!(operations::openapi))
        .routes(routes!(accounts::me))
        .routes(routes!(accounts::set_password))
        .routes(routes!(accounts::tokens, accounts::new_token))
        .routes(routes!(accounts::revoke_token))
        .routes(routes!(accounts::accounts))
        .routes(routes!(accounts::set_account, accounts::disable_account))
        .routes(routes!(accounts::remove_person))
        .routes(routes!(accounts::worker_tokens, accounts::new_worker_token))
        .routes(routes!(accounts::revoke_worker_token))
        .routes(routes!(accounts::queue))
        .routes(routes!(accounts::audit))
        .routes(routes!(courses::courses, courses::new_course))
        .routes(routes!(courses::remove_course))
        .routes(routes!(courses::archive, courses::reopen))
        .routes(routes!(courses::members, courses::import))
        .routes(routes!(courses::set_member, courses::remove_member))
        .routes(routes!(courses::member_link))
        .routes(routes!(courses::audit))
        .routes(routes!(assignments::assignments))
        .routes(routes!(assignments::assignment, assignments::set_assignment, assignments::remove_assignment))
        .routes(routes!(assignments::set_suite))
        .routes(routes!(assignments::publish, assignments::withhold))
        .routes(routes!(assignments::standings))
        .routes(routes!(assignments::export))
        .routes(routes!(submissions::own, submissions::submit))
        .routes(routes!(submissions::submission, submissions::remove_submission))
        .routes(routes!(submissions::mark))
        .routes(routes!(submissions::request))
        .routes(routes!(assignments::extend, assignments::extend_no_more))
        .routes(routes!(submissions::history))
        .routes(routes!(submissions::events))
        .routes(routes!(submissions::report))
        .routes(routes!(submissions::upload))
        .routes(routes!(again::grade_again))
        .routes(routes!(again::grade_errors_again))
        .routes(routes!(again::grade_all_errors_again))
        .routes(routes!(regrades::regrades, regrades::begin))
        .routes(routes!(regrades::show))
        .routes(routes!(regrades::apply))
        .routes(routes!(regrades::discard))
        .routes(routes!(suspicions::suspicions))
        .routes(routes!(suspicions::dismiss))
        .routes(routes!(suspicions::tell))
        .routes(routes!(platforms::platforms))
        .routes(routes!(platforms::set_platform, platforms::shut_platform))
        .routes(routes!(platforms::new_key))
        .routes(routes!(platforms::roster))
        .routes(routes!(platforms::scores, platforms::send_scores))
        .routes(routes!(workers::tick))
        .routes(routes!(workers::claim))
        .routes(routes!(workers::renew))
        .routes(routes!(workers::release))
        .routes(routes!(workers::fail))
        .routes(routes!(workers::finish))
        .routes(routes!(workers::artefact, workers::store))
}
