//! Searches with artificial mistakes, in the scenes of the contest's suite.
use super::{pair_traits, variants};
use crate::diagnose::{Explanation, ExplanationTopic, PairCounts, WrongPairs, explain, explain_together};
use fosssim_model::{
    scene::{Collision, Scene, original},
    sim::PairKind,
};
use fosssim_student::{Student, find, formula_detector::find_formula, record_trace};
use std::{fs, path::Path};

#[expect(clippy::disallowed_methods, reason = "the scenes of the suites belong to a crate above this one")]
fn scenes() -> Vec<Scene> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/t2m3/NearPairTests");
    let paths = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    paths.map(|path| original::read(&fs::read(path).expect("a file")).expect("a scene").scene).collect()
}

/// Returns the wrong pairs in the traces of a program with this mistake in its search.
fn told(id: &str, scenes: &[Scene]) -> WrongPairs {
    let student = Student::new(find(id).map(|row| row.mistake));
    let explained = |scene: &Scene| explain(scene, &record_trace(scene, student).expect("a trace"));
    let traces: Vec<Vec<Explanation>> = scenes.iter().map(explained).collect();
    let told = explain_together(traces.iter().map(Vec::as_slice), &[]);
    let [Explanation { topic: ExplanationTopic::Pairs(wrong), .. }] = &told[..] else { panic!("{id}: {told:#?}") };
    wrong.clone()
}

#[test]
fn wrong_pairs_are_reported_with_their_common_properties() {
    let scenes = scenes();
    for (id, kind, times, word) in [
        ("near-pairs-first-missing", PairKind::ParticleParticle, 0, "first body"),
        ("near-pairs-last-missing", PairKind::ParticleParticle, 0, "last particle"),
        ("near-pairs-last-edge-missing", PairKind::ParticleEdge, 0, "last edge"),
        ("near-pairs-last-half-plane-missing", PairKind::ParticleHalfPlane, 0, "last edge or half-plane"),
        ("near-pairs-doubled", PairKind::ParticleParticle, 2, ""),
        ("near-pairs-edges-doubled", PairKind::ParticleEdge, 2, ""),
        ("near-pairs-half-planes-doubled", PairKind::ParticleHalfPlane, 2, ""),
        ("near-pairs-neighbors-only", PairKind::ParticleParticle, 0, "between the two horizontally"),
        ("near-pairs-boxes-of-points", PairKind::ParticleParticle, 0, ""),
        ("near-pairs-edge-ends", PairKind::ParticleEdge, 0, "far from both ends"),
        ("near-pairs-edge-first-end", PairKind::ParticleEdge, 0, "far from the edge's first end"),
        ("near-pairs-of-start", PairKind::ParticleParticle, 0, "apart at the start"),
        ("near-pairs-of-last-step", PairKind::ParticleParticle, 0, "apart shortly before"),
        ("near-pairs-fixed-skipped", PairKind::ParticleParticle, 0, "fixed"),
    ] {
        let wrong = told(id, &scenes);
        let pairs = &wrong.counts_by_kind[kind as usize];
        let words: Vec<String> = pair_traits(pairs, times).into_iter().map(|one| one.description).collect();
        let is_told = if word.is_empty() {
            20 * pairs.counts_by_times[1] <= pairs.counts_by_times[times]
        } else {
            words.len() == 1
        };
        let is_right = pairs.counts_by_times[times] > 0 && words.iter().all(|one| one.contains(word));
        assert!(
            is_told && is_right && (!word.is_empty() || words.is_empty()),
            "{id}: {:?}, {words:?}",
            pairs.counts_by_times
        );
    }
}

/// A missing search gives the same states as the scene without collisions.
#[test]
fn no_pair_of_any_kind_is_found_without_a_search() {
    let mut told: Vec<Explanation> = Vec::new();
    for scene in scenes() {
        let trace =
            record_trace(&Scene { collision: Collision::None, ..scene.clone() }, Student::default()).expect("a trace");
        told.extend(explain(&scene, &trace));
    }
    let kinds: Vec<&PairCounts> = told
        .iter()
        .flat_map(|one| match &one.topic {
            ExplanationTopic::Pairs(wrong) => &wrong.counts_by_kind,
            _ => panic!("{one:#?}"),
        })
        .collect();
    let [missing, once, twice] = [0, 1, 2].map(|times| kinds.iter().map(|one| one.counts_by_times[times]).sum::<u64>());
    assert!(50 * (once + twice) <= missing, "{missing} missing, {once} once, {twice} twice");
    assert!(PairKind::ALL.iter().all(|kind| kinds.iter().any(|one| one.kind == *kind && one.counts_by_times[0] > 0)));
}

/// A property is not a cause if there are hardly any right pairs for comparison.
#[test]
fn a_property_without_right_pairs_is_not_reported() {
    let traits_of = |[wrong, right, with]: [u64; 3]| {
        let traits = vec![[wrong, with, 0]; variants().count()];
        pair_traits(&PairCounts { kind: PairKind::ParticleParticle, counts_by_times: [wrong, right, 0], traits }, 0)
            .len()
    };
    assert_eq!(traits_of([196, 5, 0]), 0);
    assert_ne!(traits_of([196, 40, 2]), 0);
}

#[test]
fn no_trait_gives_a_formula_away() {
    for one in variants() {
        assert_eq!(find_formula(&one.describe()), None, "{}", one.describe());
    }
}
