use super::*;
use crate::{library, plan};
use fosssim_model::scene::read;

fn of(text: &str) -> Coverage {
    Coverage::for_scene(&read("scene", text.as_bytes()).expect("a scene").scene).expect("a run")
}

fn has(coverage: &Coverage, one: &str, other: &str) -> bool {
    let is = |pairing: &Pairing| pairing.describe() == format!("{one}, {other}");
    assert!(Pairing::all().any(|pairing| is(&pairing)), "no such pair: {one}, {other}");
    Pairing::all().any(|pairing| is(&pairing) && coverage.contains(pairing))
}

#[test]
fn events_are_counted_with_their_properties() {
    // Two discs run side by side into each other's edge in a scene without impulses: the zone moves and does not turn.
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
    for name in library::scene_names() {
        let scene = read(name, library::find_scene(name).expect("a scene")).expect("sound").scene;
        let seen = Coverage::for_scene(&scene).expect("a run").pairings;
        let wrong: Vec<String> =
            seen.iter().filter(|one| !one.is_possible()).map(|one| format!("{name}: {}", one.describe())).collect();
        assert!(wrong.is_empty(), "{wrong:#?}");
    }
}

#[test]
fn the_newest_version_contains_more_than_the_one_before() {
    let covered = |suite: &str| {
        let mut coverage = Coverage::default();
        for task in plan::find_suite(suite).expect("a suite").scenes() {
            coverage.add(&Coverage::for_scene(&task.scene).expect("a run"));
        }
        (0..FAMILIES.len())
            .map(|family| coverage.counts(family))
            .fold((0, 0), |all, one| (all.0 + one.0, all.1 + one.1))
    };
    let (first, newest) = (covered("t2m2@1"), covered("t2m2@2"));
    assert_eq!(first.1, newest.1);
    // The numbers in `suite check t2m2`, and in docs/rules/measurements.md.
    assert_eq!((first, newest), ((1393, 2117), (1936, 2117)));
}
