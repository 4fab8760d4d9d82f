//! Reports about traces: what one holds, one step of it, and where two of them part.

mod diff;
mod info;
mod show;

pub use diff::{TraceNames, diff_json, diff_text, same};
pub use info::info_json;
pub use show::{ShownRecord, ShownStep};
