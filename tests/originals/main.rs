//! Runs the course's original programs, and compares their recordings and output with this project's, byte for byte.
//! Each module asks one question.
//!
//! The originals are next to the checkout and used only for comparison. No part of them is in the project.
#![forbid(unsafe_code)]

mod contest;
mod oracle;
#[path = "../it/workspace.rs"]
#[expect(dead_code, reason = "the integration tests use more of it")]
mod workspace;

mod programs;
mod recorded;
