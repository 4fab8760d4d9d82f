//! The integration tests: one binary, one module per topic.
mod allocations;
mod attacks;
mod corpus;
mod fuzz_replay;
mod layers;
mod parity;
mod recordings;
mod root_vectors;
mod samples;
mod sandbox;
mod scenes_corpus;
mod scenes_props;
mod trace_props;
