//! The small form of `scripts/sight-matrix`.
use super::{witnesses, wrong_programs};
use crate::{
    operators::{equivalent, mutations},
    runs::Watched,
};
use fosssim_oracle::student::Student;

#[test]
fn every_eighth_wrong_program_is_refused_by_three_scenes_and_seen_by_a_probe() {
    let (scenes, programs) = (Watched::of_suite("t2m2").expect("a suite"), wrong_programs());
    let probes = Watched::probes();
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
    let scenes = Watched::of_suite("t2m2").expect("a suite");
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
