//! Known mistakes are recognized on the built-in scenes. `scripts/explanation-matrix` measures it on all of them.
use fosssim_oracle::{
    diagnose::find_known,
    scene::{Scene, original},
    student::{self, CATALOG, RowKind, Student},
    suite::library,
};
use rayon::prelude::*;

/// Small scenes that together show most of the mistakes.
const SCENES: [&str; 10] = [
    "ContinuousTimeTests/fixed-obstacles",
    "ContinuousTimeTests/head-on-unequal-masses",
    "ContinuousTimeTests/row-struck-in-one-step",
    "ContinuousTimeTests/spinning-edge-sweeps-balls",
    "GeometricTests/limit-of-two-iterations",
    "GeometricTests/triangle-of-unequal-masses",
    "GeometricTests/zone-gains-the-half-plane-later",
    "HalfPlaneTests/corner-with-failsafe",
    "HalfPlaneTests/normal-of-length-five",
    "ImpulsesTests/off-centre-on-turning-edge",
];

fn scenes() -> Vec<(&'static str, Scene, Vec<u8>)> {
    let read = |name: &&'static str| {
        let scene = original::read(library::find_scene(name).expect("a scene")).expect("a sound scene").scene;
        let correct = student::record_trace(&scene, Student::default()).expect("a trace");
        (*name, scene, correct)
    };
    SCENES.iter().map(read).collect()
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Recognized {
    /// No scene shows the mistake more clearly than round-off.
    Unseen,
    /// The mistake is never named.
    Never,
    /// The trace cannot distinguish the mistake from the named one.
    Among,
    /// The mistake is named.
    First,
}

#[test]
fn most_mistakes_are_named_on_their_best_scene() {
    let scenes = scenes();
    let recognized: Vec<(&str, Recognized)> = CATALOG
        .par_iter()
        .filter(|row| row.kind == RowKind::Wrong)
        .map(|row| {
            let outcomes = scenes.iter().map(|(_, scene, correct)| {
                let trace =
                    student::record_trace(scene, Student::new(Some(row.mistake))).unwrap_or_else(|(bytes, _)| bytes);
                if trace == *correct {
                    return Recognized::Unseen;
                }
                match find_known(scene, &trace[..]).into_iter().next() {
                    None => Recognized::Unseen,
                    Some(explanation) if explanation.key == row.id => Recognized::First,
                    Some(explanation) if explanation.same_as.iter().any(|id| id == row.id) => Recognized::Among,
                    Some(_) => Recognized::Never,
                }
            });
            (row.id, outcomes.max().unwrap_or(Recognized::Unseen))
        })
        .collect();
    let count = |what: Recognized| recognized.iter().filter(|(_, outcome)| *outcome == what).count();
    let (first, among) = (count(Recognized::First), count(Recognized::Among));
    let seen = recognized.len() - count(Recognized::Unseen);
    assert!(seen * 10 >= recognized.len() * 9, "the scenes show only {seen} of {} mistakes", recognized.len());
    assert_eq!(first + among, seen, "{recognized:#?}");
    assert!(first * 10 >= seen * 9, "only {first} of {seen} are named first: {recognized:#?}");
}

#[test]
fn no_correct_variant_is_reported() {
    let accused: Vec<String> = scenes()
        .par_iter()
        .flat_map_iter(|(name, scene, _)| {
            CATALOG.iter().filter(|row| row.kind == RowKind::Variant).filter_map(move |row| {
                let trace =
                    student::record_trace(scene, Student::new(Some(row.mistake))).unwrap_or_else(|(bytes, _)| bytes);
                let first = find_known(scene, &trace[..]).into_iter().next()?;
                Some(format!("{} on {name}: {}", row.id, first.key))
            })
        })
        .collect();
    assert!(accused.is_empty(), "{accused:#?}");
}

/// A right particle-edge approach differs from the supplied one in every step, and is accepted.
#[test]
fn a_right_approach_hides_no_mistake() {
    let all = scenes();
    let (_, scene, _) = all.iter().find(|(name, ..)| name.ends_with("spinning-edge-sweeps-balls")).expect("the scene");
    let trace = |mistake| {
        let student = Student::new(mistake).with_right_approach();
        student::record_trace(scene, student).unwrap_or_else(|(bytes, _)| bytes)
    };
    let correct = trace(None);
    assert_eq!(find_known(scene, &correct[..]), []);
    let rows = CATALOG.iter().filter(|row| row.kind == RowKind::Wrong && !row.id.starts_with("pe-approach"));
    let mut seen = 0;
    let mut unnamed = Vec::new();
    for row in rows {
        let trace = trace(Some(row.mistake));
        if trace != correct {
            seen += 1;
            let first = find_known(scene, &trace[..]).into_iter().next();
            if !first.is_some_and(|first| first.key == row.id || first.same_as.contains(&row.id.to_owned())) {
                unnamed.push(row.id);
            }
        }
    }
    assert!(seen > 80 && unnamed.len() * 20 <= seen, "of {seen} mistakes are not named: {unnamed:?}");
}
