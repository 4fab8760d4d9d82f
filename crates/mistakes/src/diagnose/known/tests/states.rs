//! Mistakes of forces, integrators, the penalty force and simple responses, on the scenes of the milestones before and
//! behind collisions.
use crate::{
    assignments::probe_scenes,
    diagnose::{
        explain,
        known::{
            known,
            shown::{applicable, is_of_states},
        },
    },
    student::{self, Student, all_rows, find},
};
use fosssim_model::{
    assignments::Assignment,
    scene::{Scene, original},
};
use std::{collections::BTreeMap, fs, path::Path};

/// Scenes of more bodies take long to be simulated with all mistakes.
const MOST_PARTICLES: usize = 20;

/// So do many steps of an integrator that solves systems.
const MOST_STEPS: f64 = 8.0;

/// The scenes of these milestones and their probe scenes, with their names.
#[expect(clippy::disallowed_methods, reason = "the scenes of the suites belong to a crate above this one")]
fn scenes() -> Vec<(String, Scene)> {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets");
    let mut scenes = Vec::new();
    for (milestone, key) in [
        (Assignment::T1M1, "t1m1"),
        (Assignment::T1M2, "t1m2"),
        (Assignment::T1M3, "t1m3"),
        (Assignment::T2M1, "t2m1"),
        (Assignment::T2M3, "t2m3"),
    ] {
        scenes.extend(probe_scenes(milestone).into_iter().map(|(name, scene)| (format!("{key}/{name}"), scene)));
        for group in fs::read_dir(assets.join(key)).expect("a folder") {
            for file in fs::read_dir(group.expect("an entry").path()).expect("a folder") {
                let path = file.expect("an entry").path();
                if path.extension().is_some_and(|ending| ending == "xml") {
                    let scene = original::read(&fs::read(&path).expect("a file")).expect("a scene").scene;
                    let name = path.file_stem().expect("a name").to_string_lossy();
                    scenes.push((format!("{key}/{name}"), scene));
                }
            }
        }
    }
    for (name, scene) in &mut scenes {
        if name.starts_with("t1m3") {
            scene.duration = scene.duration.min(MOST_STEPS * scene.time_step);
        }
    }
    scenes.retain(|(_, scene)| scene.particles.len() <= MOST_PARTICLES);
    scenes
}

fn scene(name: &str) -> Scene {
    scenes().into_iter().find(|(own, _)| own == name).expect("a scene").1
}

fn trace(scene: &Scene, ids: &[&str]) -> Vec<u8> {
    let student = ids.iter().fold(Student::default(), |student, id| student.and(find(id).map(|row| row.mistake)));
    student::trace(scene, student).unwrap_or_else(|(bytes, _)| bytes)
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Named {
    /// The trace is the right one, or no more than round-off away from it, or ends at once.
    Not,
    /// It is among those that this trace can't tell apart from the one that is named.
    Among,
    First,
}

#[test]
fn every_mistake_of_states_is_named_and_taken_for_no_other() {
    let mut best: BTreeMap<&str, (Named, String)> = BTreeMap::new();
    let mut mistaken = Vec::new();
    for (name, scene) in scenes() {
        let correct = trace(&scene, &[]);
        for row in applicable(&scene).filter(|row| is_of_states(row)) {
            let trace = trace(&scene, &[row.id]);
            let told = if trace == correct { None } else { known(&scene, &trace[..]).into_iter().next() };
            let found = match told {
                None => (Named::Not, String::new()),
                Some(one) if one.key == row.id => (Named::First, format!("{:?}", one.same_as)),
                Some(one) if one.same_as.iter().any(|id| id == row.id) => {
                    (Named::Among, format!("{} {:?}", one.key, one.same_as))
                }
                Some(one) => {
                    mistaken.push(format!("{} on {name} is taken for {}", row.id, one.key));
                    continue;
                }
            };
            let entry = best.entry(row.id).or_insert((Named::Not, String::new()));
            if found.0 > entry.0 {
                *entry = found;
            }
        }
    }
    assert!(mistaken.is_empty(), "{mistaken:#?}");
    let not_first: Vec<_> = all_rows()
        .filter(|row| is_of_states(row))
        .map(|row| (row.id, best.get(row.id)))
        .filter(|(_, found)| found.is_none_or(|found| found.0 < Named::First))
        .collect();
    assert!(not_first.is_empty(), "{not_first:#?}");
}

/// A student wrote `n.normalized();` and threw its result away.
#[test]
fn a_spring_whose_direction_is_never_normalised_is_named() {
    for (name, id) in [
        ("t1m3/linearized-implicit-chain", "spring-direction"),
        ("t1m3/linearized-implicit-chain", "spring-direction-everywhere"),
        ("t1m3/implicit-euler-net-with-fixed-corners", "spring-direction-everywhere"),
        ("t1m2/damped-spring-turning", "spring-direction"),
    ] {
        let scene = scene(name);
        let told = explain(&scene, &trace(&scene, &[id]));
        let [one] = &told[..] else { panic!("{name}: {told:#?}") };
        // Newton's method comes to the same end without the right derivatives.
        assert!(one.key == id || one.same_as == [id], "{name}: {one:#?}");
        assert!(one.is_complete());
    }
}

#[test]
fn two_mistakes_of_states_are_named_together() {
    for (name, ids) in [
        ("t1m2/forward-backward-euler-swing", ["spring-direction", "gravity-sign"]),
        ("t1m2/all-forces-at-once", ["vortex-turn", "drag-mass"]),
        ("t1m3/linearized-implicit-chain", ["jacobian-velocity-missing", "spring-damping-sign"]),
        ("t2m1/pile-between-fixed-bodies", ["penalty-no-radii", "gravity-no-mass"]),
    ] {
        let scene = scene(name);
        let told = explain(&scene, &trace(&scene, &ids));
        assert_eq!(told.len(), 2, "{name}: {told:#?}");
        for id in ids {
            let is_named = told.iter().any(|one| one.key == id || one.same_as.iter().any(|other| other == id));
            assert!(is_named && told.iter().all(|one| one.is_complete()), "{id} on {name}: {told:#?}");
        }
    }
}

/// Other arithmetic: forces summed in another order, products fused with sums, and states with the round-off of
/// another solver.
#[test]
fn correct_programs_of_these_milestones_are_accused_of_nothing() {
    for (name, scene) in scenes() {
        let mut turned = scene.clone();
        turned.forces.reverse();
        let turned = trace(&turned, &[]);
        let fused = trace(&scene, &["fused-arithmetic"]);
        let noisy: Vec<u8> = trace(&scene, &[])
            .chunks_exact(8)
            .enumerate()
            .flat_map(|(index, bytes)| {
                let value = f64::from_le_bytes(bytes.try_into().expect("eight bytes"));
                let is_state = !matches!(scene.collision, fosssim_model::scene::Collision::Simple { .. });
                let factor = if is_state && index % 7 == 3 { 1.0 + 1e-13 } else { 1.0 };
                (value * factor).to_le_bytes()
            })
            .collect();
        for (what, trace) in [("turned", turned), ("fused", fused), ("noisy", noisy)] {
            let told = explain(&scene, &trace);
            assert!(told.iter().all(|one| one.is_not_finite()), "{what} {name}: {told:#?}");
        }
    }
}

#[test]
fn the_probe_scenes_are_sound() {
    for milestone in [Assignment::T1M3, Assignment::T2M1, Assignment::T2M3] {
        let scenes = probe_scenes(milestone);
        assert!(!scenes.is_empty());
        for (name, scene) in scenes {
            assert_eq!(scene.assignment(), milestone, "{name}");
        }
    }
}
