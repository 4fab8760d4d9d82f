//! The roles and their permissions.

pub(super) mod admin;
pub(super) mod member;
pub(super) mod person;
pub(super) mod remote;
pub(super) mod request;
pub(super) mod staff;
pub(super) mod visitor;
