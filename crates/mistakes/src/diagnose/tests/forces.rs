//! Weights of the forces' terms are told where they fit, and nowhere else.
use crate::{
    diagnose::{About, Detail, Explanation, ForceTerm, WrongWeight, explain},
    student::{self, Student, find},
};
use fosssim_model::scene::{Scene, original};

/// All forces but gravitation, one body fixed.
const FORCES: &str = r#"<scene><duration time="1"/><integrator type="symplectic-euler" dt="0.02"/>
    <particle m="1" px="-1" py="0" vx="0" vy="0.5" fixed="0" radius="0.1"/>
    <particle m="2" px="0.2" py="0.3" vx="0.3" vy="0" fixed="0" radius="0.1"/>
    <particle m="3" px="1.4" py="-0.2" vx="0" vy="-0.6" fixed="0" radius="0.1"/>
    <particle m="1.5" px="0" py="1.8" vx="-0.2" vy="0.1" fixed="1" radius="0.1"/>
    <edge i="0" j="1" radius="0.02"/><edge i="1" j="2" radius="0.02"/>
    <vortexforce i="0" j="2" kbs="1.5" kvc="0.7"/><dragdamping b="0.2"/><constantforce fx="0.2" fy="0.1"/>
    <simplegravity fx="0.1" fy="-0.8"/>
    <springforce edge="1" k="15" l0="1.2" b="0.4"/><springforce edge="0" k="20" l0="1.1" b="0.2"/></scene>"#;

fn scene(text: &str) -> Scene {
    original::read(text.as_bytes()).expect("a scene").scene
}

/// The explanations of a right program that ran on a scene with these attributes changed.
fn told(changes: &[(&str, &str)]) -> Vec<Explanation> {
    let changed = changes.iter().fold(FORCES.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    });
    explain(&scene(FORCES), &student::trace(&scene(&changed), Student::default()).expect("a trace"))
}

fn terms(told: &[Explanation]) -> &[(ForceTerm, WrongWeight)] {
    match told {
        [Explanation { about: About::Forces(terms), .. }] => terms,
        _ => panic!("{told:#?}"),
    }
}

#[test]
fn wrong_weights_are_told_with_their_factors() {
    let one = told(&[("dragdamping b=\"0.2\"", "dragdamping b=\"0.07\"")]);
    assert_eq!(terms(&one), [(ForceTerm::Drag, WrongWeight::Other)]);
    let is_near = |weight: f64| (weight - 0.35).abs() < 1e-9;
    let is_factor =
        |detail: &Detail| matches!(detail, Detail::Force { term: ForceTerm::Drag, weight } if is_near(*weight));
    assert!(one[0].is_complete() && one[0].details.iter().any(is_factor), "{one:#?}");
    // More mistakes than are tried together.
    let three = told(&[
        ("dragdamping b=\"0.2\"", "dragdamping b=\"-0.2\""),
        ("fx=\"0.1\" fy=\"-0.8\"", "fx=\"0.2\" fy=\"-1.6\""),
        ("constantforce fx=\"0.2\" fy=\"0.1\"", "constantforce fx=\"0\" fy=\"0\""),
    ]);
    let expected = [
        (ForceTerm::Gravity, WrongWeight::Two),
        (ForceTerm::Constant, WrongWeight::Zero),
        (ForceTerm::Drag, WrongWeight::MinusOne),
    ];
    assert_eq!(terms(&three), expected);
}

/// A mistake that is no weight, and weights that are not the same for all springs: nothing is said of terms.
#[test]
fn what_no_weights_explain_is_not_told_so() {
    let uneven = told(&[("k=\"15\"", "k=\"16\""), ("kbs=\"1.5\"", "kbs=\"1.7\"")]);
    assert!(uneven.iter().all(|one| !matches!(one.about, About::Forces(_))), "{uneven:#?}");
    let row = find("spring-direction").expect("a row");
    // Without the forces of the library, which later milestones' scenes have only.
    let lines = |line: &&str| !line.contains("vortexforce");
    let own = scene(&FORCES.lines().filter(lines).collect::<Vec<_>>().join("\n"));
    let named = explain(&own, &student::trace(&own, Student::new(Some(row.mistake))).expect("a trace"));
    assert!(named.len() == 1 && named[0].key == row.id, "{named:#?}");
}

/// With equal masses nobody can tell gravity from a constant force.
#[test]
fn terms_that_are_alike_are_not_told_apart() {
    let equal = FORCES
        .replace("m=\"2\"", "m=\"1\"")
        .replace("m=\"3\"", "m=\"1\"")
        .replace("simplegravity fx=\"0.1\" fy=\"-0.8\"", "simplegravity fx=\"0.4\" fy=\"0.2\"");
    let wrong = equal.replace("constantforce fx=\"0.2\" fy=\"0.1\"", "constantforce fx=\"0.5\" fy=\"0.25\"");
    let trace = student::trace(&scene(&wrong), Student::default()).expect("a trace");
    assert_eq!(explain(&scene(&equal), &trace), []);
}
