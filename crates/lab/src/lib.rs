//! Measurement tools: the sources of tables in the docs, and right programs in other arithmetic.
#![forbid(unsafe_code)]

pub mod corpus;
pub mod right;
pub mod runs;
