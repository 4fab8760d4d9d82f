//! Mistakes in forces, integrators, the penalty force and simple responses, on the scenes of the milestones with and
//! without collisions.
use crate::diagnose::{
    Explanation, explain,
    known::{
        applicable_rows::{applicable_rows, is_state_mistake},
        find_known,
    },
};
use fosssim_model::{
    assignments::Assignment,
    scene::{Scene, original},
};
use fosssim_student::{self as student, Row, StepLog, Student, World, assignments::probe_scenes, find, step};
use std::{collections::BTreeSet, fs, path::Path};

/// Scenes with more bodies take long to simulate with all mistakes.
const MOST_PARTICLES: usize = 20;

/// Scenes with more steps of an integrator that solves systems also take long.
const MOST_STEPS: f64 = 8.0;

/// Returns the scenes of these milestones and their probe scenes, with their names.
#[expect(clippy::disallowed_methods, reason = "the scenes of the suites belong to a crate above this one")]
fn scenes() -> Vec<(String, Scene)> {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets");
    let mut scenes = Vec::new();
    for (milestone, key) in
        [(Assignment::T1M1, "t1m1"), (Assignment::T1M2, "t1m2"), (Assignment::T1M3, "t1m3"), (Assignment::T2M1, "t2m1")]
    {
        scenes.extend(probe_scenes(milestone).into_iter().map(|(name, scene)| (format!("{key}/{name}"), scene)));
        let probes = scenes.len();
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
        scenes[probes..].sort_by(|(one, _), (other, _)| one.cmp(other));
    }
    for (name, scene) in &mut scenes {
        if name.starts_with("t1m3") {
            scene.duration = scene.duration.min(MOST_STEPS * scene.time_step);
        }
    }
    // The programs of a milestone only get scenes that they can run.
    let is_met = |name: &str, scene: &Scene| scene.assignments().any(|explanation| name.starts_with(explanation.key()));
    scenes.retain(|(name, scene)| scene.particles.len() <= MOST_PARTICLES && is_met(name, scene));
    scenes
}

fn scene(name: &str) -> Scene {
    scenes().into_iter().find(|(own, _)| own == name).expect("a scene").1
}

fn trace(scene: &Scene, ids: &[&str]) -> Vec<u8> {
    let student =
        ids.iter().fold(Student::default(), |student, id| student.with_mistake(find(id).map(|row| row.mistake)));
    student::record_trace(scene, student).unwrap_or_else(|(bytes, _)| bytes)
}

/// Returns whether explanations name a mistake, as reported or as indistinguishable.
fn names(told: &[Explanation], id: &str) -> bool {
    told.iter().any(|one| one.key == id || one.same_as.iter().any(|other| other == id))
}

/// Each mistake is named on at least one scene. No other mistake is named instead on the scenes before it.
#[test]
fn every_mistake_of_states_is_named_and_taken_for_no_other() {
    let (mut named, mut asked, mut mistaken) = (BTreeSet::<&str>::new(), BTreeSet::new(), Vec::new());
    for (name, scene) in scenes() {
        let correct = trace(&scene, &[]);
        // A mistake that depends on the previous step is not a mistake within one step.
        let is_of_step = |row: &&Row| is_state_mistake(row) && !row.id.ends_with("not-cleared");
        let rows: Vec<&Row> =
            applicable_rows(&scene).filter(is_of_step).filter(|row| !named.contains(row.id)).collect();
        for row in rows {
            let trace = trace(&scene, &[row.id]);
            // Newton's method does not end with every mistake.
            if trace.len() == correct.len() {
                asked.insert(row.id);
            }
            let told = if trace == correct { Vec::new() } else { find_known(&scene, &trace[..]) };
            if names(&told, row.id) {
                named.insert(row.id);
            } else if let Some(one) = told.first() {
                mistaken.push(format!("{} on {name} is taken for {}", row.id, one.key));
            }
        }
    }
    assert!(mistaken.is_empty(), "{mistaken:#?}");
    let unnamed: Vec<_> = asked.difference(&named).collect();
    assert!(unnamed.is_empty(), "{unnamed:#?}");
}

/// A student wrote `n.normalized();` and threw its result away.
#[test]
fn a_spring_whose_direction_is_never_normalized_is_named() {
    for (name, id) in [
        ("t1m3/linear-with-drag", "spring-direction"),
        ("t1m3/linear-with-drag", "spring-direction-everywhere"),
        ("t1m2/damped-spring-turning", "spring-direction"),
    ] {
        let scene = scene(name);
        let told = explain(&scene, &trace(&scene, &[id]));
        let [one] = &told[..] else { panic!("{name}: {told:#?}") };
        assert!(one.key == id && one.is_complete(), "{name}: {one:#?}");
    }
}

#[test]
fn several_mistakes_of_states_are_named_together() {
    for (name, ids) in [
        ("t1m2/springs-share-a-particle", &["spring-direction", "symplectic-positions-doubled"][..]),
        ("t1m2/drag-and-pull-of-unequal-masses", &["gravitation-sign", "drag-mass"]),
        ("t1m2/drag-and-pull-of-unequal-masses", &["gravitation-missing", "drag-missing"]),
        ("t2m1/layers-of-balls-and-edges", &["penalty-particles-no-radii", "penalty-edges-sign"]),
        (
            "t2m1/layers-of-balls-and-edges",
            &["penalty-particles-missing", "penalty-edges-missing", "penalty-half-planes-missing"],
        ),
    ] {
        let scene = scene(name);
        let told = explain(&scene, &trace(&scene, ids));
        assert_eq!(told.len(), ids.len(), "{name}: {told:#?}");
        let are_named = ids.iter().all(|id| names(&told, id));
        assert!(are_named && told.iter().all(Explanation::is_complete), "{ids:?} on {name}: {told:#?}");
    }
}

/// A mistake in a file that the library supplies is not the student's.
#[test]
fn only_files_of_the_student_are_named() {
    for (name, id) in [
        ("t1m2/drag-alone", "jacobian-drag-missing"),
        ("t1m2/explicit-euler-orbit", "explicit-positions-doubled"),
        ("t2m1/balls-meet", "symplectic-positions-doubled"),
    ] {
        let row = find(id).expect("a row");
        assert!(applicable_rows(&scene(name)).all(|other| other.id != row.id), "{id} on {name}");
    }
}

/// Forces that are summed over several steps are visible only together with the previous step.
#[test]
fn forces_that_are_not_cleared_between_steps_are_named() {
    let scene = scene("t1m1/two-fields-and-a-fixed-particle");
    let world = World::new(scene.clone(), Student::default());
    let mut state = world.initial_state();
    let (mut bytes, mut sum) = (Vec::new(), vec![0.0; state.x.len()]);
    let mut write = |state: &student::State| {
        state.x.iter().chain(&state.v).for_each(|value| bytes.extend(value.to_le_bytes()));
    };
    write(&state);
    for _ in 0..scene.step_count() {
        let mut right = state.clone();
        step(&world, &mut right, &mut StepLog::default(), &mut |_, _| ()).expect("a step");
        sum.iter_mut().zip(right.v.iter().zip(&state.v)).for_each(|(sum, (new, old))| *sum += new - old);
        state.x = right.x;
        state.v.iter_mut().zip(&sum).for_each(|(v, change)| *v += change);
        write(&state);
    }
    let told = explain(&scene, &bytes);
    assert!(told.len() == 1 && told[0].key == "explicit-velocities-not-cleared", "{told:#?}");
}

/// Each scene is computed with a different arithmetic: forces summed in another order, products fused with sums, or
/// states with the round-off of another solver.
#[test]
fn correct_programs_of_these_milestones_have_no_explanation() {
    for (index, (name, scene)) in scenes().into_iter().enumerate() {
        let trace = match index % 3 {
            0 => {
                let forces = scene.forces.iter().rev().copied().collect();
                trace(&Scene { forces, ..scene.clone() }, &[])
            }
            1 => trace(&scene, &["fused-arithmetic"]),
            _ => with_round_off(&scene, &trace(&scene, &[])),
        };
        let told = explain(&scene, &trace);
        assert!(told.iter().all(Explanation::reports_non_finite_value), "{name}: {told:#?}");
    }
}

/// Returns the trace with the round-off of another solver.
fn with_round_off(scene: &Scene, trace: &[u8]) -> Vec<u8> {
    let is_state = !matches!(scene.collision, fosssim_model::scene::Collision::Simple { .. });
    let numbers = trace.chunks_exact(8).map(|bytes| f64::from_le_bytes(bytes.try_into().expect("eight bytes")));
    let factor = |index: usize| if is_state && index % 7 == 3 { 1.0 + 1e-13 } else { 1.0 };
    numbers.enumerate().flat_map(|(index, number)| (number * factor(index)).to_le_bytes()).collect()
}

#[test]
fn the_probe_scenes_are_sound() {
    for milestone in [Assignment::T1M1, Assignment::T1M2, Assignment::T1M3, Assignment::T2M1, Assignment::T2M3] {
        let scenes = probe_scenes(milestone);
        assert!(!scenes.is_empty());
        for (name, scene) in scenes {
            assert_eq!(scene.assignment(), milestone, "{name}");
        }
    }
}
