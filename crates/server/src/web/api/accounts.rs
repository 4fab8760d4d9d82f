//! The API of accounts and tokens, and the lists that administrators see.
use super::super::input::{Body, QueryInput, UrlPathParts};
use crate::{
    domain::{Account, Admin, Event, EventQuery, Link, NewToken, Person, Queue, TokenInfo},
    problem::Problem,
    schema::{Slug, Title},
};
use axum::{Json, http::StatusCode};
use serde::Deserialize;
use utoipa::ToSchema;

/// The name of a new token.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::web) struct TokenName {
    #[schema(value_type = Title)]
    pub(in crate::web) name: String,
}

/// The name of a new token for workers.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::web) struct WorkerTokenName {
    #[schema(value_type = Slug)]
    pub(in crate::web) name: String,
}

/// The name and the rights that an account should have.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(as = AccountWish)]
pub(super) struct AccountUpdate {
    #[schema(value_type = Title)]
    name: String,
    #[serde(default)]
    is_admin: bool,
}

/// Returns the account of the person who is signed in.
#[utoipa::path(get, path = "/api/v1/me", tag = "accounts",
    responses((status = 200, body = Account)))]
pub(super) async fn show_own_account(person: Person) -> Json<Account> {
    Json(person.account.clone())
}

/// Creates a token for the person who is signed in.
#[utoipa::path(post, path = "/api/v1/tokens", tag = "accounts", security(("session" = [])), request_body = TokenName,
    responses((status = 201, body = NewToken)))]
pub(super) async fn new_token(
    person: Person,
    Body(input): Body<TokenName>,
) -> Result<(StatusCode, Json<NewToken>), Problem> {
    Ok((StatusCode::CREATED, Json(person.new_token(&input.name).await?)))
}

answers! { CREATED:
    /// Creates a token for workers on other machines.
    post "/api/v1/worker-tokens" "administration"
        new_worker_token(admin: Admin, input: WorkerTokenName) -> NewToken: admin.new_worker_token(&input.name);
}

answers! { OK:
    /// Creates an account or changes it, and returns a sign-in link, which works once.
    put "/api/v1/accounts/{login}" "administration"
        set_account(admin: Admin, { login }, input: AccountUpdate) -> Link:
            admin.set_account(&login, &input.name, input.is_admin);
    /// Lists the tokens of the person who is signed in.
    get "/api/v1/tokens" "accounts" tokens(person: Person) -> Vec<TokenInfo>: person.tokens();
    /// Lists all accounts.
    get "/api/v1/accounts" "administration" accounts(admin: Admin) -> Vec<Account>: admin.accounts();
    /// Lists the tokens of workers.
    get "/api/v1/worker-tokens" "administration" worker_tokens(admin: Admin) -> Vec<TokenInfo>: admin.worker_tokens();
    /// Returns the state of the queue and of the workers.
    get "/api/v1/queue" "administration" queue(admin: Admin) -> Queue: admin.queue();
    /// Returns the events of the audit log, newest first, 200 at a time.
    get "/api/v1/audit" "administration" audit(admin: Admin, ?query: EventQuery) -> Vec<Event>: admin.audit(&query);
}

actions! { NO_CONTENT:
    /// Revokes a token of the person who is signed in.
    delete "/api/v1/tokens/{id}" "accounts"
        revoke_token(person: Person, { id }) -> "Revoked": person.revoke_token(id);
    /// Closes an account.
    delete "/api/v1/accounts/{login}" "administration"
        disable_account(admin: Admin, { login }) -> "Shut": admin.disable_account(&login);
    /// Removes a person's submissions and results, their names, and every way to sign in. This cannot be undone.
    delete "/api/v1/accounts/{login}/data" "administration"
        remove_person(admin: Admin, { login }) -> "Removed": admin.remove_person(&login);
    /// Revokes a token of workers.
    delete "/api/v1/worker-tokens/{id}" "administration"
        revoke_worker_token(admin: Admin, { id }) -> "Revoked": admin.revoke_worker_token(id);
}
