//! The integration tests: one binary, one module per topic.
mod corpus;
mod root_vectors;
mod scenes_corpus;
