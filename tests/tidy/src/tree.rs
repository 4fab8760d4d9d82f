//! The files of the checkout that the rules read: sources, manifests and others.
use std::{
    fs,
    path::{Path, PathBuf},
    sync::OnceLock,
};

/// The folders that contain Rust sources.
const SOURCES: [&str; 6] = ["src", "crates", "tests", "benches", "examples", "fuzz"];

/// Folders that tools create.
const FILLED_BY_TOOLS: [&str; 2] = ["target", "node_modules"];

/// Returns the top folder of the checkout.
pub fn root() -> &'static Path {
    static ROOT: OnceLock<PathBuf> = OnceLock::new();
    ROOT.get_or_init(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("a checkout"))
}

/// Returns the contents of a file.
pub fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Returns a path relative to the checkout.
pub fn name(path: &Path) -> &str {
    path.strip_prefix(root()).expect("in the checkout").to_str().expect("a name")
}

/// Returns all files below a folder whose names have the given ending, in order.
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

/// Returns the crate of a source: the name of its folder.
pub fn crate_of(name: &str) -> &str {
    name.strip_prefix("crates/").unwrap_or(name).split('/').next().unwrap_or_default()
}

/// Returns whether only tests and benchmarks use a file.
pub fn is_of_tests(name: &str) -> bool {
    let is_folder = |part| ["tests", "benches", "fuzz", "testing"].contains(&part);
    name.split('/').any(is_folder) || name.ends_with("tests.rs")
}
