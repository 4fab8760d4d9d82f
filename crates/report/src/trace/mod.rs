//! Reports about traces: the contents of a trace, and one of its steps.

mod info;
mod show;

pub use info::info_json;
pub use show::{ShownRecord, ShownStep};
