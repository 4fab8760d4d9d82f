//! Tools of measurement: wrong programs that explanations never try, right ones in other arithmetic, and readers
//! that hold explanations and scenes to what such programs do.
#![forbid(unsafe_code)]

pub mod corpus;
pub mod mutants;
pub mod operators;
pub mod outside;
pub mod right;
pub mod runs;
pub mod sight;
pub mod witness;
