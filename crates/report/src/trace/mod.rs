//! Reports about traces: a summary of a trace, and one of its steps.

mod info;
mod show;

pub use info::info_json;
pub use show::{ShownRecord, ShownStep};
