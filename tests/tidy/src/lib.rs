//! The rules of the house, which no compiler holds: what uses what, what is cited, how long and wide sources are, how
//! documents, the changelog and commits are written. It depends on no other package, so that it answers in seconds.
//! Its lists come from the workspace's manifests and from ARCHITECTURE.md.
#![cfg(test)]
#![forbid(unsafe_code)]

mod circles;
mod citations;
mod files;
mod history;
mod layers;
mod manifests;
mod prose;
mod ratchets;
mod size;
mod summaries;
mod tree;
mod vectors;
