//! Traces with mistakes, created in memory, and their explanations.
use super::{find_known, mistake_is_visible};
use crate::diagnose::is_named_in;
use crate::diagnose::{ExamplePlace, Explanation, ExplanationTopic, explain, explain_together};
use fosssim_judge::Role;
use fosssim_model::{
    scene::{Scene, original},
    sim::{Pair, PairKind, State},
    trace::{Frame, Layout, Writer},
};
use fosssim_student::{self as student, Student, find};

/// A scene with two balls that meet, an edge that swings about its fixed end, and a half-plane.
const SCENE: &str = "<scene><duration time=\"1\"/><integrator type=\"symplectic-euler\" dt=\"0.05\"/>\
    <collision type=\"continuous-time\" COR=\"0.8\"/><simplegravity fx=\"0\" fy=\"-1\"/>\
    <particle m=\"1\" px=\"-1\" py=\"0.1\" vx=\"2\" vy=\"0\" fixed=\"0\" radius=\"0.3\"/>\
    <particle m=\"2\" px=\"1\" py=\"0\" vx=\"-1.5\" vy=\"0.25\" fixed=\"0\" radius=\"0.25\"/>\
    <particle m=\"1\" px=\"-3\" py=\"-1.2\" vx=\"0\" vy=\"0\" fixed=\"1\" radius=\"0.1\"/>\
    <particle m=\"4\" px=\"3\" py=\"-1\" vx=\"0.25\" vy=\"1\" fixed=\"0\" radius=\"0.1\"/>\
    <edge i=\"2\" j=\"3\" radius=\"0.15\"/>\
    <halfplane px=\"0\" py=\"-5\" nx=\"0\" ny=\"1\"/></scene>";

fn scene() -> Scene {
    original::read(SCENE.as_bytes()).expect("a scene").scene
}

fn first(id: &str) -> Option<(String, Vec<String>)> {
    let row = find(id).expect("a row");
    let trace = student::record_trace(&scene(), Student::new(Some(row.mistake))).unwrap_or_else(|(bytes, _)| bytes);
    find_known(&scene(), &trace[..]).into_iter().next().map(|first| (first.key, first.same_as))
}

#[test]
fn a_right_trace_needs_no_explanation() {
    let trace = student::record_trace(&scene(), Student::default()).expect("a trace");
    assert_eq!(find_known(&scene(), &trace[..]), []);
}

#[test]
fn mistakes_of_all_stages_are_named() {
    for id in [
        "pp-no-two",
        "pe-square-no-eh",
        "ph-no-radius",
        "handover-negated",
        "pp-contact-reversed",
        "decision-never",
        "response-sign",
        "ct-two-passes",
        "log-lowest-first",
        "log-polynomials-kept",
        "log-impulses-kept",
        "log-single-precision",
        "log-no-mid",
        "log-no-initial",
    ] {
        let Some((key, same_as)) = first(id) else { panic!("{id} is not explained") };
        assert!(key == id || same_as.iter().any(|other| other == id), "{id} is explained as {key} or {same_as:?}");
    }
}

#[test]
fn correct_variants_are_never_reported() {
    for row in student::CATALOG.iter().filter(|row| row.kind == student::RowKind::Variant) {
        assert_eq!(first(row.id), None, "{}", row.id);
    }
}

/// If a program crashes, is killed or reaches its time limit, and its trace is right up to that point, the trace counts
/// as right.
#[test]
fn a_right_trace_that_breaks_off_is_not_explained() {
    let trace = student::record_trace(&scene(), Student::default()).expect("a trace");
    for length in (0..trace.len()).step_by(97) {
        assert_eq!(explain(&scene(), &trace[..length]), [], "cut at {length}");
    }
}

#[test]
fn another_scenes_trace_is_asked_about_only() {
    let mut other = scene();
    other.particles[1].position.y = 0.125;
    let right = student::record_trace(&other, Student::default()).expect("a trace");
    let longer = [right.as_slice(), &[0; 64]].concat();
    for (trace, has_length) in [(right, true), (longer, false)] {
        let explanations = explain(&scene(), &trace);
        let [explanation] = &explanations[..] else { panic!("one question, not {explanations:?}") };
        assert!(
            explanation.is_other_scene() && explanation.topic == (ExplanationTopic::Scene { has_length }),
            "{explanation:?}"
        );
    }
}

/// The right approach polynomial is accepted, and the mistake after it is still found.
#[test]
fn a_right_approach_hides_no_mistake() {
    for id in ["decision-never", "pe-square-no-eh", "response-sign", "pp-no-two"] {
        let student = Student::new(find(id).map(|row| row.mistake)).with_right_approach();
        let trace = student::record_trace(&scene(), student).expect("a trace");
        let explanations = find_known(&scene(), &trace[..]);
        let [explanation] = &explanations[..] else { panic!("{id} is not explained") };
        assert!(explanation.key == id || explanation.same_as.iter().any(|other| other == id), "{id}: {explanation:?}");
        let example = explanation.example.as_ref().expect("an example");
        let is_approach = matches!(example.place, ExamplePlace::Polynomial { role: Role::Approach, .. });
        assert!(!is_approach, "the approach is right: {example:?}");
    }
    let trace = student::record_trace(&scene(), Student::default().with_right_approach()).expect("a trace");
    assert_eq!(find_known(&scene(), &trace[..]), []);
}

#[test]
fn an_example_names_the_first_wrong_step() {
    let row = find("pp-no-two").expect("a row");
    let trace = student::record_trace(&scene(), Student::new(Some(row.mistake))).expect("a trace");
    let explanations = find_known(&scene(), &trace[..]);
    let [explanation] = &explanations[..] else { panic!("one explanation") };
    assert_eq!((&*explanation.key, &explanation.topic), (row.id, &ExplanationTopic::Mistake));
    assert_eq!(explanation.reproduced, explanation.samples);
    let example = explanation.example.as_ref().expect("an example");
    let pair = Pair { kind: PairKind::ParticleParticle, first: 0, second: 1 };
    assert_eq!((example.step, example.place), (1, ExamplePlace::Polynomial { pair, pass: 0, role: Role::Overlap }));
    assert_eq!(example.expected.len(), 3);
    assert!((example.expected[1] - 2.0 * example.actual[1]).abs() < 1e-9, "{example:?}");
}

#[test]
fn damaged_traces_are_read_as_far_as_they_go() {
    let row = find("pp-no-two").expect("a row");
    let trace = student::record_trace(&scene(), Student::new(Some(row.mistake))).expect("a trace");
    for length in [0, 1, 127, 200, trace.len() / 2, trace.len() - 1] {
        let keys: Vec<String> = find_known(&scene(), &trace[..length]).into_iter().map(|first| first.key).collect();
        assert!(keys.iter().all(|key| key == "pp-no-two"), "cut at {length}: {keys:?}");
        assert!(length < 1000 || keys.len() == 1, "cut at {length}");
    }
    // The trace contains nonsense at every position. An explanation is not required, but the search must end.
    for place in (0..trace.len()).step_by(trace.len() / 23) {
        let mut damaged = trace.clone();
        damaged[place] ^= 0xff;
        let _explanations = find_known(&scene(), &damaged[..]);
    }
}

/// Returns the scene with impulse rounds, impact zones and several discs at once.
fn hybrid() -> Scene {
    let text =
        SCENE.replace("type=\"continuous-time\" COR=\"0.8\"", "type=\"hybrid\" COR=\"0.8\" maxiters=\"1\"").replace(
            "<edge",
            "<particle m=\"1.5\" px=\"1.55\" py=\"0.05\" vx=\"-1.5\" vy=\"0\" fixed=\"0\" radius=\"0.25\"/><edge",
        );
    original::read(text.as_bytes()).expect("a scene").scene
}

fn made(scene: &Scene, ids: &[&str]) -> Vec<u8> {
    let student =
        ids.iter().fold(Student::default(), |student, id| student.with_mistake(find(id).map(|row| row.mistake)));
    student::record_trace(scene, student).unwrap_or_else(|(bytes, _)| bytes)
}

/// Checks that if a program makes all of these mistakes, explanations name each of them, or list it as
/// indistinguishable.
fn are_named(scene: &Scene, ids: &[&str]) {
    let found = explain(scene, &made(scene, ids));
    assert_eq!(found.len(), ids.len(), "{ids:?}: {found:#?}");
    for id in ids {
        let named = found.iter().any(|one| one.key == *id || one.same_as.iter().any(|other| other == id));
        assert!(named, "{id} of {ids:?}: {found:#?}");
    }
    assert!(found.iter().all(Explanation::is_complete), "{ids:?}: {found:#?}");
}

#[test]
fn unwritten_code_is_reported_by_stage() {
    are_named(&scene(), &["pp-empty", "pe-empty", "ph-empty"]);
    are_named(&scene(), &["pe-empty", "ph-empty"]);
    are_named(&scene(), &["pp-empty", "pe-empty"]);
}

#[test]
fn half_done_work_with_a_mistake_has_both() {
    are_named(&scene(), &["pe-empty", "pp-no-two"]);
    are_named(&scene(), &["ph-empty", "response-sign"]);
}

/// A program with an empty detection and any other mistake does not crash.
#[test]
fn an_empty_detection_goes_with_every_other_mistake() {
    for row in student::CATALOG {
        for empty in ["pp-empty", "pe-empty", "ph-empty"] {
            let _trace = made(&scene(), &[empty, row.id]);
        }
    }
}

#[test]
fn several_mistakes_are_named_together() {
    for ids in [
        &["pp-no-two", "response-sign"][..],
        &["pe-square-no-eh", "pp-radii-squared-apart"],
        &["pe-alpha-low-negated", "response-halved"],
        &["pp-one-radius", "pe-no-cubic", "response-no-restitution"],
    ] {
        are_named(&scene(), ids);
    }
    are_named(&hybrid(), &["pp-linear-sign", "geometric-empty"]);
}

#[test]
fn a_right_scene_speaks_against_what_it_would_show() {
    assert!(mistake_is_visible(&scene(), "pp-no-two") && mistake_is_visible(&scene(), "pe-square-no-eh"));
    assert!(!mistake_is_visible(&scene(), "geometric-empty") && !mistake_is_visible(&scene(), "no-such-mistake"));
    let explanations = explain(&scene(), &made(&scene(), &["pp-no-two"]));
    assert_eq!(explain_together([explanations.as_slice()], &[])[0].key, "pp-no-two");
    assert!(
        explain_together([explanations.as_slice()], &["pp-no-two".to_owned()]).iter().all(|one| one.key != "pp-no-two")
    );
}

#[test]
fn mistakes_of_several_scenes_are_settled_together() {
    // The scenes belong to one program, and each shows another missing part.
    let said = |ids: &[&str]| {
        let mut explanations = explain(&scene(), &made(&scene(), ids));
        explanations.iter_mut().for_each(|explanation| explanation.contradicted_keys.clear());
        explanations
    };
    let (alone, other) = (said(&["pp-empty"]), said(&["pe-empty", "ph-empty"]));
    let found = explain_together([alone.as_slice(), other.as_slice()], &[]);
    assert_eq!((found.len(), found[0].key.as_str()), (1, Explanation::UNFINISHED), "{found:#?}");
    assert_eq!(
        (&found[0].topic, &found[0].same_as[..]),
        (&ExplanationTopic::Unfinished, &["pp-empty", "pe-empty", "ph-empty"].map(str::to_owned)[..])
    );
    assert!(is_named_in(&found[0], &alone) && is_named_in(&found[0], &other));
    let (one, two) =
        (explain(&scene(), &made(&scene(), &["pp-no-two"])), explain(&scene(), &made(&scene(), &["response-sign"])));
    let found: Vec<String> = explain_together([one.as_slice(), one.as_slice(), two.as_slice()], &[])
        .into_iter()
        .map(|found| found.key)
        .collect();
    assert_eq!(found, ["pp-no-two", "response-sign"]);
}

/// The reference's rounds of impulses never end from these states, so these steps have no result.
#[test]
fn a_trace_that_leads_nowhere_is_left() {
    let text = r#"<scene><duration time="1"/><integrator type="explicit-euler" dt="0.1"/>
        <collision type="hybrid" COR="1" maxiters="2000000000" k="0" thickness="0.01"/>
        <particle m="1" px="0" py="100" vx="1" vy="0" fixed="0" radius="0.2"/>
        <particle m="1" px="-0.25" py="0" vx="0" vy="0" fixed="1" radius="0.2"/>
        <particle m="1" px="0.25" py="0" vx="0" vy="0" fixed="1" radius="0.2"/></scene>"#;
    let scene = original::read(text.as_bytes()).expect("a scene").scene;
    let layout = Layout::for_scene(&scene);
    let state =
        |y| State { positions: vec![0.0, y, -0.25, 0.0, 0.25, 0.0], velocities: vec![1.0, 0.0, 0.0, 0.0, 0.0, 0.0] };
    let mut writer = Writer::new(Vec::new(), layout);
    writer.write_frame(&Frame { state: state(100.0), ..Frame::default() });
    for _ in 1..layout.records() {
        writer.write_frame(&Frame { state: state(0.0), ..Frame::default() });
    }
    let trace = writer.finish().expect("written").0;
    assert!(explain(&scene, &trace).iter().all(|one| one.samples <= 2), "only the first step has a result");
}

mod states;
