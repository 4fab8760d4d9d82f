//! Reads every scene of the course with both readers.
#![expect(clippy::disallowed_methods, reason = "the corpus is a folder of files")]

use std::path::{Path, PathBuf};

use fosssim_oracle::scene::{self, original};

use crate::corpus;

/// Returns all scene files below a folder, in a fixed order.
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

/// Returns the corpus's scenes with their names below the corpus folder, if there is a corpus.
fn scenes() -> Option<Vec<(String, Vec<u8>)>> {
    let folder = corpus::folder()?;
    let mut files = Vec::new();
    scene_files(&folder.join("scenes"), &mut files);
    let named = files.into_iter().map(|path| {
        let bytes = std::fs::read(&path).expect("a readable scene");
        (path.strip_prefix(&folder).unwrap_or(&path).display().to_string(), bytes)
    });
    Some(named.collect())
}

#[test]
fn both_readers_read_every_scene_in_the_same_way() {
    let Some(scenes) = scenes() else { return };
    for (name, bytes) in &scenes {
        let original = original::read(bytes).unwrap_or_else(|refusal| panic!("{name}: {refusal}"));
        let loaded = scene::read(name, bytes).unwrap_or_else(|problems| panic!("{name}:\n{problems}"));
        assert_eq!(loaded.scene, original.scene, "{name}");
        for warning in loaded.warnings {
            eprintln!("{name}:{warning}");
        }
    }
    corpus::ran("both_readers_read_every_scene_in_the_same_way", scenes.len());
}

#[test]
fn every_scene_survives_being_written() {
    let Some(scenes) = scenes() else { return };
    for (name, bytes) in &scenes {
        let before = original::read(bytes).unwrap_or_else(|refusal| panic!("{name}: {refusal}")).scene;
        let written = scene::to_xml(&before);
        let strict = scene::read(name, written.as_bytes()).unwrap_or_else(|problems| panic!("{name}:\n{problems}"));
        let lenient = original::read(written.as_bytes()).unwrap_or_else(|refusal| panic!("{name}: {refusal}"));
        assert_eq!(strict.scene, before, "{name}");
        assert_eq!(lenient.scene, before, "{name}");
    }
    corpus::ran("every_scene_survives_being_written", scenes.len());
}
