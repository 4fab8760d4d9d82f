//! Right traces made wrong at random, and programs whose polynomials have factors, on all scenes that come with the
//! program and on those of a corpus: nothing passes the fair rules without a reason, and factors are charged with
//! nothing but lost decisions.
#[path = "../../../../judge/tests/forged/forge.rs"]
mod forge;

use forge::{Random, Stage};
use fosssim_oracle::{scene::original, suite::library};
use std::{
    path::{Path, PathBuf},
    process::ExitCode,
    sync::{
        Mutex,
        atomic::{AtomicUsize, Ordering},
    },
};

/// The greatest number of faults that are shown.
const SHOWN: usize = 40;

/// Tries this number of each kind on each scene, those of a corpus's folder, if there is one, among them.
pub fn run(of_each: u64, seed: u64, corpus: Option<&Path>) -> ExitCode {
    let scenes = scenes(corpus);
    let (next, faults) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some((name, bytes)) = scenes.get(number) else { return };
            let Some(stage) = original::read(bytes).ok().and_then(|read| Stage::of(name, read.scene)) else { continue };
            let mut random = Random::new(seed.wrapping_mul(1_000_003) + number as u64);
            for _ in 0..of_each {
                let tried =
                    [forge::forge, forge::multiply, forge::misprint].map(|attempt| attempt(&stage, &mut random));
                faults.lock().expect("no other thread has panicked").extend(tried.into_iter().flatten());
            }
        }
    };
    std::thread::scope(|scope| {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        (0..threads).for_each(|_| _ = scope.spawn(work));
    });
    let faults = faults.into_inner().expect("no thread has panicked");
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
