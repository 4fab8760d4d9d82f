//! The ground-truth corpus, if it is next to the checkout: real scenes, traces, verdicts and root-finder vectors.
//!
//! The corpus is not part of the project. Tests that use it print how many cases they ran. Without the corpus, they
//! print that they were skipped. An empty corpus is a failure.
use fosssim_testing::{Need, skip};
use std::path::{Path, PathBuf};

/// Returns the corpus folder: `FOSSSIM_CORPUS`, or else `../shared/corpus` next to the checkout.
pub fn folder() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/corpus");
    let folder = std::env::var_os("FOSSSIM_CORPUS").map_or(beside, PathBuf::from);
    if folder.is_dir() {
        Some(folder)
    } else {
        skip(Need::Corpus, format_args!("there is none at {}", folder.display()));
        None
    }
}

/// Prints how many cases a corpus test ran. An empty corpus is a failure.
pub fn ran(test: &str, cases: usize) {
    assert!(cases > 0, "corpus test {test}: the corpus is there but holds no case");
    eprintln!("corpus test {test}: {cases} cases");
}

/// Returns the decompressed bytes of a `.zst` file of the corpus.
pub fn unpack(path: &Path) -> Vec<u8> {
    let packed = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    zstd::decode_all(&packed[..]).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
