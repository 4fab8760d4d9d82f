//! The service, a grading server for courses that loses no submission. It uses SQLite by default, or PostgreSQL with
//! any number of workers. docs/server/internals.md describes how it works.

pub mod calendar;
pub mod cli;
pub mod db;
pub mod domain;
mod grade_file;
pub mod health;
pub mod instruments;
mod late_policy;
pub mod ledger;
pub mod lti;
pub mod net;
pub mod oidc;
pub mod problem;
pub mod queue;
pub mod retention;
pub mod schema;
mod secret;
pub mod storage;
pub mod store;
pub mod task;
pub mod visible_grade;
pub mod web;
pub mod wire;
pub mod worker;
