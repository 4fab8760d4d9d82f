//! The drop-in for the original program (oracle-behaviour.md 1, 2).
mod arguments;
mod usage;
