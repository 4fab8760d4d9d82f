//! What is asked for, what is simulated and what is written of it: [`assignments`], [`scene`], [`sim`] and [`trace`],
//! from the lowest room to the highest.
//!
//! A room imports only from those listed above it. The arithmetic whose bits matter lies below, in `fosssim-num`.
#![forbid(unsafe_code)]

pub mod assignments;

pub mod scene;

pub mod sim;

pub mod trace;
