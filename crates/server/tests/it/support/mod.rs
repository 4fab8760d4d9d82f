//! The common parts of the tests.
pub(crate) mod cluster;
pub(crate) mod disk;
pub(crate) mod engines;
pub(crate) mod platform;
pub(crate) mod provider;
pub(crate) mod rows;
pub(crate) mod server;

/// Reads the bytes of an artifact.
pub(crate) async fn bytes(store: &fosssim_server::store::Store, digest: &fosssim_server::store::Digest) -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("artifact");
    store.fetch(digest, &file).await.expect("an artifact");
    std::fs::read(file).expect("its bytes")
}

/// Stores bytes.
pub(crate) async fn put(store: &fosssim_server::store::Store, bytes: &[u8]) -> fosssim_server::store::Artifact {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("artifact");
    std::fs::write(&file, bytes).expect("written");
    store.put_file(&file).await.expect("stored")
}
