//! The fair rules over every known mistake, every correct variant, and the corpus.
use super::{corpus, judging};
use fosssim_oracle::{
    judge::{
        FindingKind, Overall,
        fair::{FairVerdict, Form, Judgment},
        replay::{Options, judge},
    },
    num::polynomial::Polynomial,
    scene::{self, Scene, original},
    sim::{Pair, PairKind, RootSearch, Simulation, SteeringObserver, StepController},
    student::{self, CATALOG, Row, Student},
    suite::library,
    trace::{Frame, Layout, Reader, Recorder, Writer},
};
use rayon::prelude::*;

/// Scenes that together detect nearly every mistake, so that few others are needed.
const FIRST: [&str; 9] = [
    "ContinuousTimeTests/explicit-euler-under-gravity",
    "GeometricTests/ball-on-a-fixed-edge",
    "GeometricTests/chain-pushed-into-a-half-plane",
    "GeometricTests/tiny-edge-just-missed",
    "HalfPlaneTests/moving-fixed-ball-and-impulses",
    "HalfPlaneTests/touched-exactly-at-step-end",
    "HolisticTests/crowd-of-twenty-balls",
    "HolisticTests/pendulum-into-a-wall-of-balls",
    "IntegratorTests/implicit-euler-then-collisions",
];

/// Returns all built-in scenes by name, beginning with those of [`FIRST`].
pub fn assets() -> Vec<(String, Scene)> {
    let scene = |name: &str| original::read(library::find_scene(name).unwrap()).unwrap().scene;
    let mut scenes: Vec<(String, Scene)> = library::scene_names().map(|name| (name.to_owned(), scene(name))).collect();
    scenes.sort_by_key(|(name, _)| FIRST.iter().position(|first| first == name).unwrap_or(FIRST.len()));
    assert!(FIRST.iter().all(|first| scenes.iter().any(|(name, _)| name == first)));
    scenes
}

pub fn rows(kind: student::RowKind) -> Vec<&'static Row> {
    CATALOG.iter().filter(|row| row.kind == kind).collect()
}

fn judged(scene: &Scene, trace: &[u8], threads: usize) -> (Overall, Judgment) {
    let outcome = judge(scene, trace, &Options { threads, uses_fair_rules: true, ..Options::default() }, &mut ());
    (outcome.parity.overall, *outcome.fair.expect("the fair rules were asked"))
}

pub fn simulated(scene: &Scene, row: Option<&Row>) -> Option<Vec<u8>> {
    student::record_trace(scene, Student::new(row.map(|row| row.mistake))).ok()
}

#[test]
fn no_mistake_passes_the_fair_rules() {
    let scenes = assets();
    let missed: Vec<&str> = rows(student::RowKind::Wrong)
        .into_par_iter()
        .filter(|row| {
            // If the mistake makes the program run forever, there is no complete trace to accept.
            !scenes.iter().any(|(_, scene)| {
                simulated(scene, Some(row))
                    .is_none_or(|trace| judged(scene, &trace, 1).1.verdict == FairVerdict::Rejected)
            })
        })
        .map(|row| row.id)
        .collect();
    assert!(missed.is_empty(), "{missed:?}");
}

/// Variants whose own rounding decides whether bodies touch exactly at the end of a step. In scenes that test exactly
/// this with short numbers, the motion afterwards may differ.
const ROUNDING: [&str; 3] = ["normalized-norm", "through-bernstein", "frame-rotated"];

/// Scale and arithmetic change the logged bits but not the motion, and the fair rules accept them. `scale-1e-6` makes
/// the course's library drop real coefficients. If that changes a decision, the program really moves differently, and
/// the report gives this as the reason.
#[test]
fn every_correct_variant_moves_as_the_correct_sample_and_passes_the_fair_rules() {
    let scenes: Vec<(String, Scene, Vec<f64>)> = assets()
        .into_par_iter()
        .map(|(name, scene)| {
            let states = states(&scene, &simulated(&scene, None).expect("the correct program comes to an end"));
            (name, scene, states)
        })
        .collect();
    let rows = rows(student::RowKind::Variant);
    let cases: Vec<_> = rows.iter().flat_map(|row| scenes.iter().map(move |scene| (row, scene))).collect();
    assert!(cases.len() > 2000);
    let refused: Vec<String> = cases
        .into_par_iter()
        .enumerate()
        .filter_map(|(index, (row, (name, scene, correct)))| {
            let trace = simulated(scene, Some(row)).expect("correct variants come to an end");
            let moved = states(scene, &trace);
            let close = moved.len() == correct.len()
                && moved.iter().zip(correct).all(|(ours, right)| (ours - right).abs() < 1e-9);
            // Beyond the end of a tiny edge, the vector to the end differs by about 1e-9.
            let is_excused = name.contains("tiny-edge") && row.id == "pe-contact-clamped"
                || name.contains("exactly") && ROUNDING.contains(&row.id);
            let fair = judged(scene, &trace, 1).1;
            if index % 4 == 0 {
                judging::compare(&format!("{} on {name}", row.id), scene, &trace);
            }
            let loses = row.id == "scale-1e-6"
                && fair.findings.counts.get(FindingKind::TrimmedDecision) == fair.findings.counts.total();
            let passes = fair.verdict == FairVerdict::Accepted || loses;
            let moves_alike = close || is_excused || row.id == "scale-1e-6";
            let first = fair.findings.first_divergence.map(|first| first.to_string());
            (!passes || !moves_alike).then(|| format!("{} on {name}: {first:?}", row.id))
        })
        .collect();
    assert!(refused.is_empty(), "{refused:#?}");
}

/// Returns only the positions and velocities of a trace.
fn states(scene: &Scene, trace: &[u8]) -> Vec<f64> {
    let mut reader = Reader::from_slice(trace, Layout::for_scene(scene));
    let (mut frame, mut states) = (Frame::default(), Vec::new());
    while reader.next(&mut frame).expect("a whole trace") {
        states.extend_from_slice(&frame.state.positions);
        states.extend_from_slice(&frame.state.velocities);
    }
    states
}

/// Two balls fall side by side. Their relative motion is round-off, which the course's library drops from the
/// assignment's polynomials but keeps in those with a factor. The root finder may then report a collision far from both
/// balls, which is not the program's mistake.
#[test]
fn a_factor_that_keeps_round_off_is_no_mistake() {
    let text = r#"<scene><duration time="0.4"/><integrator type="symplectic-euler" dt="0.02"/>
        <collision type="hybrid" COR="1" maxiters="0" k="0" thickness="0"/>
        <particle m="1" px="0" py="0" vx="0" vy="0" fixed="0" radius="0.3"/>
        <particle m="1" px="9.67" py="11.81" vx="0" vy="0" fixed="0" radius="0.1"/>
        <simplegravity fx="0" fy="-3.7"/></scene>"#;
    let scene = scene::read("scene", text.as_bytes()).expect("a scene").scene;
    let row = student::find("scale-1000");
    let fair = judged(&scene, &simulated(&scene, row).expect("a run"), 1).1;
    assert_eq!(fair.verdict, FairVerdict::Accepted, "{:?}", fair.findings.first_divergence);
    assert!(fair.lost_decisions > 0, "the factor keeps what the reference loses");
}

#[test]
fn the_factor_and_the_form_of_the_polynomials_are_found() {
    let scenes = assets();
    let (_, scene) = scenes.iter().find(|(name, _)| name == "ContinuousTimeTests/spinning-edge-sweeps-balls").unwrap();
    let of = |id: &str| {
        let row = student::find(id).unwrap();
        judged(scene, &simulated(scene, Some(row)).unwrap(), 1).1
    };
    let [low, high] = of("scale-1000").factor.expect("a factor");
    assert!((low - 1000.0).abs() < 1e-6 && (high - 1000.0).abs() < 1e-6, "{low} {high}");
    assert_eq!(of("rearranged-pe").factor, None);
    assert_eq!(of("quintic-right").form, Form::Right);
    assert_eq!(of("scale-3").form, Form::Course);
}

/// A pair of balls falls side by side, so its approach is only round-off. A formula with the displacement of one ball
/// gives another value, which only a program that divides polynomials by their size could log.
#[test]
fn a_wrong_approach_is_reported_if_the_right_one_is_round_off() {
    struct FirstAlone;
    impl StepController for FirstAlone {
        fn adjust_polynomials(&mut self, _: Pair, start: &[f64], end: &[f64], polynomials: &mut [Polynomial]) {
            let [x, y] = [start[0] - start[2], start[1] - start[3]];
            let [dx, dy] = [end[0] - start[0], end[1] - start[1]];
            polynomials[1] = Polynomial::trimmed(&[dx * dx + dy * dy, x * dx + y * dy]);
        }
    }
    let text = r#"<scene><duration time="0.4"/><integrator type="symplectic-euler" dt="0.02"/>
        <collision type="hybrid" COR="1" maxiters="0" k="0" thickness="0"/>
        <particle m="1" px="0.7" py="0.3" vx="0.1" vy="0" fixed="0" radius="0.3"/>
        <particle m="1" px="9.67" py="11.81" vx="0.1" vy="0" fixed="0" radius="0.1"/>
        <simplegravity fx="0" fy="-3.7"/></scene>"#;
    let scene = scene::read("scene", text.as_bytes()).expect("a scene").scene;
    let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
    let mut recorder = Recorder::start(Vec::new(), Layout::for_scene(&scene), simulation.state());
    for _ in 0..scene.step_count() {
        simulation.step(&mut (SteeringObserver(FirstAlone), &mut recorder)).unwrap();
    }
    let fair = judged(&scene, &recorder.finish().unwrap().0, 1).1;
    assert_eq!(fair.findings.wrong_steps, u64::from(scene.step_count()), "{fair:?}");
    let normalized = simulated(&scene, student::find("normalized-norm")).unwrap();
    let fair = judged(&scene, &normalized, 1).1;
    assert_eq!(fair.verdict, FairVerdict::Accepted, "{:?}", fair.findings.first_divergence);
}

/// One polynomial has the right form, and all others have the course's exact bits. Its t^3 coefficient, which the right
/// form does not have, is dropped.
#[test]
fn one_polynomial_with_the_right_form_among_the_courses_is_reported() {
    let scenes = assets();
    let (_, scene) = scenes.iter().find(|(name, _)| name == "ContinuousTimeTests/spinning-edge-sweeps-balls").unwrap();
    let layout = Layout::for_scene(scene);
    let trace = simulated(scene, None).unwrap();
    let mut reader = Reader::from_slice(&trace, layout);
    let mut writer = Writer::new(Vec::new(), layout);
    let (mut frame, mut number) = (Frame::default(), 0);
    while reader.next(&mut frame).unwrap() {
        let log = std::mem::take(&mut frame.polynomials);
        for (index, polynomial) in log.iter().enumerate() {
            let lost = usize::from((number, index) == (17, 15) || (number, index) == (18, 15));
            frame.polynomials.push(&polynomial[lost..]);
        }
        writer.write_frame(&frame);
        number += 1;
    }
    let (_, fair) = judged(scene, &writer.finish().unwrap().0, 1);
    assert_eq!(fair.findings.counts.get(FindingKind::MixedForms), 1, "{fair:?}");
    assert_eq!(fair.findings.counts.total(), 1);
}

/// Polynomials of particles and edges with a small factor, on the course's scenes: dropped coefficients of their
/// approaches say nothing about the form.
#[test]
fn a_small_factor_of_edges_is_no_mistake_on_the_courses_scenes() {
    struct Edges(f64);
    impl StepController for Edges {
        fn adjust_polynomials(&mut self, pair: Pair, _: &[f64], _: &[f64], polynomials: &mut [Polynomial]) {
            for polynomial in polynomials.iter_mut().filter(|_| pair.kind == PairKind::ParticleEdge) {
                let scaled: Vec<f64> = polynomial.coefficients().iter().map(|c| self.0 * c).collect();
                *polynomial = Polynomial::trimmed(&scaled);
            }
        }
    }
    let Some(folder) = corpus::folder() else { return };
    let groups = std::fs::read_dir(folder.join("scenes/t2m2")).unwrap().map(|group| group.unwrap().path());
    let files: Vec<_> = groups
        .flat_map(|group| std::fs::read_dir(group).unwrap().map(|file| file.unwrap().path()).collect::<Vec<_>>())
        .collect();
    files.par_iter().for_each(|file| {
        let scene = original::read(&std::fs::read(file).unwrap()).unwrap().scene;
        for factor in [1e-2, 1e-4] {
            let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
            let mut recorder = Recorder::start(Vec::new(), Layout::for_scene(&scene), simulation.state());
            for _ in 0..scene.step_count() {
                simulation.step(&mut (SteeringObserver(Edges(factor)), &mut recorder)).unwrap();
            }
            let fair = judged(&scene, &recorder.finish().unwrap().0, 1).1;
            let lost = fair.findings.counts.get(FindingKind::TrimmedDecision);
            let first = &fair.findings.first_divergence;
            assert_eq!(fair.findings.counts.total(), lost, "{factor} in {}: {first:?}", file.display());
        }
    });
    corpus::ran("a small factor of edges", files.len());
}

/// The results of the fair rules do not depend on the number of threads.
#[test]
fn threads_change_nothing() {
    for (name, scene) in assets().iter().take(FIRST.len()) {
        for id in ["pe-square-no-eh", "quintic-right", "log-nan-contacts"] {
            let trace = simulated(scene, student::find(id)).unwrap();
            let words = |threads| {
                let (overall, fair) = judged(scene, &trace, threads);
                format!("{overall:?} {fair:?}")
            };
            assert_eq!(words(1), words(3), "{id} on {name}");
        }
    }
}

/// Rows of the corpus that the fair rules accept although their authors meant them to be wrong, with the reasons.
const HARMLESS: [(&str, &str, &str); 3] = [
    ("b26-pe-const-alpha-vel", "ImpulsesTests/test02", "the edge is fixed: the other formula is a positive multiple"),
    ("x-state-neg-zero", "ContinuousTimeTests/test00", "zeros of the other sign are the same numbers"),
    (
        "x-sweep-scale-1e4",
        "ContinuousTimeTests/test00",
        "a positive factor, and nothing was small enough to be dropped",
    ),
];

/// Correct submissions that the fair rules reject, with the reasons.
const REFUSED: [(&str, &str, &str); 1] = [(
    "altroot",
    "ContinuousTimeTests/test06",
    "its own root finder drops leading coefficients of 4e-10, which the course's keeps: they are missing in its log",
)];

#[test]
fn the_corpus_is_judged_fairly() {
    let Some(folder) = corpus::folder() else { return };
    let text = std::fs::read_to_string(folder.join("verdicts.jsonl")).unwrap();
    let rows: Vec<serde_json::Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let wrong: Vec<String> = rows
        .par_iter()
        .filter_map(|row| {
            let text = |key: &str| row[key].as_str().unwrap_or_default();
            let file = row["trace_file"].as_str()?;
            let scene = std::fs::read(folder.join(format!("scenes/{}.xml", text("scene")))).unwrap();
            let scene = original::read(&scene).unwrap().scene;
            let (overall, fair) = judged(&scene, &corpus::unpack(&folder.join(file)), 1);
            let parity = match overall {
                Overall::Passed => "passed",
                Overall::Failed => "failed",
                Overall::None => "none",
            };
            let accepted = fair.verdict == FairVerdict::Accepted;
            let listed = |list: &[(&str, &str, &str)]| {
                list.iter().any(|(id, scene, _)| *id == text("submission") && text("scene").ends_with(scene))
            };
            let is_right =
                row["trace_equals_reference"] == true || text("kind") == "a" && !listed(&REFUSED) || listed(&HARMLESS);
            // The traces of real and hostile submissions may be right; in that case the original accepts them, too.
            let may_be_right = matches!(text("kind"), "real" | "f") && parity == "passed";
            let expected = if may_be_right { accepted } else { is_right };
            let name = format!("{} {}: parity {parity}, {fair:?}", text("submission"), text("scene"));
            (parity != text("overall") || accepted != expected).then_some(name)
        })
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    corpus::ran("the_corpus_is_judged_fairly", rows.len());
}
