//! The common parts of the tests.
pub(crate) mod cluster;
pub(crate) mod disk;
pub(crate) mod engines;
pub(crate) mod platform;
pub(crate) mod rows;
pub(crate) mod server;
