use super::*;
use crate::{library, plan};
use fosssim_mistakes::{
    assignments::probe_scenes,
    sight::{Watched, witnesses, wrong_programs},
    student::{
        Student,
        operators::{equivalent, mutations},
    },
};
use fosssim_model::scene::read;

fn of(text: &str) -> Coverage {
    Coverage::of(&read("scene", text.as_bytes()).expect("a scene").scene).expect("a run")
}

fn has(coverage: &Coverage, one: &str, other: &str) -> bool {
    let is = |pairing: &Pairing| pairing.words() == format!("{one}, {other}");
    assert!(Pairing::all().any(|pairing| is(&pairing)), "no such pair: {one}, {other}");
    Pairing::all().any(|pairing| is(&pairing) && coverage.has(pairing))
}

#[test]
fn what_happens_is_seen_with_its_properties() {
    // Two discs run side by side into one another's edge of a world without impulses: a zone that shifts and does not
    // turn.
    let coverage = of(r#"<scene><duration time="0.5"/><integrator type="explicit-euler" dt="0.5"/>
        <collision type="hybrid" COR="0.5" maxiters="0" k="0" thickness="0"/>
        <particle m="1" px="0" py="0" vx="4" vy="0" fixed="0" radius="1"/>
        <particle m="3" px="3" py="0" vx="0" vy="0" fixed="0" radius="1"/></scene>"#);
    assert!(has(&coverage, "held by: nothing", "motion: shifts only"));
    assert!(has(&coverage, "time: within the step", "masses: unequal"));
    assert!(has(&coverage, "impulses: the limit is 0", "zones: one"));
    assert!(!has(&coverage, "held by: nothing", "motion: turns"));
    assert!(!has(&coverage, "fixed: the first", "masses: unequal"));
}

#[test]
fn earlier_assignments_contain_nothing_of_this() {
    let coverage = of(r#"<scene><duration time="1"/><integrator type="explicit-euler" dt="0.5"/>
        <collision type="simple" COR="1"/><particle m="1" px="0" py="0" vx="4" vy="0" fixed="0" radius="1"/></scene>"#);
    assert!(coverage.is_empty());
}

#[test]
fn nothing_is_seen_that_cannot_be() {
    for name in library::names() {
        let scene = read(name, library::scene(name).expect("a scene")).expect("sound").scene;
        let seen = Coverage::of(&scene).expect("a run").seen;
        let wrong: Vec<String> =
            seen.iter().filter(|one| !one.is_possible()).map(|one| format!("{name}: {}", one.words())).collect();
        assert!(wrong.is_empty(), "{wrong:#?}");
    }
}

fn watched(suite: &str) -> Vec<Watched> {
    let plan = plan::find(suite).expect("a suite");
    let mut scenes: Vec<Watched> =
        plan.scenes().map(|task| Watched::new(task.name.clone(), task.scene.clone())).collect();
    scenes.sort_by_key(Watched::work);
    scenes
}

/// The small form of `scripts/sight-matrix`, which asks all of them.
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

#[test]
fn the_newest_version_contains_more_than_the_one_before() {
    let covered = |suite: &str| {
        let mut coverage = Coverage::default();
        for task in plan::find(suite).expect("a suite").scenes() {
            coverage.add(&Coverage::of(&task.scene).expect("a run"));
        }
        (0..FAMILIES.len())
            .map(|family| coverage.counts(family))
            .fold((0, 0), |all, one| (all.0 + one.0, all.1 + one.1))
    };
    let (first, newest) = (covered("t2m2@1"), covered("t2m2@2"));
    assert_eq!(first.1, newest.1);
    // What `suite check t2m2` says, and docs/fair.md.
    assert_eq!((first, newest), ((1393, 2117), (1936, 2117)));
}
