//! The simulator records every scene of the corpus as the original program does, byte for byte.
use std::path::Path;

use fosssim_oracle::{
    scene::{Scene, original},
    sim::{RootSearch, SearchCounts, Simulation},
    trace::{Layout, Recorder},
};
use serde::Deserialize;
use sha2::{Digest, Sha256};

use crate::corpus;

/// The parts of a manifest that these tests need.
#[derive(Deserialize)]
struct Manifest {
    scenes: Vec<Entry>,
}

/// A scene and the length and digest of the trace that the original records for it.
#[derive(Deserialize)]
struct Entry {
    scene: String,
    scene_file: String,
    bytes: usize,
    sha256: String,
    reference_file: Option<String>,
}

fn manifest(folder: &Path, name: &str) -> Vec<Entry> {
    let text = std::fs::read_to_string(folder.join(name)).expect("a readable manifest");
    serde_json::from_str::<Manifest>(&text).expect("a manifest").scenes
}

fn scene(folder: &Path, entry: &Entry) -> Scene {
    let bytes = std::fs::read(folder.join(&entry.scene_file)).expect("a readable scene");
    original::read(&bytes).unwrap_or_else(|refusal| panic!("{}: {refusal}", entry.scene)).scene
}

/// Returns the trace of a scene, and how many root searches it needed.
fn record(scene: &Scene, search: RootSearch) -> (Vec<u8>, SearchCounts) {
    let mut simulation = Simulation::new(scene, search);
    let mut recorder = Recorder::start(Vec::new(), Layout::for_scene(scene), simulation.state());
    for _ in 0..scene.step_count() {
        simulation.step(&mut recorder).unwrap_or_else(|error| panic!("{error}"));
    }
    let (trace, _) = recorder.finish().expect("writing to memory");
    (trace, simulation.search_counts())
}

/// Returns the error of a trace, if any: with the first difference if the original's trace is available.
fn difference(folder: &Path, entry: &Entry, trace: &[u8]) -> Option<String> {
    let digest: String = Sha256::digest(trace).iter().map(|byte| format!("{byte:02x}")).collect();
    if digest == entry.sha256 {
        return None;
    }
    let mut message = format!("{}: {} bytes, expected {}", entry.scene, trace.len(), entry.bytes);
    if let Some(file) = &entry.reference_file {
        let reference = corpus::unpack(&folder.join(file));
        let first = trace.iter().zip(&reference).position(|(ours, theirs)| ours != theirs);
        let first = first.unwrap_or(trace.len().min(reference.len()));
        message = format!("{message}; first difference at byte {first}");
    }
    Some(message)
}

fn all_are_byte_identical(test: &str, manifest_name: &str) {
    let Some(folder) = corpus::folder() else { return };
    let entries = manifest(&folder, manifest_name);
    let wrong: Vec<String> = entries
        .iter()
        .filter_map(|entry| {
            let (trace, _) = record(&scene(&folder, entry), RootSearch::OnDemand);
            difference(&folder, entry, &trace)
        })
        .collect();
    assert!(wrong.is_empty(), "{} of {} traces differ:\n{}", wrong.len(), entries.len(), wrong.join("\n"));
    corpus::ran(test, entries.len());
}

#[test]
fn course_scenes_are_recorded_byte_for_byte() {
    all_are_byte_identical("course_scenes_are_recorded_byte_for_byte", "manifest.json");
}

#[test]
fn scenes_of_earlier_milestones_are_recorded_byte_for_byte() {
    let name = "scenes_of_earlier_milestones_are_recorded_byte_for_byte";
    all_are_byte_identical(name, "manifest-earlier-milestones.json");
}

/// The contest of Theme 2, Milestone 3 sums its forces in a different order from all others.
#[test]
fn scenes_of_the_contest_are_recorded_byte_for_byte() {
    let Some(folder) = corpus::folder() else { return };
    let mut cases = 0;
    for group in ["TestingScenes", "TimingScenes"] {
        let Ok(files) = std::fs::read_dir(folder.join("t2m3").join(group)) else { continue };
        let names =
            files.map(|file| file.expect("a file").path()).filter(|path| path.extension() == Some("xml".as_ref()));
        for path in names {
            let bytes = std::fs::read(&path).expect("a readable scene");
            let scene = original::read(&bytes).expect("a scene").scene;
            let (trace, _) = record(&scene, RootSearch::OnDemand);
            assert!(trace == corpus::unpack(&path.with_extension("bin.zst")), "{} differs", path.display());
            cases += 1;
        }
    }
    corpus::ran("scenes_of_the_contest_are_recorded_byte_for_byte", cases);
}

/// No certificate excludes an impact that the root finder finds, and certificates change no byte.
#[test]
fn certificates_agree_with_the_root_finder_on_every_course_scene() {
    let Some(folder) = corpus::folder() else { return };
    let entries = manifest(&folder, "manifest.json");
    for entry in &entries {
        let (trace, counts) = record(&scene(&folder, entry), RootSearch::Audit);
        assert_eq!(counts.disagreements, 0, "{}: {counts:?}", entry.scene);
        assert_eq!(counts.searched, counts.calls, "{}: an audit searches always", entry.scene);
        assert_eq!(difference(&folder, entry, &trace), None);
    }
    corpus::ran("certificates_agree_with_the_root_finder_on_every_course_scene", entries.len());
}
