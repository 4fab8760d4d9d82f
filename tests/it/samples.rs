//! The sample submissions as processes: the correct one equals the reference, and every wrong one differs from it.
#![expect(clippy::disallowed_types, reason = "these tests are about a program, so they start it")]

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
    process::{Command, Output},
};

use fosssim_oracle::{
    scene::original,
    sim::{RootSearch, Simulation},
    student::{self, Student},
    suite::scene_files,
    trace::{Layout, Recorder},
};
use rayon::prelude::*;
use serde::Deserialize;
use sha2::{Digest, Sha256};

use crate::corpus;

/// A row of `--list --json`.
#[derive(Deserialize)]
struct Row {
    id: String,
    kind: String,
    area: String,
    explanation: String,
}

#[derive(Deserialize)]
struct Listing {
    schema: String,
    mistakes: Vec<Row>,
}

/// The parts of the corpus's manifest that these tests need.
#[derive(Deserialize)]
struct Manifest {
    scenes: Vec<Entry>,
}

#[derive(Deserialize)]
struct Entry {
    scene: String,
    scene_file: String,
    sha256: String,
}

/// Returns the sample program.
fn sample() -> Command {
    Command::new(env!("CARGO_BIN_EXE_fosssim-sample"))
}

/// Runs a scene. The trace goes through a pipe, which accepts only sequential writes.
fn run(scene: &Path, mistake: Option<&str>) -> Output {
    let mut command = sample();
    command.arg("-s").arg(scene).args(["-d", "0", "-o", "/dev/stderr"]);
    if let Some(mistake) = mistake {
        command.args(["--mistake", mistake]);
    }
    command.output().expect("the sample starts")
}

fn trace(scene: &Path, mistake: Option<&str>) -> Vec<u8> {
    run(scene, mistake).stderr
}

fn catalog() -> Vec<Row> {
    let output = sample().args(["--list", "--json"]).output().expect("the sample starts");
    assert!(output.status.success());
    let listing: Listing = serde_json::from_slice(&output.stdout).expect("valid JSON");
    assert_eq!(listing.schema, "fosssim-sample/1");
    listing.mistakes
}

/// Returns whether a mistake belongs to forces, integrators or their consequences, which `crates/mistakes` tests with
/// its own probe scenes.
fn is_state_mistake(row: &Row) -> bool {
    let areas = ["forces", "jacobians", "integrator", "penalty", "near-pairs", "simple-detection"];
    areas.contains(&row.area.as_str()) || row.id.starts_with("respond-")
}

/// Returns all built-in scenes, in order.
fn assets() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    let files = scene_files::list_files(&folder, ".xml").expect("assets");
    let scenes: Vec<PathBuf> = files.into_iter().map(|file| file.path).collect();
    assert!(scenes.len() >= 20, "only {} scenes", scenes.len());
    scenes
}

fn asset(name: &str) -> PathBuf {
    assets().into_iter().find(|path| path.ends_with(name)).unwrap_or_else(|| panic!("no scene {name}"))
}

/// Returns the trace that the library's simulator records.
fn reference(path: &Path) -> Vec<u8> {
    let bytes = std::fs::read(path).expect("a readable scene");
    let scene = original::read(&bytes).unwrap_or_else(|refusal| panic!("{}: {refusal}", path.display())).scene;
    let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
    let mut recorder = Recorder::start(Vec::new(), Layout::for_scene(&scene), simulation.state());
    for _ in 0..scene.step_count() {
        simulation.step(&mut recorder).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    }
    recorder.finish().expect("writing to memory").0
}

#[test]
fn the_correct_sample_equals_the_simulator_on_every_built_in_scene() {
    let different: Vec<PathBuf> =
        assets().into_par_iter().filter(|scene| trace(scene, None) != reference(scene)).collect();
    assert!(different.is_empty(), "{different:?}");
}

#[test]
fn the_correct_sample_equals_the_original_on_every_scene_of_the_corpus() {
    let Some(folder) = corpus::folder() else { return };
    let mut entries = Vec::new();
    for name in ["manifest.json", "manifest-earlier-milestones.json"] {
        let text = std::fs::read_to_string(folder.join(name)).expect("a readable manifest");
        entries.extend(serde_json::from_str::<Manifest>(&text).expect("a manifest").scenes);
    }
    let different: Vec<&str> = entries
        .par_iter()
        .filter(|entry| {
            let digest = Sha256::digest(trace(&folder.join(&entry.scene_file), None));
            let digest: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
            digest != entry.sha256
        })
        .map(|entry| entry.scene.as_str())
        .collect();
    assert!(different.is_empty(), "{different:?}");
    corpus::ran("the_correct_sample_equals_the_original_on_every_scene_of_the_corpus", entries.len());
}

#[test]
fn the_catalog_is_large_and_every_id_is_accepted() {
    let rows = catalog();
    let count = |kind: &str| rows.iter().filter(|row| row.kind == kind).count();
    assert!(count("wrong") >= 95 && count("variant") >= 14);
    assert_eq!(rows.len(), count("wrong") + count("variant"));
    let ids: BTreeSet<&str> = rows.iter().map(|row| row.id.as_str()).collect();
    assert_eq!(ids.len(), rows.len(), "two rows have the same id");
    let table = sample().arg("--list").output().expect("the sample starts").stdout;
    let table = String::from_utf8(table).expect("text");
    for row in &rows {
        assert!(table.contains(&row.id) && table.contains(&row.explanation), "{}", row.id);
    }
    // Each program writes the same trace as the library's student.
    let scene = asset("ContinuousTimeTests/head-on-equal-masses.xml");
    let read = original::read(&std::fs::read(&scene).expect("a readable scene")).expect("a scene").scene;
    let different: Vec<&str> = rows
        .par_iter()
        .filter(|row| {
            let student = Student::new(student::find(&row.id).map(|row| row.mistake));
            let expected = student::record_trace(&read, student).unwrap_or_else(|(bytes, _)| bytes);
            trace(&scene, Some(&row.id)) != expected
        })
        .map(|row| row.id.as_str())
        .collect();
    assert!(different.is_empty(), "{different:?}");
}

/// Documents contain the number of mistakes, which must change with the catalog.
#[test]
fn documents_say_how_many_mistakes_and_variants_there_are() {
    let rows = catalog();
    let count = |kind: &str| rows.iter().filter(|row| row.kind == kind).count();
    let states = rows.iter().filter(|row| is_state_mistake(row)).count();
    let (wrong, variants) = (count("wrong") - states, count("variant"));
    for (document, sentences) in [
        (
            "README.md",
            vec![
                format!("all {wrong} documented mistakes"),
                format!("have {states} further mistakes"),
                format!("of {variants} correct variants"),
            ],
        ),
        (
            "docs/rules/measurements.md",
            vec![format!("all {wrong} mistakes and"), format!("and {variants} correct variants")],
        ),
        ("docs/rules/mistakes.md", vec![format!("{states} mistakes of forces")]),
    ] {
        let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(document)).expect(document);
        for sentence in sentences {
            assert!(text.contains(&sentence), "{document} does not say \"{sentence}\"");
        }
    }
}

#[test]
fn the_mistake_may_come_from_the_program_s_name() {
    let scene = asset("ContinuousTimeTests/head-on-equal-masses.xml");
    let expected = trace(&scene, Some("pp-no-two"));
    assert_ne!(expected, trace(&scene, None));

    let folder = tempfile::tempdir().expect("a folder");
    let link = folder.path().join("fosssim-sample.pp-no-two");
    std::os::unix::fs::symlink(env!("CARGO_BIN_EXE_fosssim-sample"), &link).expect("a link");
    let mut by_name = Command::new(link);
    by_name.arg("-s").arg(&scene).args(["-d", "0", "-o", "/dev/stderr"]);
    assert_eq!(by_name.output().expect("the sample starts").stderr, expected);
}

#[test]
fn faults_of_use_are_explained_and_end_with_status_2() {
    let scene = asset("ContinuousTimeTests/head-on-equal-masses.xml");
    let scene = scene.to_str().expect("a path in UTF-8");
    for (arguments, word) in [
        (&["-d", "0"][..], "--scene"),
        (&["-s", scene, "-d", "1"], "--display"),
        (&["-s", scene, "-d", "0", "--mistake", "no-two"], "pp-no-two"),
        (&["-s", scene, "-d", "0", "--mistake", "zzz"], "--list"),
        (&["--json"], "--list"),
        (&["-s", scene, "-d", "0", "--frobnicate"], "--frobnicate"),
    ] {
        let output = sample().args(arguments).output().expect("the sample starts");
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(message.contains(word), "{arguments:?}: {message}");
    }
    let output = sample().args(["-s", "no-such-scene.xml", "-d", "0"]).output().expect("the sample starts");
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no-such-scene.xml"));
}

/// NaN positions would make the course's root finder run forever. The sample prints a message and stops.
#[test]
fn a_run_that_would_never_end_stops_with_status_3() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("massless.xml");
    // Without a mass, its acceleration is 0 / 0.
    let text = "<scene><duration time=\"1\"/><integrator type=\"explicit-euler\" dt=\"0.1\"/>\
        <collision type=\"continuous-time\"/><simplegravity fx=\"0\" fy=\"-1\"/>\
        <particle m=\"0\" px=\"0\" py=\"5\" vx=\"1\" vy=\"0\" fixed=\"0\" radius=\"0.5\"/>\
        <particle m=\"1\" px=\"-9\" py=\"0\" vx=\"0\" vy=\"0\" fixed=\"1\"/>\
        <particle m=\"1\" px=\"9\" py=\"0\" vx=\"0\" vy=\"0\" fixed=\"1\"/><edge i=\"1\" j=\"2\"/></scene>";
    std::fs::write(&scene, text).expect("a scene");
    let output = sample().arg("-s").arg(&scene).args(["-d", "0"]).output().expect("the sample starts");
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(3), "{message}");
    assert!(message.contains("forever"), "{message}");
}
