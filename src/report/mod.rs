//! (follows)

pub mod grade;
