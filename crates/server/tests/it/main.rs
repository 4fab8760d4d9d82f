//! The service's tests, in one binary. What touches the database runs on both engines.

mod bell;
mod deploy;
mod migrations;
mod queue;
mod storm;
mod support;
mod web;
mod worker;
