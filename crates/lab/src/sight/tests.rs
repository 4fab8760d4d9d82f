//! The small form of `scripts/sight-matrix`.
use super::{Watched, witnesses, wrong_programs};
use crate::operators::{equivalent, mutations};
use fosssim_oracle::{assignments::Assignment, diagnose::probe_scenes, student::Student, suite::plan};

fn watched(suite: &str) -> Vec<Watched> {
    let plan = plan::find(suite).expect("a suite");
    let mut scenes: Vec<Watched> =
        plan.scenes().map(|task| Watched::new(task.name.clone(), task.scene.clone())).collect();
    scenes.sort_by_key(Watched::work);
    scenes
}

#[test]
fn every_eighth_wrong_program_is_refused_by_three_scenes_and_seen_by_a_probe() {
    let (scenes, programs) = (watched("t2m2"), wrong_programs());
    let probes: Vec<Watched> =
        probe_scenes(Assignment::T2M2).into_iter().map(|(name, scene)| Watched::new(name, scene)).collect();
    assert!(programs.len() > 800, "{}", programs.len());
    let unseen: Vec<String> = programs
        .iter()
        .step_by(8)
        .filter_map(|one| {
            let suite = witnesses(&scenes, one.student, 3);
            let probes = witnesses(&probes, one.student, 1);
            (suite.len() < 3 || probes.is_empty()).then(|| format!("{}: {suite:?}, {probes:?}", one.name))
        })
        .collect();
    assert!(unseen.is_empty(), "{unseen:#?}");
}

#[test]
fn no_scene_refuses_a_mutation_that_is_said_to_change_nothing() {
    let scenes = watched("t2m2");
    let refused: Vec<String> = mutations()
        .into_iter()
        .filter(|mutation| equivalent(*mutation).is_some())
        .filter_map(|mutation| {
            let refusing = witnesses(&scenes, Student::default().with_mutation(mutation), 1);
            (!refusing.is_empty()).then(|| format!("{mutation}: {refusing:?}"))
        })
        .collect();
    assert!(refused.is_empty(), "{refused:#?}");
}
