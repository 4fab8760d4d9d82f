use super::*;
use fosssim_judge::{Book, Outcome, replay};
use fosssim_model::{
    scene::{Scene, original},
    sim::{Pair, PairKind, State},
    trace::{Layout, PolynomialLog},
};
use fosssim_student::{self as student, Student};

#[expect(clippy::disallowed_methods, reason = "the scenes that come with the program")]
fn asset(name: &str) -> Scene {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/t2m2").join(name);
    original::read(&std::fs::read(path).expect("a scene")).expect("a scene").scene
}

fn judged(scene: &Scene, trace: &[u8]) -> (Outcome, Evidence) {
    let options = replay::Options { uses_fair_rules: true, ..Default::default() };
    let mut rulings = StepRulings::default();
    let outcome = replay::judge(scene, trace, &options, &mut rulings);
    let focus: Vec<Focus> = outcome.findings_by(Book::Fair).examples.iter().map(Focus::from).collect();
    let evidence = gather(scene, &mut &trace[..], &rulings.into_steps(&outcome), true, &focus, MAX_NUMBERS);
    (outcome, evidence)
}

fn of_mistake(scene: &Scene, id: &str) -> Vec<u8> {
    let mistake = student::find(id).expect("a mistake").mistake;
    student::record_trace(scene, Student::new(Some(mistake))).unwrap_or_else(|(trace, _)| trace)
}

#[test]
fn a_right_trace_moves_as_the_reference_to_the_last_bit() {
    let scene = asset("HolisticTests/balls-in-a-box.xml");
    let trace = student::record_trace(&scene, Student::new(None)).expect("a trace");
    let (_, evidence) = judged(&scene, &trace);
    let bits = |track: &Track| track.values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&evidence.reference), bits(&evidence.submission));
    assert_eq!(evidence.reference.records as u64, Layout::for_scene(&scene).records());
    assert!(evidence.steps.iter().all(|step| step.class == StepClass::Right && step.position == 0.0), "{evidence:?}");
    assert!(evidence.steps.iter().all(|step| step.actual_passes == Some(step.expected_passes)));
    assert!(evidence.inspected.is_empty());
}

/// A wrong failsafe is reported where it happens; its consequences are not reported as separate errors.
#[test]
fn own_errors_are_distinguished_from_inherited_ones() {
    let scene = asset("GeometricTests/pair-becomes-rigid.xml");
    let (outcome, evidence) = judged(&scene, &of_mistake(&scene, "failsafe-angular-overwritten"));
    let fair = outcome.fair.expect("asked");
    let strip: String = evidence.steps.iter().map(|step| step.class.letter()).collect();
    assert_eq!(strip.matches('w').count() as u64, fair.findings.wrong_steps, "{strip}");
    let first = fair.findings.first_divergence.expect("wrong").step;
    assert_eq!(strip.find('w'), Some(first as usize - 1));
    assert!(!strip[..first as usize].contains('i'), "{strip}");
    // Before the first wrong step both motions are the same.
    let before = (evidence.layout.end_record(first - 1) as usize + 1) * 4 * evidence.layout.particles;
    assert_eq!(evidence.reference.values[..before], evidence.submission.values[..before]);
    let close = evidence.inspected.iter().find(|up| up.step == first).expect("looked at");
    let expected = close.expected_end.as_ref().expect("a result");
    let end = evidence.layout.end_record(first) as usize * 4 * evidence.layout.particles;
    let ours = &evidence.submission.values[end..end + expected.positions.len()];
    assert_ne!(expected.positions, ours);
    assert!(evidence.steps[first as usize - 1].position > 1e-10);
}

/// A wrong polynomial has its detection call, with the polynomials of both the trace and the reference.
#[test]
fn a_finding_about_a_polynomial_has_its_call() {
    let scene = asset("ContinuousTimeTests/spinning-edge-sweeps-balls.xml");
    let (outcome, evidence) = judged(&scene, &of_mistake(&scene, "pe-linear-one-ab"));
    let first = outcome.findings_by(Book::Fair).first_divergence.expect("wrong");
    let fosssim_judge::FindingDetail::Coefficient { place, .. } = &first.detail else { panic!("{first}") };
    let close = evidence.inspected.iter().find(|up| up.step == first.step).expect("looked at");
    let call = close.calls.iter().find(|call| call.pair == place.pair && call.pass == place.pass).expect("the call");
    let study = call.study.as_ref().expect("an answer");
    let number = study.curves.iter().position(|curve| curve.role == place.role).expect("the role");
    let CallLog::Polynomials(logged) = &call.logged else { panic!("{call:?}") };
    assert_ne!(study.curves[number].logged.coefficients(), &logged[number][..]);
    assert!(close.passes[0].differing_pairs.contains(&place.pair));
}

/// A long motion is shown around its first wrong step, and every displayed record is exact.
#[test]
fn a_motion_beyond_the_budget_is_cut_around_the_first_wrong_step() {
    let layout = Layout { particles: 10, has_impulses: true, has_polynomials: true, steps: 1000 };
    let whole = Window::for_focus(500, layout, 80 * 1001);
    assert!(whole.is_whole(1000) && whole.contains(0, false) && !whole.contains(0, true));
    let part = Window::for_focus(500, layout, 80 * 90);
    assert_eq!(part, Window { first: 470, last: 560 });
    assert!(
        part.contains(470, false) && !part.contains(470, true) && part.contains(560, true) && !part.contains(561, true)
    );
    assert_eq!(Window::for_focus(3, layout, 80 * 90), Window { first: 0, last: 90 });
    assert_eq!(Window::for_focus(999, layout, 80 * 90), Window { first: 910, last: 1000 });
    assert_eq!(Window::for_focus(7, layout, 1).last - Window::for_focus(7, layout, 1).first, 1);
}

#[test]
fn a_cut_trace_shows_what_is_there() {
    let scene = asset("ContinuousTimeTests/head-on-equal-masses.xml");
    let trace = student::record_trace(&scene, Student::new(None)).expect("a trace");
    let (_, evidence) = judged(&scene, &trace[..trace.len() / 2]);
    assert!(evidence.submission.records < evidence.reference.records);
    assert!(evidence.steps.len() < evidence.layout.steps as usize);
    let (_, nothing) = judged(&scene, &[]);
    assert_eq!((nothing.submission.records, nothing.steps.len()), (0, 0));
}

/// The second part of a hybrid step starts from the trace's own mid record, and may be right if the mid record is
/// wrong.
#[test]
fn a_hybrid_step_whose_impulses_are_wrong_has_a_residual() {
    let scene = asset("ImpulsesTests/off-centre-on-turning-edge.xml");
    let (outcome, evidence) = judged(&scene, &of_mistake(&scene, "decision-alpha-margin"));
    let first = outcome.findings_by(Book::Fair).first_divergence.expect("wrong");
    let step = &evidence.steps[first.step as usize - 1];
    assert!(step.class == StepClass::Wrong && step.position > 0.1 && step.velocity > 0.1, "{step:?}");
    assert!(evidence.steps.iter().filter(|other| other.class != StepClass::Wrong).all(|other| other.position < 1e-10));
}

/// If there are too few or too many polynomials, the report names the pairs to which they belong.
#[test]
fn missing_and_repeated_pairs_are_reported() {
    let scene = asset("ContinuousTimeTests/spinning-edge-sweeps-balls.xml");
    let close = |id: &str| judged(&scene, &of_mistake(&scene, id)).1.inspected.remove(0);
    let right = close("pe-linear-one-ab").passes.remove(0);
    assert!(right.missing_pairs.is_empty() && right.repeated_pairs.is_empty() && !right.differing_pairs.is_empty());
    let pruned = close("pairs-pruned");
    let pass = &pruned.passes[0];
    assert!(pass.is_logged && pruned.surplus_polynomials == Some(0));
    assert!(pass.differing_pairs.is_empty() && pass.repeated_pairs.is_empty(), "{pass:?}");
    let polynomials = |pair: &Pair| if pair.kind == PairKind::ParticleEdge { 4 } else { 2 };
    let missing: usize = pass.missing_pairs.iter().map(polynomials).sum();
    assert_eq!(missing, pruned.expected_polynomials - pruned.actual_polynomials);
    // One of them is in the evidence, although no finding names it.
    assert!(pruned.calls.iter().any(|call| call.logged == CallLog::Nothing && pass.missing_pairs.contains(&call.pair)));
    let twice = close("pairs-both-orders");
    let pass = &twice.passes[0];
    assert!(pass.differing_pairs.is_empty() && pass.missing_pairs.is_empty(), "{pass:?}");
    let particles = scene.particles.len();
    assert_eq!(pass.repeated_pairs.len(), particles * (particles - 1) / 2, "{pass:?}");
    assert_eq!(twice.surplus_polynomials, Some(twice.actual_polynomials - twice.expected_polynomials));
}

/// A pair is also shown from the trace's own mid record.
#[test]
fn a_pair_is_shown_in_every_pass_from_the_traces_own_records() {
    let scene = asset("GeometricTests/pair-becomes-rigid.xml");
    let (outcome, evidence) = judged(&scene, &of_mistake(&scene, "failsafe-angular-overwritten"));
    let step = outcome.findings_by(Book::Fair).first_divergence.expect("wrong").step;
    let close = evidence.inspected.iter().find(|up| up.step == step).expect("looked at");
    let state = |record: u64| {
        let size = 4 * scene.particles.len();
        let values = &evidence.submission.values[record as usize * size..][..size];
        let (positions, velocities) = values.split_at(size / 2);
        State { positions: positions.to_vec(), velocities: velocities.to_vec() }
    };
    let (before, mid) = (state(evidence.layout.end_record(step - 1)), state(evidence.layout.end_record(step) - 1));
    let pair = close.passes[0].hits[0].pair;
    let seen = inspect(&scene, step, &before, Some((&mid, &PolynomialLog::default())), pair);
    assert_eq!(seen.step.calls.len(), close.expected_passes);
    assert!(seen.step.calls.iter().all(|call| call.pair == pair && call.logged == CallLog::Nothing));
    assert_eq!((Some(&seen.end), seen.error), (close.expected_end.as_ref(), None));
}
