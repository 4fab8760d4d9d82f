//! The first value that is not finite is reported with its step and stage, and such values prove no other mistake.
use crate::diagnose::{
    Explanation, ExplanationTopic, NanStage, NonFiniteValue, explain, non_finite::explain_source, sampling::Source,
};
use fosssim_model::{
    assignments::Assignment,
    scene::{Collision, Scene},
    trace::{Frame, Layout, LenientFrame, LenientReader, Writer},
};
use fosssim_student::{self as student, Student, assignments::probe_scenes};

fn scene(name: &str) -> Scene {
    probe_scenes(Assignment::T2M2).into_iter().find(|(other, _)| other == name).expect("a probe scene").1
}

fn frames(scene: &Scene) -> Vec<LenientFrame> {
    let trace = student::record_trace(scene, Student::default()).expect("it comes to an end");
    let layout = Layout::for_scene(scene);
    let mut reader = LenientReader::new(&trace[..], layout);
    let read = |_| {
        let mut frame = LenientFrame::default();
        reader.next(&mut frame).expect("a record");
        frame
    };
    (0..layout.records()).map(read).collect()
}

fn written(scene: &Scene, frames: Vec<LenientFrame>) -> Vec<u8> {
    let mut writer = Writer::new(Vec::new(), Layout::for_scene(scene));
    for LenientFrame { state, impulses, polynomials, .. } in frames {
        writer.write_frame(&Frame { state, impulses, polynomials });
    }
    writer.finish().expect("written").0
}

/// Returns the index of the first record from `start` on for which `holds` returns true.
fn first(frames: &[LenientFrame], start: usize, holds: impl Fn(&LenientFrame) -> bool) -> usize {
    start + frames[start..].iter().step_by(2).position(holds).expect("such a record")
}

fn told(scene: &Scene, frames: Vec<LenientFrame>) -> NonFiniteValue {
    let trace = written(scene, frames);
    let all = explain(scene, &trace);
    // There is no other explanation: the steps before are right, and steps with NaN prove nothing.
    let [Explanation { topic: ExplanationTopic::NotFinite(found), .. }] = &all[..] else { panic!("{all:#?}") };
    assert_eq!(explain_source(scene, Source::from_trace(&trace))[0].topic, all[0].topic);
    *found
}

/// Makes values of these bodies NaN in all records of `frames`, as a program would.
fn spoil(frames: &mut [LenientFrame], bodies: &[usize]) {
    for frame in frames {
        for &body in bodies {
            frame.state.positions[2 * body] = f64::NAN;
            frame.state.velocities[2 * body + 1] = f64::NAN;
        }
    }
}

#[test]
fn nan_is_reported_with_its_step_and_stage() {
    let struck = scene("edges-struck");
    assert!(matches!(struck.collision, Collision::ContinuousTime { .. }));
    let right = frames(&struck);
    let end = first(&right, 2, |frame| !frame.impulses.is_empty());
    let step = Some(u32::try_from(end / 2).expect("few"));
    let with = |change: &dyn Fn(&mut LenientFrame)| {
        let mut changed = right.clone();
        changed[end - 1..=end].iter_mut().for_each(change);
        spoil(&mut changed[end + 1..], &[0]);
        told(&struck, changed)
    };
    let of_vector = with(&|frame| frame.impulses[0].normal.x = f64::INFINITY);
    assert_eq!(of_vector, NonFiniteValue { step, stage: NanStage::ContactVectors, is_nan: false, recovers: false });
    let of_response = with(&|frame| frame.state.velocities[0] = f64::NAN);
    assert_eq!(of_response, NonFiniteValue { step, stage: NanStage::Responses, is_nan: true, recovers: false });
    let of_detection = with(&|frame| frame.polynomials.coefficients[0] = f64::NAN);
    assert!(matches!(of_detection.stage, NanStage::Detection(Some(_))), "{of_detection:?}");
    let mut changed = right;
    changed[0].state.positions[0] = f64::NAN;
    assert_eq!(told(&struck, changed).stage, NanStage::FirstRecord);
}

#[test]
fn nan_of_the_failsafe_is_no_sum_of_integers() {
    let mut seen = 0;
    for (name, scene) in probe_scenes(Assignment::T2M2) {
        if !matches!(scene.collision, Collision::Hybrid { .. }) {
            continue;
        }
        let right = frames(&scene);
        // This is the first step whose geometric part moves a body: its end state differs from its mid state.
        let Some(end) = (2..right.len()).step_by(2).find(|&end| right[end].state != right[end - 1].state) else {
            continue;
        };
        seen += 1;
        let all: Vec<usize> = (0..scene.particles.len()).collect();
        let step = Some(u32::try_from(end / 2).expect("few"));
        let mut of_zones = right.clone();
        spoil(&mut of_zones[end..], &all);
        assert_eq!(
            told(&scene, of_zones),
            NonFiniteValue { step, stage: NanStage::Zones, is_nan: true, recovers: false },
            "{name}"
        );
        let mut of_rounds = right;
        spoil(&mut of_rounds[end - 1..], &all);
        assert_eq!(
            told(&scene, of_rounds),
            NonFiniteValue { step, stage: NanStage::ImpulseRounds, is_nan: true, recovers: false },
            "{name}"
        );
    }
    assert!(seen > 2, "{seen}");
}

/// If only one record contains such a value, no step computed it, or the next step did not use it.
#[test]
fn numbers_that_become_finite_again_are_reported() {
    let struck = Scene { duration: 3.0, ..scene("edges-struck") };
    let mut changed = frames(&struck);
    changed[2].state.positions[0] = f64::NAN;
    let found = told(&struck, changed);
    assert!(found.recovers, "{found:?}");
}
