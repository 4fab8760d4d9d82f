//! Known mistakes and how they are found again: [`student`] makes them, [`diagnose`] names them.
#![forbid(unsafe_code)]

pub mod plain;

pub mod assignments;

pub mod student;
pub mod together;

pub mod diagnose;
