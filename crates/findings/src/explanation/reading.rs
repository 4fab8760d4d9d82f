//! The forms in which a polynomial can be written, by number.
use super::subject::Subject;
use serde::{Deserialize, Serialize};

/// One form of a polynomial's formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reading {
    /// The polynomial.
    pub subject: Subject,
    /// The number of the form; 0 is the assignment's.
    pub number: usize,
}
