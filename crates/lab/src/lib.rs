//! The measurement tools, which are the sources of tables in the docs.
#![forbid(unsafe_code)]

pub mod corpus;
pub mod runs;
