//! Ways to write a polynomial down, by number.
use super::subject::Subject;
use serde::{Deserialize, Serialize};

/// One way to write a polynomial down.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reading {
    /// The polynomial.
    pub subject: Subject,
    /// Which of its ways: 0 is the assignment's.
    pub number: usize,
}
