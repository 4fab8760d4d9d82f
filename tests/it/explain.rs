//! Explanations: what is said of each known mistake, by one trace and by several.
use super::fair::{assets, rows, simulated};
use fosssim_oracle::{
    diagnose::{Explanation, common, explain},
    judge::{fair::Verdict, parity},
    scene::Scene,
    student::{Kind, Row},
};
use rayon::prelude::*;

/// Scenes that show most of what programs do: a teacher's small suite.
const SCENES: [&str; 16] = [
    "ContinuousTimeTests/explicit-euler-under-gravity",
    "ContinuousTimeTests/impact-exactly-at-step-end",
    "ContinuousTimeTests/spinning-edge-sweeps-balls",
    "ContinuousTimeTests/stretching-edge-meets-balls",
    "ForcesTests/forces-between-collisions",
    "GeometricTests/ball-on-a-fixed-edge",
    "GeometricTests/chain-pushed-into-a-half-plane",
    "GeometricTests/limit-of-three-iterations",
    "GeometricTests/tiny-edge-just-missed",
    "GeometricTests/triangle-of-unequal-masses",
    "HalfPlaneTests/moving-fixed-ball-and-impulses",
    "HalfPlaneTests/normals-of-length-two-and-one-half",
    "HalfPlaneTests/touched-exactly-at-step-end",
    "HolisticTests/pendulum-into-a-wall-of-balls",
    "HolisticTests/wheel-on-a-slope",
    "IntegratorTests/implicit-euler-then-collisions",
];

fn suite() -> Vec<(String, Scene)> {
    let scenes: Vec<_> = assets().into_iter().filter(|(name, _)| SCENES.contains(&name.as_str())).collect();
    assert_eq!(scenes.len(), SCENES.len());
    scenes
}

/// What is said of the row's traces that the fair rules reject.
fn explained(scenes: &[(String, Scene)], row: &Row) -> Vec<Vec<Explanation>> {
    let options = parity::Options { threads: 1, fair: true, ..parity::Options::default() };
    scenes
        .iter()
        .filter_map(|(_, scene)| {
            let trace = simulated(scene, Some(row))?;
            let outcome = parity::judge(scene, &trace[..], &options, &mut ());
            (outcome.fair?.verdict == Verdict::Rejected).then(|| explain(scene, &trace))
        })
        .collect()
}

#[test]
fn nine_of_ten_mistakes_are_named_first() {
    let scenes = suite();
    let rows = rows(Kind::Wrong);
    let named: Vec<Option<String>> = rows
        .par_iter()
        .map(|row| {
            let all = explained(&scenes, row);
            let first = common(all.iter().map(Vec::as_slice));
            match first {
                Some(first) if first.key == row.id => None,
                Some(first) => Some(format!("{}: {} {:?}", row.id, first.key, first.same_as)),
                None => Some(format!("{}: nothing, {} rejected traces", row.id, all.len())),
            }
        })
        .collect();
    let confused: Vec<&String> = named.iter().flatten().collect();
    eprintln!("{} of {} mistakes named first; the others:\n{confused:#?}", rows.len() - confused.len(), rows.len());
    assert!(10 * confused.len() <= rows.len(), "{confused:#?}");
}

/// No correct variant is accused of anything: the fair rules accept it, and nobody asks. Where one is asked about all the
/// same, no known mistake is named.
#[test]
fn correct_variants_are_not_accused() {
    let scenes = suite();
    rows(Kind::Variant).into_par_iter().for_each(|row| {
        for (name, scene) in &scenes {
            let trace = simulated(scene, Some(row)).unwrap();
            let found = explain(scene, &trace);
            let accused: Vec<&str> = found.iter().map(|explanation| explanation.key.as_str()).collect();
            assert!(accused.is_empty(), "{} on {name}: {accused:?}", row.id);
        }
    });
}
