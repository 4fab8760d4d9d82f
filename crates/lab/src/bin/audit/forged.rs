//! Right traces made wrong at random, and programs whose polynomials have factors, on all scenes that come with the
//! program and on those of a corpus: nothing passes the fair rules without a reason, and factors are charged with
//! nothing but lost decisions.
#[path = "../../../../judge/tests/forged/forge.rs"]
mod forge;

use forge::{Random, Stage};
use fosssim_oracle::{scene::original, suite::library};
use rayon::prelude::*;
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
};

/// The greatest number of faults that are shown.
const SHOWN: usize = 40;

/// Tries this number of each kind on each scene, those of a corpus's folder, if there is one, among them.
pub fn run(of_each: u64, seed: u64, corpus: Option<&Path>) -> ExitCode {
    let scenes = scenes(corpus);
    let faults_of = |(number, (name, bytes)): (usize, &(String, Vec<u8>))| {
        let Some(stage) = original::read(bytes).ok().and_then(|read| Stage::of(name, read.scene)) else {
            return Vec::new();
        };
        let mut random = Random::new(seed.wrapping_mul(1_000_003) + number as u64);
        let attempts = (0..of_each).flat_map(|_| [forge::forge, forge::multiply, forge::misprint]);
        attempts.filter_map(|attempt| attempt(&stage, &mut random)).collect()
    };
    let faults: Vec<_> = scenes.par_iter().enumerate().flat_map_iter(faults_of).collect();
    println!("{} scenes, 3 times {of_each} traces of each, {} faults", scenes.len(), faults.len());
    faults.iter().take(SHOWN).for_each(|fault| println!("{fault}"));
    ExitCode::from(u8::from(!faults.is_empty()))
}

/// The scenes that come with the program, and those of a corpus's folder, if there is one.
pub fn scenes(corpus: Option<&Path>) -> Vec<(String, Vec<u8>)> {
    let built_in = library::names().filter_map(|name| Some((name.to_owned(), library::scene(name)?.to_vec())));
    let mut scenes: Vec<(String, Vec<u8>)> = built_in.collect();
    for path in corpus.map(|corpus| scene_files(&corpus.join("scenes/t2m2"))).unwrap_or_default() {
        if let Ok(bytes) = std::fs::read(&path) {
            scenes.push((path.display().to_string(), bytes));
        }
    }
    scenes
}

/// All scenes below a folder.
pub(super) fn scene_files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for path in std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            found.extend(scene_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "xml") {
            found.push(path);
        }
    }
    found.sort();
    found
}
