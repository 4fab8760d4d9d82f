//! Asks the course's original programs: what they record and what they say is compared with this project, byte for
//! byte. One module per question.
//!
//! The originals are measuring instruments that lie beside the checkout, and no part of them is in the project.
#![forbid(unsafe_code)]

mod contest;
mod oracle;
#[path = "../it/workspace.rs"]
#[expect(dead_code, reason = "the integration tests use more of it")]
mod workspace;

mod programs;
mod recorded;
