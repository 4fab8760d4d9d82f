//! The integration tests: one binary, one module per topic.
#![expect(clippy::disallowed_methods, reason = "the walls are those of the library; tests may read files")]

mod corpus;
mod recordings;
mod root_vectors;
mod scenes_corpus;
mod trace_props;
