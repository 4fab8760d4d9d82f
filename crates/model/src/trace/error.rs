//! Faults of a trace's bytes, and where they are.
//!
//! The strict [`Reader`](super::Reader) stops at them. [`Lenient`](super::Lenient) notes them, and continues as the
//! original does.
use super::layout::Layout;
use serde::{Deserialize, Serialize};
use std::{borrow::Cow, fmt};

/// A fault of a trace, and its place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, thiserror::Error)]
#[error("byte {offset}, {}: {what}", record_name(*.frame, *.step))]
pub struct TraceError {
    /// The record, from 0 (the initial one).
    pub frame: u64,
    /// The step to which it belongs, from 1; 0 for the initial record.
    pub step: u32,
    /// Byte offset from the beginning of the trace: where the value begins that is wrong or not there.
    pub offset: u64,
    /// The fault, in words without position.
    pub what: Malformation,
}

impl TraceError {
    pub(super) fn new(layout: Layout, frame: u64, offset: u64, what: Malformation) -> Self {
        Self { frame, step: layout.step_of(frame), offset, what }
    }
}

/// Returns a record and its step in words.
fn record_name(record: u64, step: u32) -> String {
    match step {
        0 => format!("record {record} (initial state)"),
        _ => format!("record {record} (step {step})"),
    }
}

/// One of the two lists of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum List {
    /// The impulse list.
    Impulses,
    /// The polynomial list.
    Polynomials,
}

impl List {
    /// Returns the fewest bytes of an entry: 36 for an impulse, 4 for an empty polynomial.
    #[must_use]
    pub const fn entry_bytes(self) -> u64 {
        match self {
            Self::Impulses => super::encode::IMPULSE_BYTES as u64,
            Self::Polynomials => 4,
        }
    }
}

impl fmt::Display for List {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Impulses => "impulse",
            Self::Polynomials => "polynomial",
        })
    }
}

/// The ways in which a trace can be malformed (trace-format.md 1, 2).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, thiserror::Error)]
pub enum Malformation {
    /// No byte at all.
    #[error("the trace is empty; was the program started with -o, and did it run?")]
    Empty,
    /// The bytes end between two records.
    #[error(
        "the trace ends after {records} {}, but this scene's trace has {expected}; did the program crash, or was it \
         stopped?",
        if *records == 1 { "record" } else { "records" }
    )]
    TooFewRecords {
        /// Complete records.
        records: u64,
        /// Records of a complete trace of this scene.
        expected: u64,
    },
    /// The bytes end inside positions and velocities.
    #[error("positions and velocities need {needs} bytes, but {left} are left; the trace is cut or of another scene")]
    State {
        /// 32 bytes per particle.
        needs: u64,
        /// Bytes left.
        left: u64,
    },
    /// The bytes end before or inside a list's count.
    #[error("the count of the {list} list is cut: {left} of its 4 bytes are left")]
    CountCut {
        /// Which list.
        list: List,
        /// Bytes left, 0 to 3.
        left: u64,
    },
    /// A count below zero.
    #[error("the {list} list has the negative count {count}; the trace is damaged or of another scene")]
    NegativeCount {
        /// Which list.
        list: List,
        /// The count.
        count: i32,
    },
    /// A count that the rest of the trace has no room for.
    #[error(
        "the {list} list claims {count} entries, at least {needs} bytes, but {left} are left; the trace is cut or of \
         another scene"
    )]
    CountBeyondEnd {
        /// Which list.
        list: List,
        /// The count.
        count: i32,
        /// The fewest bytes of this number of entries.
        needs: u64,
        /// Bytes left after the count.
        left: u64,
    },
    /// The bytes end before or inside a polynomial's size.
    #[error("the trace ends before polynomial {polynomial} of {count}")]
    PolynomialCut {
        /// Number of the polynomial in the list, from 0.
        polynomial: u64,
        /// The list's count.
        count: i32,
    },
    /// The bytes end inside a polynomial's coefficients.
    #[error(
        "polynomial {polynomial} claims {size} coefficient{} ({} bytes), but {left} bytes are left",
        if *.size == 1 { "" } else { "s" },
        8 * i64::from(*.size)
    )]
    SizeBeyondEnd {
        /// Number of the polynomial in the list, from 0.
        polynomial: u64,
        /// The claimed size.
        size: i32,
        /// Bytes left after the size.
        left: u64,
    },
    /// A size below zero, read as zero.
    #[error("polynomial {polynomial} has the negative size {size}")]
    NegativeSize {
        /// Number of the polynomial in the list, from 0.
        polynomial: u64,
        /// The claimed size.
        size: i32,
    },
    /// More coefficients than any detection polynomial has (six).
    #[error("polynomial {polynomial} has {size} coefficients, but no polynomial of the detection has more than 6")]
    OversizedPolynomial {
        /// Number of the polynomial in the list, from 0.
        polynomial: u64,
        /// The claimed size.
        size: i32,
    },
    /// An impulse whose kind is not 0, 1 or 2.
    #[error("impulse {impulse} has the unknown type {kind} (known: 0, 1, 2)")]
    UnknownKind {
        /// Number of the impulse in the list, from 0.
        impulse: u64,
        /// The claimed kind.
        kind: i32,
    },
    /// An impulse that names an object which the scene does not have.
    #[error("impulse {impulse} names {object} {index}, but the scene has {count}")]
    IndexOutOfRange {
        /// Number of the impulse in the list, from 0.
        impulse: u64,
        /// The kind of object that it names: `particle`, `edge` or `half-plane`.
        object: Cow<'static, str>,
        /// The index.
        index: i32,
        /// The number of them.
        count: usize,
    },
    /// A record that does not fit into the memory for one record.
    #[error(
        "the record needs more than {limit} bytes of memory, more than this program sets aside for one; the trace is \
         damaged or of another scene"
    )]
    FrameTooLarge {
        /// The limit in bytes.
        limit: u64,
    },
    /// More bytes behind the last record than are read there.
    #[error(
        "more than {limit} bytes follow the last record; they were not all read; the trace is of another scene or \
         never ends"
    )]
    Endless {
        /// The limit in bytes.
        limit: u64,
    },
    /// A record of the right length that is longer than its kept part.
    #[error(
        "the record has {logged} polynomials, as many as it should have, but this program compares the first {kept} of \
         a record of this scene only"
    )]
    BeyondKept {
        /// The number of polynomials in the record.
        logged: usize,
        /// The number of those that were kept.
        kept: usize,
    },
    /// The stream reported an error.
    #[error("reading failed: {message}")]
    Io {
        /// The error's text.
        message: String,
    },
}

impl Malformation {
    /// Positions and velocities that are cut, or not there at all, behind `records` records, of which `whole` were
    /// whole. `left` bytes are left.
    pub(super) fn no_state(layout: Layout, records: u64, whole: u64, left: u64) -> Self {
        match (left, records) {
            (0, 0) => Self::Empty,
            (0, _) => Self::TooFewRecords { records: whole, expected: layout.records() },
            _ => Self::State { needs: layout.state_bytes() as u64, left },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_byte_record_and_step() {
        let what = Malformation::CountBeyondEnd { list: List::Impulses, count: 7, needs: 252, left: 40 };
        let error = TraceError { offset: 72, frame: 4, step: 2, what };
        assert_eq!(
            error.to_string(),
            "byte 72, record 4 (step 2): the impulse list claims 7 entries, at least 252 bytes, but 40 are left; the \
             trace is cut or of another scene"
        );
        let what = Malformation::SizeBeyondEnd { polynomial: 3, size: i32::MAX, left: 0 };
        let error = TraceError { offset: 0, frame: 0, step: 0, what };
        assert_eq!(
            error.to_string(),
            "byte 0, record 0 (initial state): polynomial 3 claims 2147483647 coefficients (17179869176 bytes), but 0 \
             bytes are left"
        );
    }
}
