//! The program for browsers. It runs the commands `check`, `simulate`, `detect` and `grade --traces`, but receives
//! messages instead of arguments.
//!
//! A [`PageSession`] answers one request after the other. A request is a list of byte strings, and the first one is
//! JSON. Answers have the same form ([`parts`]). Requests do not contain dropped files. These are read piece by piece
//! from the [`PageHost`], so a trace of any size can be judged. Compiled to WebAssembly, this crate is the module of
//! the page (`document`); compiled natively, tests compare its answers with the program's.
#![deny(unsafe_code)]

mod check;
mod course;
mod detect;
mod document;
mod dropped;
mod film;
pub mod parts;
mod scenes;
mod session;
mod submission;
#[cfg(target_arch = "wasm32")]
mod wasm;

pub use course::CourseSuite;
pub use document::page;
pub use dropped::PageHost;
pub use session::PageSession;
