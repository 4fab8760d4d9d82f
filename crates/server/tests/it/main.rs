//! The service's tests, in one binary. What differs between engines runs on both.

mod bench;
mod campaigns;
mod command_line;
mod deploy;
mod migrations;
mod plans;
mod pooler;
mod queue;
mod retention;
mod storm;
mod support;
mod turns;
mod uploads;
mod web;
mod worker;
