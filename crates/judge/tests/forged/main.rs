//! Tests that the fair rules accept a trace only for a valid reason, and that they accept programs that multiply their
//! polynomials by factors.
#![forbid(unsafe_code)]
mod forge;

use forge::{Random, Stage, forge, misprint, multiply};
use fosssim_model::scene::original;
use std::path::Path;

/// Returns the built-in scenes that log polynomials.
fn stages() -> Vec<Stage> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/t2m2");
    let mut files: Vec<_> = std::fs::read_dir(&folder)
        .expect("the scenes")
        .flat_map(|group| std::fs::read_dir(group.expect("a group").path()).expect("a group"))
        .map(|file| file.expect("a scene").path())
        .collect();
    files.sort();
    let stages: Vec<Stage> = files
        .iter()
        .filter_map(|path| {
            let name = path.strip_prefix(&folder).expect("within").display().to_string();
            let scene = original::read(&std::fs::read(path).expect("readable")).expect("a scene").scene;
            Stage::of(&name, scene)
        })
        .collect();
    assert!(stages.len() > 60, "{}", stages.len());
    stages
}

/// Tries the given number of changes of each scene, and returns the results that are not allowed.
fn faults(of_each: u64, attempt: fn(&Stage, &mut Random) -> Option<String>) -> Vec<String> {
    let mut faults = Vec::new();
    for (number, stage) in stages().iter().enumerate() {
        let mut random = Random::new(number as u64 + 1);
        faults.extend((0..of_each).filter_map(|_| attempt(stage, &mut random)));
    }
    faults
}

#[test]
fn nothing_that_is_missing_or_exchanged_passes_without_a_reason() {
    let faults = faults(COUNT, forge);
    assert!(faults.is_empty(), "{}: {:#?}", faults.len(), &faults[..faults.len().min(12)]);
}

#[test]
fn programs_with_factors_have_only_lost_decisions() {
    let faults = faults(COUNT, multiply);
    assert!(faults.is_empty(), "{}: {:#?}", faults.len(), &faults[..faults.len().min(12)]);
}

#[test]
fn a_wrong_formula_beside_a_right_one_is_no_wrong_position() {
    let faults = faults(4 * COUNT, misprint);
    assert!(faults.is_empty(), "{}: {:#?}", faults.len(), &faults[..faults.len().min(12)]);
}

const COUNT: u64 = 8;
