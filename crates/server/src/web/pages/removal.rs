//! Removing for ever: a page that says what goes, and a button that means it.
use super::{
    super::input::{At, Fields},
    Frame, see, show,
};
use crate::{
    access::{Admin, Staff},
    problem::Problem,
};
use askama::Template;
use axum::response::{Html, Redirect};
use serde::Deserialize;

#[derive(Template)]
#[template(path = "remove.html")]
struct RemovePage {
    frame: Frame,
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
                      stay. Archived it could still be read.";
const PERSON: &str = "All that they handed in, what it came to, their login and name, tokens and links are removed for ever, in all \
                      courses. A shut account only can't sign in any more.";

pub(super) async fn submission(staff: Staff, At { course: slug, id, .. }: At) -> Result<Html<String>, Problem> {
    let submission = staff.submission(id).await?;
    let frame = Frame::course(&staff).then(format!("/c/{slug}/s/{id}"), &format!("Submission {}", submission.number));
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

pub(super) async fn assignment(staff: Staff, At { assignment, .. }: At) -> Result<Html<String>, Problem> {
    let assignment = staff.assignment(&assignment).await?;
    let frame = Frame::assignment(&staff, &assignment.slug, &assignment.title);
    show(&RemovePage { frame, title: assignment.title, words: ASSIGNMENT, confirm: assignment.slug, instead: None })
}

pub(super) async fn remove_assignment(
    staff: Staff,
    At { course: slug, assignment, .. }: At,
    Fields(form): Fields<Confirmed>,
) -> Result<Redirect, Problem> {
    form.is(&assignment)?;
    staff.remove_assignment(&assignment).await?;
    Ok(see(&format!("/c/{slug}")))
}

pub(super) async fn course(admin: Admin, staff: Staff) -> Result<Html<String>, Problem> {
    let course = staff.course();
    let (way, button) = match staff.is_archived {
        true => ("reopen", "Open it again"),
        false => ("archive", "Archive it"),
    };
    let instead = Some((format!("/c/{}/{way}", course.slug), button));
    let frame = Frame::of(&admin.account).then(format!("/c/{}", course.slug), &course.title);
    show(&RemovePage { frame, title: course.title, words: COURSE, confirm: course.slug, instead })
}

pub(super) async fn remove_course(
    admin: Admin,
    At { course: slug, .. }: At,
    Fields(form): Fields<Confirmed>,
) -> Result<Redirect, Problem> {
    form.is(&slug)?;
    admin.remove_course(&slug).await?;
    Ok(see("/"))
}

pub(super) async fn person(admin: Admin, At { login, .. }: At) -> Result<Html<String>, Problem> {
    let found = admin.accounts().await?.into_iter().find(|account| account.login == login);
    let account = found.ok_or_else(|| Problem::not_found("account"))?;
    let frame = Frame::of(&admin.account).then("/admin".to_owned(), "Administration");
    let instead = Some((format!("/admin/accounts/{login}/shut"), "Only shut the account"));
    let title = format!("{} ({login})", account.name);
    show(&RemovePage { frame, title, words: PERSON, confirm: login, instead })
}

pub(super) async fn remove_person(
    admin: Admin,
    At { login, .. }: At,
    Fields(form): Fields<Confirmed>,
) -> Result<Redirect, Problem> {
    form.is(&login)?;
    admin.remove_person(&login).await?;
    Ok(see("/admin"))
}

deeds! {
    archive(admin: Admin, { course }): admin.archive_course(&course, true) => "/c/{course}";
    reopen(admin: Admin, { course }): admin.archive_course(&course, false) => "/c/{course}";
    shut_account(admin: Admin, { login }): admin.disable_account(&login) => "/admin";
}
