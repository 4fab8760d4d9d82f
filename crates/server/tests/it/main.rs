//! The service's tests, in one binary. Tests that depend on the database engine run on both engines.

mod bench;
mod command_line;
mod deploy;
mod migrations;
mod plans;
mod pooler;
mod queue;
mod regrades;
mod retention;
mod storm;
mod support;
mod turns;
mod uploads;
mod web;
mod worker;
