//! Faults of a trace's bytes, and their places.
//!
//! The strict [`Reader`](super::Reader) stops at a fault. [`LenientReader`](super::LenientReader) records it, and
//! continues like the original.
use super::layout::Layout;
use serde::{Deserialize, Serialize};
use std::{borrow::Cow, fmt};

/// A fault of a trace, and its place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, thiserror::Error)]
#[error("byte {offset}, {}: {what}", record_name(*.frame, *.step))]
pub struct TraceError {
    /// The number of the record, from 0 for the initial record.
    pub frame: u64,
    /// The number of the record's step, from 1; 0 for the initial record.
    pub step: u32,
    /// The byte offset from the beginning of the trace at which the wrong or missing value begins.
    pub offset: u64,
    /// The fault, without its position.
    pub what: TraceFormatError,
}

impl TraceError {
    pub(super) fn new(layout: Layout, frame: u64, offset: u64, what: TraceFormatError) -> Self {
        Self { frame, step: layout.step_of_record(frame), offset, what }
    }
}

/// Returns a record and its step as text.
fn record_name(record: u64, step: u32) -> String {
    match step {
        0 => format!("record {record} (initial state)"),
        _ => format!("record {record} (step {step})"),
    }
}

/// One of the two lists of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum RecordList {
    /// The impulse list.
    Impulses,
    /// The polynomial list.
    Polynomials,
}

impl RecordList {
    /// Returns the minimum number of bytes of an entry: 36 for an impulse, or 4 for an empty polynomial.
    pub const fn entry_bytes(self) -> u64 {
        match self {
            Self::Impulses => super::encode::IMPULSE_BYTES as u64,
            Self::Polynomials => 4,
        }
    }
}

impl fmt::Display for RecordList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Impulses => "impulse",
            Self::Polynomials => "polynomial",
        })
    }
}

/// The ways in which a trace can be malformed (trace-format.md 1, 2).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, thiserror::Error)]
pub enum TraceFormatError {
    /// The trace is empty.
    #[error("the trace is empty; was the program started with -o, and did it run?")]
    Empty,
    /// The bytes end between two records.
    #[error(
        "the trace ends after {records} {}, but this scene's trace has {expected}; did the program crash, or was it \
         stopped?",
        if *records == 1 { "record" } else { "records" }
    )]
    TooFewRecords {
        /// The number of complete records.
        records: u64,
        /// The number of records of a complete trace of the scene.
        expected: u64,
    },
    /// The bytes end inside positions and velocities.
    #[error(
        "positions and velocities need {needs} bytes, but {left} are left; the trace is cut short or belongs to \
         another scene"
    )]
    State {
        /// The number of bytes needed: 32 per particle.
        needs: u64,
        /// The number of remaining bytes.
        left: u64,
    },
    /// The bytes end before or inside a list's count.
    #[error("the count of the {list} list is cut short: {left} of its 4 bytes are left")]
    CountCut {
        /// The list concerned.
        list: RecordList,
        /// The number of remaining bytes, 0 to 3.
        left: u64,
    },
    /// A count is negative.
    #[error("the {list} list has the negative count {count}; the trace is damaged or belongs to another scene")]
    NegativeCount {
        /// The list concerned.
        list: RecordList,
        /// The number of entries that the trace declares.
        count: i32,
    },
    /// A count is too large for the rest of the trace.
    #[error(
        "the {list} list declares {count} entries, at least {needs} bytes, but {left} are left; the trace is cut \
         short or belongs to another scene"
    )]
    CountBeyondEnd {
        /// The list concerned.
        list: RecordList,
        /// The number of entries that the trace declares.
        count: i32,
        /// The minimum number of bytes of `count` entries.
        needs: u64,
        /// The number of bytes after the count.
        left: u64,
    },
    /// The bytes end before or inside a polynomial's size.
    #[error("the trace ends before polynomial {polynomial} of {count}")]
    PolynomialCut {
        /// The number of the polynomial in the list, from 0.
        polynomial: u64,
        /// The list's count.
        count: i32,
    },
    /// The bytes end inside a polynomial's coefficients.
    #[error(
        "polynomial {polynomial} declares {size} coefficient{} ({} bytes), but {left} bytes are left",
        if *.size == 1 { "" } else { "s" },
        8 * i64::from(*.size)
    )]
    SizeBeyondEnd {
        /// The number of the polynomial in the list, from 0.
        polynomial: u64,
        /// The size that the trace declares.
        size: i32,
        /// The number of bytes after the size.
        left: u64,
    },
    /// A size is negative, and is read as zero.
    #[error("polynomial {polynomial} has the negative size {size}")]
    NegativeSize {
        /// The number of the polynomial in the list, from 0.
        polynomial: u64,
        /// The size that the trace declares.
        size: i32,
    },
    /// A polynomial has more coefficients than any detection polynomial (six).
    #[error("polynomial {polynomial} has {size} coefficients, but no polynomial of the detection has more than 6")]
    OversizedPolynomial {
        /// The number of the polynomial in the list, from 0.
        polynomial: u64,
        /// The size that the trace declares.
        size: i32,
    },
    /// An impulse has a kind other than 0, 1 or 2.
    #[error("impulse {impulse} has the unknown type {kind} (known: 0, 1, 2)")]
    UnknownKind {
        /// The number of the impulse in the list, from 0.
        impulse: u64,
        /// The kind that the trace declares.
        kind: i32,
    },
    /// An impulse names an object that the scene does not have.
    #[error("impulse {impulse} names {object} {index}, but the scene has {count}")]
    IndexOutOfRange {
        /// The number of the impulse in the list, from 0.
        impulse: u64,
        /// The kind of the missing object: `particle`, `edge` or `half-plane`.
        object: Cow<'static, str>,
        /// The index of the missing object.
        index: i32,
        /// The number of objects of this kind in the scene.
        count: usize,
    },
    /// A record does not fit into the memory for one record.
    #[error(
        "the record needs more than {limit} bytes of memory, which is this program's limit for a record; the trace \
            is damaged or belongs to another scene"
    )]
    FrameTooLarge {
        /// The limit in bytes.
        limit: u64,
    },
    /// A record has the right number of polynomials, but only a part of them was kept.
    #[error(
        "the record has {logged} polynomials, as many as it should have, but this program compares only the first \
            {kept} of a record of this scene"
    )]
    BeyondKept {
        /// The number of polynomials in the record.
        logged: usize,
        /// The number of kept polynomials.
        kept: usize,
    },
    /// The stream reported an error.
    #[error("reading failed: {message}")]
    Io {
        /// The text of the error.
        message: String,
    },
}

impl TraceFormatError {
    /// Returns the fault of missing or incomplete positions and velocities after `records` records, of which `whole`
    /// were complete. `left` is the number of remaining bytes.
    pub(super) fn missing_state(layout: Layout, records: u64, whole: u64, left: u64) -> Self {
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
        let what = TraceFormatError::CountBeyondEnd { list: RecordList::Impulses, count: 7, needs: 252, left: 40 };
        let error = TraceError { offset: 72, frame: 4, step: 2, what };
        assert_eq!(
            error.to_string(),
            "byte 72, record 4 (step 2): the impulse list declares 7 entries, at least 252 bytes, but 40 are left; the \
             trace is cut short or belongs to another scene"
        );
        let what = TraceFormatError::SizeBeyondEnd { polynomial: 3, size: i32::MAX, left: 0 };
        let error = TraceError { offset: 0, frame: 0, step: 0, what };
        assert_eq!(
            error.to_string(),
            "byte 0, record 0 (initial state): polynomial 3 declares 2147483647 coefficients (17179869176 bytes), but \
             0 bytes are left"
        );
    }
}
