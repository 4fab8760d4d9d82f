//! Reports about traces: what one holds, and one step of it.

mod info;
mod show;

pub use info::info_json;
pub use show::{ShownRecord, ShownStep};
