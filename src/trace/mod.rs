//! Traces: bytes to frames and back, streaming and indexed.
//!
//! Takes readers, writers and slices; never opens a file. The format is that of `trace-format.md`.
#![forbid(unsafe_code)]
#![deny(clippy::disallowed_methods, clippy::disallowed_types, clippy::print_stdout, clippy::print_stderr)]

mod encode;
mod frame;
mod layout;
mod recorder;
mod writer;

pub use frame::{Frame, LoggedImpulse, PolynomialLog};
pub use layout::Layout;
pub use recorder::Recorder;
pub use writer::{Writer, Written};
