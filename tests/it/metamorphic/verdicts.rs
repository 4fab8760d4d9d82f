//! The verdicts of the fair rules do not depend on the coordinates of the scene.
use super::{built_in, transform::Map};
use fosssim_oracle::{
    judge::{
        fair::FairVerdict,
        replay::{Options, judge},
    },
    scene::Scene,
    student::{self, Student},
};
use rayon::prelude::*;

const SCENES: [&str; 9] = [
    "ContinuousTimeTests/spinning-edge-sweeps-balls",
    "ContinuousTimeTests/oblique-glancing-blow",
    "ContinuousTimeTests/stretching-edge-meets-balls",
    "GeometricTests/triangle-of-unequal-masses",
    "GeometricTests/zone-grows-ball-by-ball",
    "GeometricTests/chain-pushed-into-a-half-plane",
    "HalfPlaneTests/normals-of-length-two-and-one-half",
    "ImpulsesTests/limit-just-enough",
    "ImpulsesTests/off-centre-on-turning-edge",
];

const MISTAKES: [&str; 16] = [
    "pp-no-two",
    "pp-radii-squared-apart",
    "pe-square-no-eh",
    "pe-cubic-parentheses",
    "pe-approach-constant-alpha",
    "pe-alpha-high-half-slope",
    "ph-no-normal-square",
    "ph-approach-no-speed",
    "pp-contact-at-start",
    "pe-contact-alpha-middle",
    "decision-open-interval",
    "response-halved",
    "response-masses-swapped",
    "loop-one-fewer",
    "zones-not-merged",
    "failsafe-no-rotation",
];

const CORRECT: [&str; 4] = ["rearranged-pe", "quintic-right", "scale-3", "rotation-matrix"];

fn maps() -> [Map; 5] {
    [
        Map { rows: [[0.0, -1.0], [1.0, 0.0]], ..Map::NONE },
        Map { rows: [[-1.0, 0.0], [0.0, 1.0]], ..Map::NONE },
        Map { shift: [3.25, -11.5], ..Map::NONE },
        Map::turn(0.7),
        Map { factor: 3.0, ..Map::NONE },
    ]
}

/// Returns whether the program's trace is accepted. A program that never ends is not accepted.
fn is_accepted(scene: &Scene, id: Option<&str>) -> bool {
    let mistake = id.map(|id| student::find(id).expect("a row of the catalog").mistake);
    let Ok(trace) = student::record_trace(scene, Student::new(mistake)) else { return false };
    let options = Options { threads: 1, uses_fair_rules: true, ..Options::default() };
    let fair = judge(scene, &trace[..], &options, &mut ()).fair.expect("the fair rules were asked");
    fair.verdict == FairVerdict::Accepted
}

#[test]
fn verdicts_do_not_depend_on_coordinates() {
    let scenes: Vec<(&str, Scene)> = built_in().into_iter().filter(|(name, _)| SCENES.contains(name)).collect();
    assert_eq!(scenes.len(), SCENES.len());
    let programs = MISTAKES.iter().chain(&CORRECT).map(|&id| Some(id)).chain([None]);
    let cases: Vec<_> = programs.flat_map(|id| scenes.iter().map(move |scene| (id, scene))).collect();
    let judged: Vec<(Option<&str>, bool, Vec<String>)> = cases
        .into_par_iter()
        .map(|(id, (name, scene))| {
            let accepted = is_accepted(scene, id);
            let other = maps()
                .into_iter()
                .filter(|map| is_accepted(&map.scene(scene), id) != accepted)
                .map(|map| format!("{id:?} on {name}: accepted {accepted}, but not so with {map:?}"));
            (id, accepted, other.collect())
        })
        .collect();
    let different: Vec<&String> = judged.iter().flat_map(|case| &case.2).collect();
    assert!(different.is_empty(), "{different:#?}");
    for (id, accepted, _) in &judged {
        let is_mistake = id.is_some_and(|id| MISTAKES.contains(&id));
        assert!(*accepted || is_mistake, "{id:?}");
    }
    for mistake in MISTAKES {
        assert!(judged.iter().any(|(id, accepted, _)| *id == Some(mistake) && !accepted), "{mistake}");
    }
}
