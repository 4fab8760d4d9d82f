//! The terminal: what people type, see and complete.
mod bars;
mod colors;
mod completion;
mod scenes;
mod usage;
