//! One's courses and tokens.
use super::{
    super::{
        api::TokenName,
        input::{AddressParts, Fields},
    },
    Page, PageFrame, see, show, text,
};
use crate::{
    domain::{CourseOf, Person, TokenInfo},
    problem::Problem,
};
use askama::Template;
use axum::response::Redirect;

#[derive(Template)]
#[template(path = "home.html")]
struct Home {
    frame: PageFrame,
    person: Person,
    courses: Vec<CourseOf>,
}

#[derive(Template)]
#[template(path = "account.html")]
struct AccountPage<'a> {
    frame: PageFrame,
    person: &'a Person,
    is_connected: bool,
    tokens: Vec<TokenInfo>,
    new: Option<String>,
}

pub(super) async fn home(person: Person) -> Page {
    let frame = PageFrame::for_account(&person.account);
    show(&Home { frame, courses: person.courses().await?, person })
}

async fn page(person: &Person, new: Option<String>) -> Page {
    let frame = PageFrame::for_account(&person.account).then("/account".to_owned(), "Account");
    let (is_connected, tokens) = (person.is_connected().await?, person.tokens().await?);
    show(&AccountPage { frame, person, is_connected, tokens, new })
}

pub(super) async fn account(person: Person) -> Page {
    page(&person, None).await
}

/// Makes a token, whose secret is shown in the answer itself, and nowhere again.
pub(super) async fn new_token(person: Person, Fields(form): Fields<TokenName>) -> Page {
    let token = person.new_token(form.name.trim()).await?.token;
    page(&person, Some(token)).await
}

deeds! {
    revoke_token(person: Person, { id }): person.revoke_token(id) => "/account";
}
