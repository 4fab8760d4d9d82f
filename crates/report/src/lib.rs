//! Results to bytes: text, JSON and the formats of learning platforms.
//!
//! Every renderer is a pure function from results to text; nothing here opens a file, reads a clock or computes a
//! verdict. Core types are not `Serialize`: `view` owns the serialised shapes and their schema version.
#![forbid(unsafe_code)]

pub mod check;
pub mod describe;
pub mod detect;
pub mod diagnosis;
pub mod explain;
pub mod grade;
pub mod headroom;
pub mod number;
pub mod page;
pub mod problems;
pub mod scene;
pub mod simulate;
pub mod style;
pub mod suite;
pub mod table;
pub mod trace;
pub mod view;
pub mod words;
pub mod wrap;
