//! Removing for ever: a page that says what goes, and a button that means it.
use super::{
    super::input::{At, Fields},
    Page, PageFrame, see, show,
};
use crate::{
    access::{Admin, Staff},
    problem::Problem,
};
use askama::Template;
use axum::response::Redirect;
use serde::Deserialize;

#[derive(Template)]
#[template(path = "remove.html")]
struct RemovePage {
    frame: PageFrame,
    /// The thing to be removed.
    title: String,
    /// The things that go with it.
    words: &'static str,
    /// The name by which the form says what is meant.
    confirm: String,
    /// Another thing that can be done instead: an address and its button.
    instead: Option<(String, &'static str)>,
}

/// The form's confirmation: the name of the thing that is to be removed.
#[derive(Deserialize)]
pub(super) struct Confirmed {
    confirm: String,
}

impl Confirmed {
    fn is(&self, what: &str) -> Result<(), Problem> {
        if self.confirm == what { Ok(()) } else { Err(Problem::invalid("this form is of something else")) }
    }
}

const SUBMISSION: &str = "The upload, its grades, their history and its reports are removed for ever.";
const ASSIGNMENT: &str = "All submissions to it, their grades and reports, regrades, and links of learning platforms to it are \
                          removed for ever. Export the class before.";
const COURSE: &str = "Its assignments, all submissions, grades and reports, its members and its log are removed for ever. Accounts \
                      stay. Export what is to be kept before.";
const PERSON: &str = "All that they handed in, what it came to, their login and name, tokens and links are removed for ever, in all \
                      courses. A shut account only can't sign in any more.";

pub(super) async fn submission(staff: Staff, At { course: slug, id, .. }: At) -> Page {
    let submission = staff.submission(id).await?;
    let frame =
        PageFrame::course(&staff).then(format!("/c/{slug}/s/{id}"), &format!("Submission {}", submission.number));
    let title = format!("Submission {} of {} to {}", submission.number, submission.login, submission.title);
    show(&RemovePage { frame, title, words: SUBMISSION, confirm: id.to_string(), instead: None })
}

pub(super) async fn remove_submission(
    staff: Staff,
    At { course: slug, id, .. }: At,
    Fields(form): Fields<Confirmed>,
) -> Result<Redirect, Problem> {
    form.is(&id.to_string())?;
    let assignment = staff.submission(id).await?.assignment;
    staff.remove_submission(id).await?;
    Ok(see(&format!("/c/{slug}/a/{assignment}/class")))
}

pub(super) async fn assignment(staff: Staff, At { assignment, .. }: At) -> Page {
    let assignment = staff.assignment(&assignment).await?;
    let frame = PageFrame::assignment(&staff, &assignment);
    show(&RemovePage { frame, title: assignment.title, words: ASSIGNMENT, confirm: assignment.slug, instead: None })
}

pub(super) async fn course(_: Admin, staff: Staff) -> Page {
    let (frame, title, confirm) = (PageFrame::course(&staff), staff.title.clone(), staff.slug.clone());
    show(&RemovePage { frame, title, words: COURSE, confirm, instead: None })
}

pub(super) async fn person(admin: Admin, At { login, .. }: At) -> Page {
    let found = admin.accounts().await?.into_iter().find(|account| account.login == login);
    let account = found.ok_or_else(|| Problem::not_found("account"))?;
    let frame = PageFrame::of(&admin.account).then("/admin".to_owned(), "Administration");
    let instead = Some((format!("/admin/accounts/{login}/shut"), "Only shut the account"));
    let title = format!("{} ({login})", account.name);
    show(&RemovePage { frame, title, words: PERSON, confirm: login, instead })
}

deeds! {
    remove_assignment(staff: Staff, { course, assignment }, form: Confirmed):
        { form.is(&assignment)?; staff.remove_assignment(&assignment) } => "/c/{course}";
    remove_course(admin: Admin, { course }, form: Confirmed):
        { form.is(&course)?; admin.remove_course(&course) } => "/";
    remove_person(admin: Admin, { login }, form: Confirmed):
        { form.is(&login)?; admin.remove_person(&login) } => "/admin";
    shut_account(admin: Admin, { login }): admin.disable_account(&login) => "/admin";
}
