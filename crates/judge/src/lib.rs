//! The verdict on one trace: the original's rules (`parity`), the fair ones (`fair`), findings, and where trace and
//! reference first part.
//!
//! Knows nothing of processes and reports; it takes a scene and a reader, and yields typed findings. The rules are
//! those of `oracle-behaviour.md`, sections 4 to 6.
#![forbid(unsafe_code)]
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

mod book_findings;
pub mod budget;
mod contacts;
mod counts;
mod differing;
pub mod fair;
mod finding;
mod identical;
pub mod kept;
mod options;
mod outcome;
pub mod parity;
mod progress;
pub mod recorded;
pub mod replay;
mod rules;
#[cfg(test)]
mod samples;
pub mod share;
pub mod study;
mod tally;
mod words;

pub use book_findings::BookFindings;
pub use counts::FindingCounts;
pub use differing::{differing, factor};
pub use finding::{Finding, FindingDetail, FindingKind, Part, PolynomialPlace, RecordPart, Rescaled, Role};
pub use fosssim_model::trace::Unreadable;
pub use outcome::{Damage, Outcome, Stop};
pub use parity::{Overall, Residuals};
pub use rules::{Book, Rules, Ruling};
pub use words::{PairWords, PassWords, Power, passes};
