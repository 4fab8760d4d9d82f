//! The checkout as the rules read it: its sources, its manifests and its other files.
use std::{
    fs,
    path::{Path, PathBuf},
    sync::OnceLock,
};

/// The folders in which Rust sources lie.
const SOURCES: [&str; 6] = ["src", "crates", "tests", "benches", "examples", "fuzz"];

/// Folders that tools fill.
const FILLED_BY_TOOLS: [&str; 2] = ["target", "node_modules"];

/// Returns the top folder of the checkout.
pub fn root() -> &'static Path {
    static ROOT: OnceLock<PathBuf> = OnceLock::new();
    ROOT.get_or_init(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("a checkout"))
}

/// The content of a file.
pub fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A path as it is written in the checkout.
pub fn name(path: &Path) -> &str {
    path.strip_prefix(root()).expect("in the checkout").to_str().expect("a name")
}

/// Returns all files below a folder whose names have the given end, in order.
pub fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.retain(|path| !FILLED_BY_TOOLS.iter().any(|name| path.ends_with(name)));
    paths.sort();
    let found = paths.into_iter().flat_map(|path| if path.is_dir() { files(&path, ending) } else { vec![path] });
    found.filter(|path| path.to_string_lossy().ends_with(ending)).collect()
}

/// Returns every Rust file of the checkout.
pub fn sources() -> Vec<PathBuf> {
    let found = SOURCES.iter().flat_map(|folder| files(&root().join(folder), ".rs"));
    found.chain([root().join("build.rs")]).collect()
}

/// The crate that a source belongs to: the name of its folder.
pub fn crate_of(name: &str) -> &str {
    name.strip_prefix("crates/").unwrap_or(name).split('/').next().unwrap_or_default()
}

/// Whether only tests and benches use a file.
pub fn is_of_tests(name: &str) -> bool {
    let is_folder = |part| ["tests", "benches", "fuzz", "testing"].contains(&part);
    name.split('/').any(is_folder) || name.ends_with("tests.rs")
}
