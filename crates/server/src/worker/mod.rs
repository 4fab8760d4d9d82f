//! Workers fetch jobs from a [`JobSource`], pass them to a [`Grader`], and return the results. A worker has leases, but
//! no data about courses or students.

mod child;
mod grade_reader;
mod grader;
mod guard;
mod health;
mod local;
mod program;
mod remote;
mod slots;
mod source;
mod suite_check;

pub(crate) use child::set_limits;
pub use grader::{Grader, GraderFault, GradingOutput, NewFile, PROGRESS_FILE};
pub use local::LocalSource;
use program::GRACE_PERIOD;
pub use program::{PUBLISHED_PAGE, Program, REPORTS, STAFF_PAGE};
pub use remote::RemoteSource;
pub use slots::work;
pub use source::{JobSource, SourceError};
pub use suite_check::check_suite;
