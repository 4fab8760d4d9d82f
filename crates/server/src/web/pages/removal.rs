//! The pages that remove something permanently. Their forms list what is removed, and require its name as confirmation.
use super::super::input::{Fields, UrlPathParts};
use crate::{
    domain::{Admin, Staff},
    problem::{Problem, ensure},
};
use axum::response::Redirect;
use serde::Deserialize;

/// The name of what is removed, which a person typed as confirmation.
#[derive(Deserialize)]
pub(super) struct Confirmation {
    confirm: String,
}

impl Confirmation {
    fn ensure_name(&self, what: &str) -> Result<(), Problem> {
        ensure(self.confirm == what, Problem::invalid(format!("to remove {what}, type its name")))
    }
}

actions! {
    remove_submission(staff: Staff, { course, id }, form: Confirmation):
        { form.ensure_name(&staff.submission(id).await?.login)?; staff.remove_submission(id) } => "/c/{course}";
    remove_assignment(staff: Staff, { course, assignment }, form: Confirmation):
        { form.ensure_name(&assignment)?; staff.remove_assignment(&assignment) } => "/c/{course}";
    remove_course(admin: Admin, { course }, form: Confirmation):
        { form.ensure_name(&course)?; admin.remove_course(&course) } => "/";
    remove_person(admin: Admin, { login }, form: Confirmation):
        { form.ensure_name(&login)?; admin.remove_person(&login) } => "/admin/people";
    shut_account(admin: Admin, { login }): admin.disable_account(&login) => "/admin/people";
}
