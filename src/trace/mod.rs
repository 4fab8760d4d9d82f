//! Traces: bytes to frames and back, streaming and indexed.
//!
//! Takes readers, writers and slices; never opens a file. The format is that of `trace-format.md`.
#![forbid(unsafe_code)]

mod frame;
mod layout;

pub use frame::{Frame, LoggedImpulse, PolynomialLog};
pub use layout::Layout;
