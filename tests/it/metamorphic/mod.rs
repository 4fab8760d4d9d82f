//! Properties that follow from physics and mathematics, independent of the original's numbers (numerics.md 4):
//! conserved quantities, changes of coordinates or names, exact decisions, and constant verdicts. All searches have
//! fixed seeds.
mod conservation;
mod coordinates;
mod crowd;
mod decisions;
mod mended;
mod transform;
mod tunnelling;
mod verdicts;

use fosssim_oracle::{
    scene::{Scene, original},
    suite::library,
};
use proptest::{
    prelude::*,
    test_runner::{RngSeed, TestCaseResult, TestRunner},
};

/// Returns all built-in scenes by name.
fn built_in() -> Vec<(&'static str, Scene)> {
    let scene =
        |name| original::read(library::find_scene(name).expect("a built-in scene")).expect("a sound scene").scene;
    library::scene_names().map(|name| (name, scene(name))).collect()
}

/// Runs `test` on `cases` values, the same ones every time.
fn search<S: Strategy>(cases: u32, values: &S, test: impl Fn(S::Value) -> TestCaseResult) {
    let config = ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(11),
        failure_persistence: None,
        max_shrink_iters: 2000,
        ..ProptestConfig::default()
    };
    if let Err(failure) = TestRunner::new(config).run(values, test) {
        panic!("{failure}");
    }
}
