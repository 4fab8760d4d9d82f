//! The HTTP API. The first argument of each handler names the role that it serves.

/// Declares operations that return data, one per row. A row has the method, the path, the tag and the name; then the
/// role that the operation serves, the parts of the path and the body; and last the type of the answer. The status
/// of all answers comes before the rows.
macro_rules! answers {
    ($status:ident: $($(#[doc = $doc:literal])* $method:ident $path:tt $tag:tt
        $name:ident($sender:ident: $role:ty $(, { $($at:ident),* })? $(, ?$query:ident: $kind:ty)?
            $(, $input:ident: $body:ty)?) -> $type:ty: $answer:expr;)*) => {
        $($(#[doc = $doc])*
        #[utoipa::path($method, path = $path, tag = $tag $(, params($kind))? $(, request_body = $body)?,
            responses((status = $status, body = $type)))]
        pub(super) async fn $name(
            $sender: $role $(, UrlPathParts { $($at,)* .. }: UrlPathParts)? $(, QueryInput($query): QueryInput<$kind>)?
                $(, Body($input): Body<$body>)?
        ) -> Result<(StatusCode, Json<$type>), Problem> {
            Ok((StatusCode::$status, Json($answer.await?.into())))
        })*
    };
}

/// Declares operations that perform an action and answer with a sentence about the result, one per row.
macro_rules! actions {
    ($status:ident: $($(#[doc = $doc:literal])* $method:ident $path:tt $tag:tt
        $name:ident($sender:ident: $role:ty $(, { $($at:ident),* })? $(, ?$query:ident: $kind:ty)?
            $(, $input:ident: $body:ty)?) -> $done:tt: $do:expr;)*) => {
        $($(#[doc = $doc])*
        #[utoipa::path($method, path = $path, tag = $tag $(, params($kind))? $(, request_body = $body)?,
            responses((status = $status, description = $done)))]
        pub(super) async fn $name(
            $sender: $role $(, UrlPathParts { $($at,)* .. }: UrlPathParts)? $(, QueryInput($query): QueryInput<$kind>)?
                $(, Body($input): Body<$body>)?
        ) -> Result<StatusCode, Problem> {
            $do.await?;
            Ok(StatusCode::$status)
        })*
    };
}

mod accounts;
mod assignments;
mod courses;
mod operations;
mod platforms;
mod regrades;
mod submissions;
mod workers;

pub(super) use accounts::{TokenName, WorkerTokenName};
pub(super) use assignments::{Revision, receive_suite};
pub(super) use courses::CourseInput;
pub use submissions::export_csv;
pub(super) use submissions::{ReviewRequest, receive, write_csv};

use crate::domain::App;
use utoipa_axum::{router::OpenApiRouter, routes};

/// Builds a router with the operations that each module declares.
macro_rules! operations {
    ($($module:ident: $($operation:ident)*;)*) => {
        pub(super) fn routes() -> OpenApiRouter<App> {
            OpenApiRouter::new()$($(.routes(routes!($module::$operation)))*)*
        }
    };
}

operations! {
    operations: health ready metrics openapi;
    accounts: show_own_account tokens new_token revoke_token accounts set_account disable_account remove_person
        worker_tokens new_worker_token revoke_worker_token queue audit;
    courses: courses new_course remove_course members import set_member remove_member member_link course_audit;
    assignments: assignments assignment set_assignment remove_assignment set_suite publish withhold standings export
        extend extend_no_more;
    submissions: own submit submission remove_submission mark request history report upload grade_again
        grade_errors_again grade_all_errors_again;
    regrades: regrades begin show apply discard;
    platforms: platforms set_platform shut_platform new_key roster scores send_scores;
    workers: tick claim renew release fail finish artifact store;
}
