//! The report about one step of a trace.

mod shown_step;

pub use shown_step::{ShownRecord, ShownStep};
