//! One's courses and tokens.
use super::{
    super::{
        api::{PasswordWish, TokenName},
        input::{At, Fields},
    },
    Frame, see, show, text,
};
use crate::{
    access::{CourseOf, Invitation, Person, TokenInfo},
    problem::Problem,
};
use askama::Template;
use axum::response::{Html, Redirect};

#[derive(Template)]
#[template(path = "home.html")]
struct Home {
    frame: Frame,
    name: String,
    courses: Vec<CourseOf>,
    invitations: Vec<Invitation>,
    /// Whether they came in by a token, which makes no further ways in.
    is_by_token: bool,
}

#[derive(Template)]
#[template(path = "invitation.html")]
struct InvitationPage {
    frame: Frame,
    secret: String,
    invitation: Invitation,
    is_by_token: bool,
}

#[derive(Template)]
#[template(path = "account.html")]
struct AccountPage {
    frame: Frame,
    tokens: Vec<TokenInfo>,
    new: Option<String>,
    takes_passwords: bool,
    is_by_token: bool,
}

pub(super) async fn home(person: Person) -> Result<Html<String>, Problem> {
    let account = &person.account;
    let (courses, invitations) = (person.courses().await?, person.invitations().await?);
    let (name, is_by_token) = (account.name.clone(), person.is_by_token());
    show(&Home { frame: Frame::of(account), name, courses, invitations, is_by_token })
}

/// Opening the link does nothing yet.
pub(super) async fn invitation(person: Person, At { secret, .. }: At) -> Result<Html<String>, Problem> {
    let invitation = person.invitation(&secret).await?;
    let is_by_token = person.is_by_token();
    show(&InvitationPage { frame: Frame::of(&person.account), secret, invitation, is_by_token })
}

pub(super) async fn accept_by_link(person: Person, At { secret, .. }: At) -> Result<Redirect, Problem> {
    let course = person.accept_by_link(&secret).await?;
    Ok(see(&format!("/c/{}", course.slug)))
}

async fn page(person: &Person, new: Option<String>) -> Result<Html<String>, Problem> {
    let frame = Frame::of(&person.account).then("/account".to_owned(), "Account");
    let takes_passwords = person.app.takes_passwords();
    let is_by_token = person.is_by_token();
    show(&AccountPage { frame, tokens: person.tokens().await?, new, takes_passwords, is_by_token })
}

pub(super) async fn account(person: Person) -> Result<Html<String>, Problem> {
    page(&person, None).await
}

/// The secret is shown in the answer itself, and nowhere again.
pub(super) async fn new_token(person: Person, Fields(form): Fields<TokenName>) -> Result<Html<String>, Problem> {
    let (_, secret) = person.new_token(form.name.trim()).await?;
    page(&person, Some(secret.reveal().to_owned())).await
}

/// Everybody who is signed in as this person is to sign in again, by the new one.
pub(super) async fn set_password(person: Person, Fields(form): Fields<PasswordWish>) -> Result<Redirect, Problem> {
    person.set_password(&form.old, &form.new).await?;
    Ok(see("/sign-in"))
}

deeds! {
    accept(person: Person, { course }): person.answer_invitation(&course, true) => "/c/{course}";
    decline(person: Person, { course }): person.answer_invitation(&course, false) => "/";
    revoke_token(person: Person, { id }): person.revoke_token(id) => "/account";
}
