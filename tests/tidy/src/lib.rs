//! The project's rules that the compiler does not check: dependencies between modules, citations, the length and width
//! of sources, and the style of documents, the changelog and commits. This package depends on no other package, so that
//! the checks take only seconds. It reads its lists from the workspace's manifests and from ARCHITECTURE.md.
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
