//! **fosssim-oracle** simulates every step of a FOSSSim submission again, from the submission's own state. It compares
//! every polynomial that the submission logged with the one that it should have logged, and reports what is right, what
//! is wrong, and where.
//!
//! The crates of the workspace are re-exported under short names, from the lowest layer to the highest. Each crate uses
//! only those above it in this list. `ARCHITECTURE.md` describes the whole flow.
#![forbid(unsafe_code)]

pub use fosssim_num as num;

pub use fosssim_files as files;

pub use fosssim_model::{assignments, scene, sim, trace};

pub use fosssim_judge as judge;

pub use fosssim_original as original;

pub use fosssim_sandbox as sandbox;

pub use fosssim_student as student;

pub use fosssim_mistakes::{diagnose, together};

pub use fosssim_shrink as shrink;

pub use fosssim_grading as suite;

pub use fosssim_report as report;

pub use fosssim_render as render;

pub use fosssim_evidence as evidence;

pub mod cli;

pub mod sample;
