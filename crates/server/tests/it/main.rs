//! The service's tests, in one binary. What touches the database runs on both engines.

mod bell;
mod campaigns;
mod deploy;
mod load;
mod migrations;
mod plans;
mod pooler;
mod queue;
mod retention;
mod storm;
mod support;
mod uploads;
mod web;
mod worker;
