//! Traces that a program could send: forged ones, and hostile ones.
mod forged;
mod hostile;
mod unapplied;
