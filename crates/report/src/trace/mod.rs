//! The report about one step of a trace.

mod show;

pub use show::{ShownRecord, ShownStep};
