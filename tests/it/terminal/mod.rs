//! The terminal: what people type, see and complete.
mod bars;
mod colours;
mod completion;
mod plots;
mod scenes;
mod usage;
