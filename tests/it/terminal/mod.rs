//! The terminal: typed words, output and completion.
mod bars;
mod colors;
mod completion;
mod scenes;
mod usage;
