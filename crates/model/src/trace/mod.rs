//! Reads and writes traces as streams of frames.
//!
//! This module takes readers, writers and slices, and never opens a file. The format is that of `trace-format.md`.
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

mod counts;
mod decode;
mod encode;
mod error;
mod frame;
mod labels;
mod layout;
mod lenient;
mod log;
mod reader;
mod recorder;
mod source;
mod writer;

pub use counts::EventCounts;
pub use error::{RecordList, TraceError, TraceFormatError};
pub use frame::{Frame, ImpulsePair, LoggedImpulse, PolynomialLog};
pub use labels::{PolynomialLabel, collect_labels};
pub use layout::Layout;
pub use lenient::{LenientFrame, LenientReader, ReadFailure, ReadStop, record_memory};
pub use reader::Reader;
pub use recorder::Recorder;
pub use writer::{Writer, WrittenTrace};
