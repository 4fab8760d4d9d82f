//! If no known mistake explains wrong states, the first wrong quantity is reported.
use crate::diagnose::{
    ChangeRatio, ChangedParticles, Detail, Explanation, ExplanationTopic, Quantity, StageDetail, StageFault,
    WrongChange, WrongDecisions, correct_trace, explain, explain_together, mistake_is_visible, refuted_keys,
};
use fosssim_model::{
    assignments::{ForceKind, Integrator, Part},
    scene::{Scene, original},
    sim::PairKind,
};
use fosssim_student::{self as student, Student, find};
use std::collections::BTreeSet;

const FALL: &str = r#"<scene><duration time="1"/><integrator type="explicit-euler" dt="0.1"/>
    <simplegravity fx="0.1" fy="-0.8"/>
    <particle m="2" px="-1" py="0" vx="0.3" vy="0.5" fixed="0" radius="0.1"/>
    <particle m="3" px="1" py="0.4" vx="-0.2" vy="1" fixed="0" radius="0.1"/></scene>"#;

const BALLS: &str = r#"<scene><duration time="1"/><integrator type="symplectic-euler" dt="0.1"/>
    <collision type="simple" COR="0.5"/>
    <particle m="2" px="-1" py="0" vx="1" vy="0.1" fixed="0" radius="0.3"/>
    <particle m="3" px="0.5" py="0.1" vx="-1" vy="0" fixed="0" radius="0.3"/></scene>"#;

fn scene(text: &str) -> Scene {
    original::read(text.as_bytes()).expect("a scene").scene
}

fn right(scene: &Scene) -> Vec<u8> {
    student::record_trace(scene, Student::default()).expect("a trace")
}

#[test]
fn wrong_positions_are_reported_with_their_factor() {
    let scene = scene(FALL);
    let numbers: Vec<f64> =
        right(&scene).chunks_exact(8).map(|bytes| f64::from_le_bytes(bytes.try_into().expect("eight bytes"))).collect();
    // Each record has four coordinates and four velocities.
    let mut positions: Vec<f64> = numbers[..4].to_vec();
    let mut trace = Vec::new();
    for record in numbers.chunks_exact(8) {
        trace.extend(positions.iter().chain(&record[4..]).flat_map(|number| number.to_le_bytes()));
        positions.iter_mut().zip(&record[4..]).for_each(|(x, v)| *x += 0.1 * 2.5 * v);
    }
    let told = explain(&scene, &trace);
    let [Explanation { topic: ExplanationTopic::Stage(StageFault::Change(wrong)), details, .. }] = &told[..] else {
        panic!("{told:#?}")
    };
    let expected = WrongChange {
        quantity: Quantity::Position,
        axis: None,
        particles: ChangedParticles::Any,
        ratio: ChangeRatio::Factor,
        parts: BTreeSet::from([Part::Integrator(Integrator::ExplicitEuler)]),
    };
    assert_eq!(*wrong, expected);
    let [Detail::Stage(StageDetail::Factor(factor))] = details[..] else { panic!("{details:#?}") };
    assert!((factor - 2.5).abs() < 1e-9);
}

/// Only the test of overlap uses radii.
#[test]
fn collisions_of_separate_bodies_are_reported() {
    let trace = right(&scene(&BALLS.replace("radius=\"0.3\"", "radius=\"0.36\"")));
    let told = explain(&scene(BALLS), &trace);
    let fault = StageFault::Overlaps { kind: Some(PairKind::ParticleParticle), wrong: WrongDecisions::Superfluous };
    assert!(told.len() == 1 && told[0].topic == ExplanationTopic::Stage(fault), "{told:#?}");
}

/// The changes of states in one scene may follow from the mistake that another scene names.
#[test]
fn a_known_mistake_in_one_scene_stands_for_what_others_show() {
    let scene = scene(FALL);
    let row = find("gravity-sign").expect("a row");
    let named = explain(&scene, &student::record_trace(&scene, Student::new(Some(row.mistake))).expect("a trace"));
    let pulled = original::read(FALL.replace("fx=\"0.1\"", "fx=\"0.7\"").as_bytes()).expect("a scene").scene;
    let seen = explain(&scene, &right(&pulled));
    assert!(seen.len() == 1 && seen[0].names_stage(), "{seen:#?}");
    let heads = explain_together([named.as_slice(), &seen, &seen], &[]);
    assert!(heads.len() == 1 && heads[0].key == row.id, "{heads:#?}");
}

/// A response changes velocities, and with them whether later pairs of the pass approach each other.
#[test]
fn a_contact_after_a_wrong_response_is_no_wrong_detection() {
    let row = r#"<scene><duration time="0.01"/><integrator type="symplectic-euler" dt="0.01"/>
        <collision type="simple" COR="0.5"/>
        <particle m="1" px="-0.5" py="0" vx="1" vy="0" fixed="0" radius="0.3"/>
        <particle m="1" px="0" py="0" vx="0" vy="0" fixed="0" radius="0.3"/>
        <particle m="1" px="0.55" py="0" vx="0.8" vy="0" fixed="0" radius="0.3"/></scene>"#;
    let told = explain(&scene(row), &right(&scene(&row.replace("0.5\"/>", "0.7\"/>"))));
    let is_change = |one: &Explanation| matches!(one.topic, ExplanationTopic::Stage(StageFault::Change(_)));
    assert!(told.len() == 1 && is_change(&told[0]), "{told:#?}");
}

/// In t2m1 students write responses, so a right scene with a collision contradicts an empty response.
#[test]
fn a_right_collision_contradicts_an_empty_response() {
    assert!(mistake_is_visible(&scene(BALLS), "respond-particles-missing"));
}

/// A spring acts on the first two bodies, and gravitation on the last two.
const CHAIN: &str = r#"<scene><duration time="1"/><integrator type="explicit-euler" dt="0.1"/>
    <particle m="2" px="-1" py="0" vx="0.3" vy="0.5" fixed="0" radius="0.1"/>
    <particle m="3" px="1" py="0.4" vx="-0.2" vy="1" fixed="0" radius="0.1"/>
    <particle m="4" px="3" py="0.1" vx="0" vy="0" fixed="0" radius="0.1"/>
    <edge i="0" j="1" radius="0.02"/><springforce edge="0" k="2" l0="1.2" b="0.3"/>
    <gravitationalforce i="1" j="2" G="0.5"/></scene>"#;

/// Only the spring acts on both bodies whose velocities are wrong. The integrator is not the student's.
#[test]
fn the_force_that_acts_on_all_wrong_bodies_is_named() {
    let stretched = right(&scene(&CHAIN.replace("1.2", "1.9")));
    let told = explain(&scene(CHAIN), &stretched);
    let [Explanation { topic: ExplanationTopic::Stage(StageFault::Change(wrong)), .. }] = &told[..] else {
        panic!("{told:#?}")
    };
    assert_eq!(wrong.parts, BTreeSet::from([Part::Force(ForceKind::Spring)]));
}

/// Under an integrator of the student, one scene cannot distinguish it from the forces. Several scenes can.
#[test]
fn several_scenes_distinguish_a_force_from_an_integrator() {
    let symplectic = CHAIN.replace("explicit", "symplectic");
    let told = |text: &str| explain(&scene(text), &right(&scene(&text.replace("1.2", "1.9"))));
    let (one, other) = (told(&symplectic), told(CHAIN));
    let parts = |explanation: &Explanation| match &explanation.topic {
        ExplanationTopic::Stage(StageFault::Change(wrong)) => wrong.parts.len(),
        _ => 0,
    };
    assert_eq!([parts(&one[0]), parts(&other[0])], [2, 1]);
    let together = explain_together([one.as_slice(), &other], &[]);
    assert!(together.len() == 1 && parts(&together[0]) == 1, "{together:#?}");
    let corrected = correct_trace(&one, &together, &[]).explanations;
    assert!(corrected.len() == 1 && parts(&corrected[0]) == 1, "{corrected:#?}");
}

/// All pairs of mistakes are tried on each trace, so an unexplained trace contradicts both of two rivals.
#[test]
fn two_rivals_do_not_protect_each_other() {
    let pull = FALL.replace("<simplegravity", r#"<gravitationalforce i="0" j="1" G="0.5"/><simplegravity"#);
    let scene = scene(&pull);
    let trace = |id| {
        let row = find(id).expect("a row");
        explain(&scene, &student::record_trace(&scene, Student::new(Some(row.mistake))).expect("a trace"))
    };
    let open = explain(&scene, &right(&self::scene(&pull.replace("G=\"0.5\"", "G=\"0.9\""))));
    let rivals = ["gravitation-own-mass", "gravitation-other-mass"].map(trace);
    let wrong = [&rivals[0][..], &rivals[1], &open].map(|list| (&scene, list));
    let refuted = refuted_keys(None, &wrong, &[]);
    assert!(refuted.iter().any(|key| key == "gravitation-own-mass"), "{refuted:?}");
    // Only the force itself explains all three traces, so each trace names the force.
    let together = explain_together([rivals[0].as_slice(), &rivals[1], &open], &refuted);
    assert!(together.len() == 1 && together[0].names_stage(), "{together:#?}");
    let corrected = correct_trace(&rivals[0], &together, &[]).explanations;
    assert!(corrected.len() == 1 && corrected[0].topic == together[0].topic, "{corrected:#?}");
}

/// A right scene can refute all mistakes that reproduce a wrong one. They are in the same force, which is then named.
#[test]
fn the_force_of_refuted_mistakes_is_named() {
    let row = find("gravitation-sign").expect("a row");
    let scene = scene(CHAIN);
    let own = explain(&scene, &student::record_trace(&scene, Student::new(Some(row.mistake))).expect("a trace"));
    let refuted: Vec<String> =
        own.iter().flat_map(|explanation| explanation.same_as.iter().chain([&explanation.key])).cloned().collect();
    let together = explain_together([own.as_slice()], &refuted);
    let [Explanation { topic: ExplanationTopic::Stage(StageFault::Change(wrong)), .. }] = &together[..] else {
        panic!("{together:#?}")
    };
    assert_eq!(wrong.parts, BTreeSet::from([Part::Force(ForceKind::Gravitation)]));
    let corrected = correct_trace(&own, &together, &refuted).explanations;
    assert!(corrected.len() == 1 && corrected[0].topic == together[0].topic, "{corrected:#?}");
}

/// With wrong second derivatives Newton's method does not converge on the second scene. Where such a program ends its
/// loop is not known, so its trace contradicts nothing.
#[test]
fn an_endless_iteration_contradicts_no_mistake() {
    let springs = |integrator: &str, length: &str| {
        scene(&format!(
            r#"<scene><duration time="0.5"/><integrator type="{integrator}" dt="0.5"/>
            <particle m="0.5" px="-0.1" py="0.1" vx="0.6" vy="-0.9" fixed="0" radius="0.1"/>
            <particle m="1.2" px="0.2" py="0.2" vx="-0.4" vy="1.1" fixed="0" radius="0.1"/>
            <edge i="0" j="1" radius="0.02"/>
            <springforce edge="0" k="60" l0="{length}" b="0.3"/>
            <simplegravity fx="0.3" fy="-3"/></scene>"#
        ))
    };
    let row = find("jacobian-spring-diagonal-only").expect("a row");
    let program = Student::new(Some(row.mistake));
    let (linear, newton) = (springs("linearized-implicit-euler", "0.9"), springs("implicit-euler", "0.9"));
    assert!(student::record_trace(&newton, program).is_err());
    let named = explain(&linear, &student::record_trace(&linear, program).expect("a trace"));
    let open = explain(&newton, &right(&springs("implicit-euler", "0.8")));
    assert!(named[0].key == row.id && open[0].names_stage(), "{named:#?} {open:#?}");
    let refuted = refuted_keys(None, &[(&linear, &named[..]), (&newton, &open)], &[]);
    assert!(refuted.is_empty(), "{refuted:?}");
}

/// The velocity of each particle changes by its force divided by the mass of the first one.
#[test]
fn the_mass_of_the_first_particle_divides_all_forces() {
    let row = find("explicit-velocities-mass-of-first").expect("a row");
    let trace = student::record_trace(&scene(FALL), Student::new(Some(row.mistake))).expect("a trace");
    let number = |index: usize| f64::from_le_bytes(trace[8 * index..8 * index + 8].try_into().expect("eight bytes"));
    // The second record begins at number 8, and its last velocity is that of the heavier particle.
    assert!((number(15) - (1.0 - 0.1 * 0.8 * 3.0 / 2.0)).abs() < 1e-12, "{}", number(15));
}
