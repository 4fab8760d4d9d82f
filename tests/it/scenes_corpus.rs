//! Every scene of the course, read by both readers.
use std::path::{Path, PathBuf};

use fosssim_oracle::scene::original;

use crate::corpus;

/// All scene files below a folder, in a fixed order.
fn scene_files(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        folder.read_dir().expect("a readable folder").map(|entry| entry.expect("a readable entry").path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            scene_files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "xml") {
            found.push(path);
        }
    }
}

#[test]
fn the_original_reader_accepts_every_scene() {
    let Some(folder) = corpus::folder() else { return };
    let mut files = Vec::new();
    scene_files(&folder.join("scenes"), &mut files);
    for path in &files {
        let bytes = std::fs::read(path).expect("a readable scene");
        if let Err(refusal) = original::read(&bytes) {
            panic!("{}: {refusal}", path.display());
        }
    }
    corpus::ran("the_original_reader_accepts_every_scene", files.len());
}
