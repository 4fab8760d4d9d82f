//! Explains programs with several mistakes on the probe scenes.
use super::naming::has_same_meaning;
use super::sampling::{Source, TraceSamples, sample_trace};
use super::{
    Explanation, ExplanationTopic, explain, explain_kept_trace, explain_together, mistake_is_visible, probe_scenes,
    refuted_keys, stages,
};
use fosssim_judge::kept_trace::KeptTrace;
use fosssim_model::assignments::Assignment;
use fosssim_student::{self as student, Row, Student};

mod heads;
mod non_finite;
mod probes;
mod states;

/// A mistake in all polynomials, which is also found in the steps without other mistakes, is one mistake, not two.
#[test]
fn a_mistake_next_to_another_is_reported_once() {
    let rows = ["pe-radii-squared-apart", "failsafe-empty"].map(|id| student::find(id).expect("it is known"));
    let author = rows.iter().fold(Student::default(), |student, row| student.with_mistake(Some(row.mistake)));
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/t2m2/HolisticTests");
    let explained = ["funnel-of-fractional-masses", "rope-bridge", "pendulum-into-a-wall-of-balls"].map(|name| {
        #[expect(clippy::disallowed_methods, reason = "a test reads the scenes that come with the program")]
        let xml = std::fs::read(folder.join(name).with_extension("xml")).expect("a bundled scene");
        let scene = fosssim_model::scene::original::read(&xml).expect("a scene").scene;
        explain(&scene, &student::record_trace(&scene, author).unwrap_or_else(|(bytes, _)| bytes))
    });
    for list in &explained {
        let twice = |one: &&Explanation| rows.iter().any(|row| has_same_meaning(one, row));
        let named = list.iter().filter(|one| one.key == rows[0].id).chain(list.iter().filter(twice)).count();
        assert!(named <= 1, "{list:#?}");
    }
    let told = explain_together(explained.iter().map(Vec::as_slice), &[]);
    let mut keys: Vec<&str> = told.iter().map(|explanation| explanation.key.as_str()).collect();
    keys.sort_unstable();
    assert_eq!(keys, ["failsafe-empty", "pe-radii-squared-apart"], "{told:#?}");
}

/// With another integrator, the polynomials are right for the positions that it predicts.
#[test]
fn polynomials_of_other_predicted_positions_are_no_mistake() {
    let row = student::find("linear-missing").expect("it is known");
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/t2m2/ImpulsesTests");
    #[expect(clippy::disallowed_methods, reason = "a test reads the scenes that come with the program")]
    let xml = std::fs::read(folder.join("fixed-ball-drifts-into-a-fixed-one.xml")).expect("a bundled scene");
    let scene = fosssim_model::scene::original::read(&xml).expect("a scene").scene;
    let trace = student::record_trace(&scene, Student::new(Some(row.mistake))).expect("a whole trace");
    let explained = explain(&scene, &trace);
    let is_of_polynomials = |one: &Explanation| matches!(one.topic, ExplanationTopic::Polynomials { .. });
    assert!(!explained.iter().any(is_of_polynomials), "{explained:#?}");
}

/// One of many traces suggests that a stage is empty, in addition to a mistake that all of them show.
#[test]
fn one_of_many_traces_makes_no_stage_empty() {
    let said = |ids: &[&str]| {
        let of = |id: &&str| student::find(id).expect("it is known");
        let told = |row: &'static Row| Explanation {
            key: row.id.to_owned(),
            topic: ExplanationTopic::Mistake,
            details: Vec::new(),
            reproduced: 3,
            samples: 3,
            example: None,
            same_as: Vec::new(),
            contradicted_keys: Vec::new(),
            claims: Vec::new(),
        };
        ids.iter().map(of).map(told).collect::<Vec<_>>()
    };
    let keys = |traces: &[Vec<Explanation>]| {
        explain_together(traces.iter().map(Vec::as_slice), &[]).into_iter().map(|one| one.key).collect::<Vec<_>>()
    };
    let mut traces = vec![said(&["pp-linear-sign"]); 10];
    traces[3] = said(&["pp-linear-sign", "failsafe-empty"]);
    assert_eq!(keys(&traces)[0], "pp-linear-sign");
    traces[5] = traces[3].clone();
    assert_eq!(keys(&traces)[0], "failsafe-empty");
}

/// In one scene the program moves a zone, in another one nothing: the failsafe is not empty.
#[test]
fn a_stage_of_which_a_trace_shows_something_is_not_empty() {
    let scenes = probe_scenes(Assignment::T2M2);
    let row = |id| student::find(id).expect("it is known");
    let said = |program: &[&Row], probe: &str| {
        let author = program.iter().fold(Student::default(), |student, row| student.with_mistake(Some(row.mistake)));
        let (_, scene) = scenes.iter().find(|(name, _)| name == probe).expect("a probe scene");
        explain(scene, &student::record_trace(scene, author).unwrap_or_else(|(bytes, _)| bytes))
    };
    let empty = said(&[row("failsafe-empty")], "zones-turn-little-and-far");
    assert!(
        empty[0].key == "failsafe-empty" && empty[0].contradicted_keys.contains(&"geometric-empty".to_owned()),
        "{empty:#?}"
    );
    let partly = said(&[row("geometric-first-zone-only")], "zones-of-all-kinds");
    assert!(partly[0].contradicted_keys.contains(&"failsafe-empty".to_owned()), "{partly:#?}");
    let told = explain_together([empty.as_slice(), partly.as_slice()], &[]);
    assert!(told.iter().all(|one| !one.is_unfinished() && one.key != "failsafe-empty"), "{told:#?}");
    // A scene that is right shows it, too, although the failsafe is likely in a single wrong trace only.
    let scene = |probe: &str| &scenes.iter().find(|(name, _)| name == probe).expect("a probe scene").1;
    let (zones, meet) = (scene("zones-turn-little-and-far"), said(&[row("pp-linear-sign")], "particles-meet"));
    let lists = || std::iter::repeat_n(&meet, 12).chain([&empty]).map(Vec::as_slice);
    assert!(explain_together(lists(), &[]).iter().all(|one| one.key != "failsafe-empty"));
    let wrong: Vec<_> = lists().map(|list| (scene("particles-meet"), list)).collect();
    assert!(refuted_keys(None, &wrong, &[zones]).contains(&"failsafe-empty".to_owned()));
}

/// If a trace is too long to be stored, its beginning is explained, and the report does not call it too short.
#[test]
fn a_trace_that_was_kept_in_part_is_explained() {
    let row = student::find("pe-radius-not-squared").expect("it is known");
    let (_, scene) =
        probe_scenes(Assignment::T2M2).into_iter().find(|(name, _)| name == "edges-struck").expect("a probe scene");
    let trace = student::record_trace(&scene, Student::new(Some(row.mistake))).expect("it comes to an end");
    let explained = |most: usize| {
        let mut kept = KeptTrace::new(most);
        std::io::copy(&mut kept.keep_from(&trace[..]), &mut std::io::sink()).expect("read");
        explain_kept_trace(&scene, &kept).into_iter().map(|explanation| explanation.key).collect::<Vec<_>>()
    };
    assert_eq!(explained(trace.len()), [row.id]);
    assert_eq!(explained(trace.len() * 3 / 4), [row.id]);
    assert!(explained(0).is_empty());
}

/// The polynomials of a log without some pairs are those of other pairs, not wrong ones.
#[test]
fn pairs_that_are_not_tested_are_reported() {
    let row = student::find("pairs-fixed-skipped").expect("it is known");
    let scenes = probe_scenes(Assignment::T2M2);
    let found = scenes.iter().filter(|(_, scene)| mistake_is_visible(scene, row.id)).any(|(_, scene)| {
        let trace = student::record_trace(scene, Student::new(Some(row.mistake))).expect("a trace");
        let TraceSamples { mut reference, scan, .. } = sample_trace(scene, Source::from_trace(&trace));
        let fault = stages::explain(&mut reference, scene, scan.wrong_steps.iter());
        fault.is_some_and(|fault| fault.key == "stage-pairs-skipped")
    });
    assert!(found, "a scene shows that pairs are not tested");
}
