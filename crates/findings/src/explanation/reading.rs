//! The forms in which the formula of a polynomial can be written.
use super::subject::Subject;
use serde::{Deserialize, Serialize};

/// One of the forms in which a polynomial's formula can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reading {
    /// The polynomial that is written.
    pub subject: Subject,
    /// The number of the form. 0 is the form in the assignment.
    pub number: usize,
}
