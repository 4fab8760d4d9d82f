//! The terminal: what people type, see and complete.
mod bars;
mod colours;
mod completion;
mod scenes;
mod usage;
