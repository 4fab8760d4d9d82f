//! **fosssim-oracle** re-simulates every step of a FOSSSim submission from the submission's own state, compares every
//! polynomial that it logged with the one it should have logged, and says what is right, what is wrong and where.
//!
//! The modules are listed from the lowest layer to the highest; a module imports only from those above it in this
//! list. `ARCHITECTURE.md` tells the whole flow.

pub mod num;

pub mod scene;

pub mod sim;

pub mod trace;

pub mod student;

pub mod judge;

pub mod sandbox;

pub mod diagnose;

pub mod suite;

pub mod report;

pub mod cli;
