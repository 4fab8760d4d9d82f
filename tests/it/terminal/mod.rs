//! The terminal: what people type, see and complete.
mod colours;
mod completion;
mod scenes;
mod usage;
