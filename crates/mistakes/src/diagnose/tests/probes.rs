//! Each probe scene shows its mistakes, and all probe scenes accept a correct program.
use fosssim_judge::{
    self as judging,
    fair::{FairVerdict, Judgment},
    replay::{Options, judge},
};
use fosssim_model::{
    assignments::Assignment,
    scene::{Scene, original, read, to_xml},
    sim::{Decision, Detection, Observer, PairKind, PairKindMap, RootSearch, Simulation},
};
use fosssim_student::assignments::probe_scenes;
use fosssim_student::{self as student, Area, CATALOG, Mistake, Row, RowKind, Student};

#[test]
fn both_readers_give_the_scenes_back() {
    let scenes = probe_scenes(Assignment::T2M2);
    assert!(scenes.len() >= 12);
    for (name, scene) in &scenes {
        let text = to_xml(scene);
        let strict = read(name, text.as_bytes()).unwrap_or_else(|problems| panic!("{name}: {problems:?}"));
        assert_eq!(strict.scene, *scene, "{name}");
        let lenient = original::read(text.as_bytes()).unwrap_or_else(|refusal| panic!("{name}: {refusal}"));
        assert_eq!(lenient.scene, *scene, "{name}");
    }
}

/// The values that the detections of a scene compute.
#[derive(Default)]
struct Seen {
    /// The largest absolute value of each coefficient, by kind and polynomial, from the lowest power.
    greatest: PairKindMap<[[f64; 6]; PairKind::MAX_POLYNOMIALS]>,
    /// The number of hits per kind.
    hits: PairKindMap<usize>,
    /// A coefficient that is not an integer, or too large to be exact.
    inexact: Option<f64>,
}

impl Observer for Seen {
    fn observe_detection(&mut self, detection: &Detection<'_>) {
        let kind = detection.pair.kind;
        for (polynomial, greatest) in detection.polynomials.iter().zip(&mut self.greatest[kind]) {
            for (coefficient, greatest) in polynomial.coefficients().iter().rev().zip(greatest) {
                *greatest = greatest.max(coefficient.abs());
                if coefficient.fract() != 0.0 || coefficient.abs() > 1e15 {
                    self.inexact = Some(*coefficient);
                }
            }
        }
        self.hits[kind] += usize::from(matches!(detection.decision, Decision::Hit { .. }));
    }
}

fn seen(scene: &Scene) -> Seen {
    let mut seen = Seen::default();
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    for _ in 0..scene.step_count() {
        simulation.step(&mut seen).expect("an ordinary step");
    }
    seen
}

fn probe(name: &str) -> Scene {
    probe_scenes(Assignment::T2M2).into_iter().find(|(other, _)| other == name).expect("a probe scene").1
}

#[test]
fn drifting_bodies_show_every_coefficient_in_integers() {
    for (name, kind) in [("drift-of-particles", PairKind::ParticleParticle), ("drift-of-edges", PairKind::ParticleEdge)]
    {
        let seen = seen(&probe(name));
        assert_eq!(seen.inexact, None, "{name}");
        let degrees: &[usize] = if kind == PairKind::ParticleEdge { &[4, 2, 2, 5] } else { &[2, 1] };
        for (greatest, degree) in seen.greatest[kind].iter().zip(degrees) {
            assert!(greatest[..=*degree].iter().all(|&modulus| modulus > 0.0), "{name}");
        }
        assert!(seen.hits[kind] > 3, "{name}: {:?}", seen.hits);
    }
}

#[test]
fn every_kind_of_pair_collides() {
    for (name, kinds) in [
        ("slanted-half-planes", &[PairKind::ParticleHalfPlane][..]),
        ("particles-meet", &[PairKind::ParticleParticle]),
        ("edges-struck", &[PairKind::ParticleEdge]),
        ("ends-of-edges", &[PairKind::ParticleEdge]),
        ("contact-at-start-and-end", &PairKind::ALL),
    ] {
        let seen = seen(&probe(name));
        assert!(kinds.iter().all(|&kind| seen.hits[kind] >= 2), "{name}: {:?}", seen.hits);
    }
}

/// Returns the trace of a student's program, or `None` if it would never end.
fn trace(scene: &Scene, row: Option<&Row>) -> Option<Vec<u8>> {
    student::record_trace(scene, Student::new(row.map(|row| row.mistake))).ok()
}

fn judged(scene: &Scene, trace: &[u8]) -> Judgment {
    let options = Options { threads: 1, uses_fair_rules: true, ..Options::default() };
    *judge(scene, trace, &options, &mut ()).fair.expect("the fair rules were asked")
}

fn is_accepted(scene: &Scene, trace: &[u8]) -> bool {
    judged(scene, trace).verdict == FairVerdict::Accepted
}

/// Returns whether the only findings are decisions that depend on coefficients which the course's library dropped.
fn loses(scene: &Scene, trace: &[u8]) -> bool {
    let counts = judged(scene, trace).findings.counts;
    counts.total() > 0 && counts.get(judging::FindingKind::TrimmedDecision) == counts.total()
}

#[test]
fn every_mistake_of_the_simulation_is_found_in_a_probe_scene() {
    let scenes: Vec<(String, Scene)> = probe_scenes(Assignment::T2M2);
    let missed: Vec<&str> = CATALOG
        .iter()
        .filter(|row| row.kind == RowKind::Wrong && row.area != Area::Trace)
        .filter(|row| {
            // If the mistake makes the program run forever, there is no complete trace to accept.
            scenes.iter().all(|(_, scene)| trace(scene, Some(row)).is_some_and(|trace| is_accepted(scene, &trace)))
        })
        .map(|row| row.id)
        .collect();
    assert!(missed.is_empty(), "{missed:?}");
}

/// The probe scenes do not depend on round-off or on the choice of correct formula. The exception is a small factor
/// with which the course's library drops coefficients that affect a decision.
#[test]
fn correct_programs_are_accepted_in_every_probe_scene() {
    let rows = CATALOG.iter().filter(|row| row.kind == RowKind::Variant).map(Some);
    let refused: Vec<String> = rows
        .chain([None])
        .flat_map(|row| probe_scenes(Assignment::T2M2).into_iter().map(move |(name, scene)| (row, name, scene)))
        .filter(|(row, _, scene)| {
            let is_small = row.is_some_and(|row| row.mistake == Mistake::ScaleMillionth);
            let trace = trace(scene, *row).expect("it comes to an end");
            !(is_accepted(scene, &trace) || is_small && loses(scene, &trace))
        })
        .map(|(row, name, _)| format!("{:?} on {name}", row.map(|row| row.id)))
        .collect();
    assert!(refused.is_empty(), "{refused:?}");
}
