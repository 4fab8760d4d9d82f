//! Workers: they fetch jobs from a [`JobSource`], let a [`Grader`] do them, and bring the results back. A worker knows
//! neither courses nor students; what it holds is a lease.

mod child;
mod grader;
mod guard;
mod health;
mod local;
mod program;
mod reading;
mod remote;
mod slots;
mod source;
mod suite_check;

pub(crate) use child::limit;
pub use grader::{Grader, GraderFault, GradingOutput, NewFile, PROGRESS};
pub use local::LocalSource;
use program::GRACE;
pub use program::{PUBLISHED_PAGE, Program, REPORTS, STAFF_PAGE};
pub use remote::RemoteSource;
pub use slots::work;
pub use source::{JobSource, SourceError};
pub use suite_check::check_suite;
