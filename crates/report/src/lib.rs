//! Reports on results: text, JSON and the formats of learning platforms.
//!
//! Every renderer is a pure function from results to text; the crate opens no files, reads no clocks and computes no
//! verdicts. The module `view` contains the versions of the schemas.
//!
//! ```
//! use fosssim_report::{number::format_count, style::Style, table::{Align, Table}};
//!
//! let mut table = Table::new([Align::Left, Align::Right]);
//! table.add_row(["judged".into(), format_count(12_345, "step").into()]);
//! table.add_row(["wrong".into(), format_count(1, "step").into()]);
//! assert_eq!(table.render(Style::Plain), "  judged   12 345 steps\n  wrong          1 step\n");
//! ```
#![forbid(unsafe_code)]

pub(crate) mod annotation;
pub mod calculation;
pub mod case;
pub mod check;
pub mod describe;
pub mod detect;
pub mod diagnosis;
pub mod explain;
pub mod formats;
pub mod formula;
pub mod grade;
pub mod line_width;
pub mod number;
pub mod page;
pub mod scene;
pub mod scene_problems;
pub mod schemas;
pub mod simulate;
pub mod smallest;
mod step_share;
pub mod style;
pub mod table;
pub mod trace;
pub mod untrusted_text;
pub mod view;
pub mod words;
