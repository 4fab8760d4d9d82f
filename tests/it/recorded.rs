//! Judging against a recording instead of the simulator.
use crate::workspace::{embedded, simulate};
use fosssim_oracle::{
    judge::{Book, Finding, FindingDetail, FindingKind, Overall, Stop, recording, replay},
    scene::Collision,
    suite::library,
    trace::Layout,
};

#[test]
fn the_recording_itself_passes_for_every_embedded_scene() {
    for name in library::scene_names() {
        let scene = embedded(name);
        let recording = zstd::decode_all(library::recording(name).expect("a recording")).expect("zstd");
        let outcome = recording::judge(&scene, &simulate(&scene)[..], &recording[..], &mut ()).expect("a recording");
        assert_eq!(outcome.parity.overall, Overall::Passed, "{name}: {:?}", outcome.parity.findings.first_divergence);
        assert_eq!(outcome.steps_judged, scene.step_count());
    }
}

#[test]
fn wrong_responses_that_lock_step_lets_pass_are_found_at_their_step() {
    let name = "ContinuousTimeTests/head-on-equal-masses";
    let scene = embedded(name);
    let mut bouncy = scene.clone();
    bouncy.collision = Collision::ContinuousTime { restitution: 0.25 };
    let (right, wrong) = (simulate(&scene), simulate(&bouncy));
    let lock_step = replay::judge(&scene, &wrong[..], &replay::Options::default(), &mut ());
    assert_eq!(lock_step.parity.overall, Overall::Passed, "the original never looks at responses here");
    let outcome = recording::judge(&scene, &wrong[..], &right[..], &mut ()).expect("a recording");
    assert_eq!(outcome.parity.overall, Overall::Failed);
    let first = outcome.parity.findings.first_divergence.expect("a divergence");
    assert!(matches!(first.detail, FindingDetail::Position { .. } | FindingDetail::Velocity { .. }), "{first}");
    let layout = Layout::for_scene(&scene);
    let same = right.iter().zip(&wrong).take_while(|(one, other)| one == other).count();
    // Up to the first difference, all frames have the same size and logs as the reference's. The reported step must not
    // be before the first differing byte's share of the trace, and at most one step after it.
    let share = same as f64 / right.len() as f64 * f64::from(layout.steps);
    assert!((f64::from(first.step) - share).abs() <= 2.0, "step {} at byte {same} of {}", first.step, right.len());
}

#[test]
fn another_start_is_a_difference_of_step_0() {
    let scene = embedded("ContinuousTimeTests/head-on-equal-masses");
    let right = simulate(&scene);
    let mut wrong = right.clone();
    wrong[..8].copy_from_slice(&77.0_f64.to_le_bytes());
    let outcome = recording::judge(&scene, &wrong[..], &right[..], &mut ()).expect("a recording");
    assert_eq!(outcome.parity.findings.first_divergence.expect("a divergence").step, 0);
    assert_eq!((outcome.parity.findings.wrong_steps, outcome.right_steps(Book::Parity)), (0, scene.step_count() - 1));
}

#[test]
fn the_first_record_is_no_step() {
    let scene = embedded("ContinuousTimeTests/head-on-equal-masses");
    let right = simulate(&scene);
    let mut other = scene.clone();
    other.particles.iter_mut().for_each(|particle| particle.velocity.x += 0.125);
    let outcome = recording::judge(&scene, &simulate(&other)[..], &right[..], &mut ()).expect("a recording");
    assert_eq!(
        (outcome.parity.findings.wrong_steps, outcome.right_steps(Book::Parity)),
        (u64::from(scene.step_count()), 0)
    );
}

#[test]
fn cut_traces_have_no_verdict_and_cut_recordings_are_a_fault() {
    let scene = embedded("ContinuousTimeTests/head-on-equal-masses");
    let right = simulate(&scene);
    let half = &right[..right.len() / 2];
    let outcome = recording::judge(&scene, half, &right[..], &mut ()).expect("a recording");
    assert_eq!(outcome.parity.overall, Overall::None);
    assert!(matches!(outcome.stop, Some(Stop::Trace { .. })));
    // The findings before the end are in the order of their kinds, as in any other outcome.
    let mut faster = scene.clone();
    faster.particles.iter_mut().for_each(|particle| particle.velocity *= 1.25);
    let wrong = simulate(&faster);
    let outcome = recording::judge(&scene, &wrong[..wrong.len() - 1], &right[..], &mut ()).expect("a recording");
    let kinds: Vec<FindingKind> = outcome.parity.findings.examples.iter().map(Finding::kind).collect();
    assert!(kinds.contains(&FindingKind::SuperfluousCollision) && kinds.is_sorted(), "{kinds:?}");
    let error = recording::judge(&scene, &right[..], half, &mut ()).expect_err("half a recording").to_string();
    assert!(error.starts_with("the recording is damaged: frame ") && error.ends_with("record it again"), "{error}");
}
