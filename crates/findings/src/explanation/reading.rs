//! Ways to write a polynomial, by number.
use super::subject::Subject;
use serde::{Deserialize, Serialize};

/// One way to write a polynomial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reading {
    /// The polynomial.
    pub subject: Subject,
    /// The number of the way; 0 is the assignment's.
    pub number: usize,
}
