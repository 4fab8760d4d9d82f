//! Tools of measurement: what docs' tables are made with, and right programs in other arithmetic.
#![forbid(unsafe_code)]

pub mod corpus;
pub mod right;
pub mod runs;
