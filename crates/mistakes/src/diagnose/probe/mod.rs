//! Probe scenes: small scenes that make every part of a program's work visible.
//!
//! Ordinary scenes hide mistakes: edges stand still, normals have length 1, nothing touches at the very end of a step.
//! When the program itself is at hand it can be run on these instead. Each is about one part of the assignment; groups
//! of bodies that have nothing to do with one another stand far apart in one scene, so that few runs show much.
//!
//! Particles are given by where they start and how far they go in a step, both integers or small dyadic fractions, and
//! the step is half a second, in the large ones a quarter. So the first step's polynomials have coefficients that can be checked by hand; in the
//! `drift` scenes those of every step have, because particles that are fixed and move are never pushed from their way
//! (simulation.md 1).
//!
//! This module runs nothing and never judges. The scenes are the same every time.
mod large;
mod narrow;
mod pairs;
mod rounds;

use fosssim_model::scene::{Collision, Display, Edge, HalfPlane, Integrator, Particle, Scene};
use fosssim_num::vector::Vec2;

/// Step size of the probe scenes, in seconds.
const TIME_STEP: f64 = 0.5;

/// The probe scenes, each with a name that can be a file's: polynomials first, then contacts and responses, the impulse
/// rounds, zones. Every scene is sound for [`scene::read`](fosssim_model::scene::read) and for the original's reader, and reads
/// back unchanged.
#[must_use]
pub fn probe_scenes() -> Vec<(String, Scene)> {
    [
        ("drift-of-particles", pairs::drift_of_particles()),
        ("drift-of-edges", pairs::drift_of_edges()),
        ("slanted-half-planes", pairs::slanted_half_planes()),
        ("particles-meet", pairs::particles_meet()),
        ("edges-struck", pairs::edges_struck()),
        ("struck-while-falling", pairs::struck_while_falling()),
        ("ends-of-edges", pairs::ends_of_edges()),
        ("contact-at-start-and-end", pairs::contact_at_start_and_end()),
        ("just-after-the-end", narrow::just_after_the_end()),
        ("barely-closing", narrow::barely_closing()),
        ("rounds-enough", rounds::impulse_rounds(5)),
        ("rounds-exactly-enough", rounds::rounds_exactly_enough()),
        ("rounds-run-out", rounds::rounds_run_out()),
        ("one-round-only", rounds::impulse_rounds(1)),
        ("zones-of-all-kinds", rounds::zones_of_all_kinds()),
        ("zones-that-grow", rounds::zones_that_grow()),
        ("zones-reach-a-half-plane", rounds::zones_reach_a_half_plane()),
        ("zones-of-fractional-masses", rounds::zones_of_fractional_masses()),
        ("zones-collect-rows", in_quarter_seconds(large::rows_collected())),
        ("zones-turn-little-and-far", in_quarter_seconds(large::small_and_large_turns())),
    ]
    .map(|(name, scene)| (name.to_owned(), scene))
    .into()
}

/// Continuous-time handling that loses half of the normal velocity.
const PLASTIC: Collision = Collision::ContinuousTime { restitution: 0.5 };

/// Hybrid handling without a penalty force.
const fn hybrid(max_iterations: i32) -> Collision {
    Collision::Hybrid { restitution: 0.5, max_iterations, stiffness: 0.0, thickness: 0.0 }
}

/// A free particle at `(x, y)` that goes `(dx, dy)` in the first step.
fn ball(x: f64, y: f64, dx: f64, dy: f64, mass: f64, radius: f64) -> Particle {
    Particle {
        position: Vec2::new(x, y),
        velocity: Vec2::new(dx / TIME_STEP, dy / TIME_STEP),
        mass,
        fixed: false,
        radius,
        tag: None,
    }
}

/// The same, fixed: it goes on evenly for ever unless a half-plane or a zone stops it.
fn post(x: f64, y: f64, dx: f64, dy: f64, mass: f64, radius: f64) -> Particle {
    Particle { fixed: true, ..ball(x, y, dx, dy, mass, radius) }
}

/// An edge between two particles; `radius` is half of its thickness.
const fn edge(first: usize, second: usize, radius: f64) -> Edge {
    Edge { first, second, radius }
}

/// A half-plane through `(x, y)` with a normal of any length.
fn half_plane(x: f64, y: f64, nx: f64, ny: f64) -> HalfPlane {
    HalfPlane { point: Vec2::new(x, y), normal: Vec2::new(nx, ny) }
}

/// A scene without forces, edges and half-planes: its particles go where they are sent.
fn scene(steps: u32, collision: Collision, particles: Vec<Particle>) -> Scene {
    Scene {
        duration: f64::from(steps) * TIME_STEP,
        time_step: TIME_STEP,
        integrator: Integrator::ExplicitEuler,
        collision,
        particles,
        edges: Vec::new(),
        half_planes: Vec::new(),
        forces: Vec::new(),
        description: None,
        display: Display::default(),
    }
}

/// The same motion per step in steps of a quarter of a second: what takes the step size for a number of its own shows.
fn in_quarter_seconds(scene: Scene) -> Scene {
    let particles = scene.particles.into_iter().map(|mut particle| {
        particle.velocity *= 2.0;
        particle
    });
    Scene { duration: scene.duration / 2.0, time_step: TIME_STEP / 2.0, particles: particles.collect(), ..scene }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::student::{self, Area, CATALOGUE, KNOWN_REFUSED, Kind, Mistake, Row, Student};
    use fosssim_judge::{
        self as judging,
        fair::{Judgement, Verdict},
        parity::{Options, judge},
    };
    use fosssim_model::{
        scene::{original, read, write},
        sim::{ByKind, Decision, Detection, Observer, PairKind, RootSearch, Simulation},
    };

    #[test]
    fn both_readers_give_the_scenes_back() {
        let scenes = probe_scenes();
        assert!(scenes.len() >= 12);
        for (name, scene) in &scenes {
            let text = write(scene);
            let strict = read(name, text.as_bytes()).unwrap_or_else(|problems| panic!("{name}: {problems:?}"));
            assert_eq!(strict.scene, *scene, "{name}");
            let lenient = original::read(text.as_bytes()).unwrap_or_else(|refusal| panic!("{name}: {refusal}"));
            assert_eq!(lenient.scene, *scene, "{name}");
        }
    }

    /// What the detections of a kind showed.
    #[derive(Default)]
    struct Seen {
        /// Per kind and polynomial the greatest modulus per coefficient, from the lowest power.
        greatest: ByKind<[[f64; 6]; PairKind::MOST_POLYNOMIALS]>,
        /// Hits per kind.
        hits: ByKind<usize>,
        /// A coefficient that is no integer, or too great to be exact.
        inexact: Option<f64>,
    }

    impl Observer for Seen {
        fn detection(&mut self, detection: &Detection<'_>) {
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
        let mut simulation = Simulation::new(scene, RootSearch::WhereNeeded);
        for _ in 0..scene.steps() {
            simulation.step(&mut seen).expect("an ordinary step");
        }
        seen
    }

    fn probe(name: &str) -> Scene {
        probe_scenes().into_iter().find(|(other, _)| other == name).expect("a probe scene").1
    }

    #[test]
    fn drifting_bodies_show_every_coefficient_in_integers() {
        for (name, kind) in
            [("drift-of-particles", PairKind::ParticleParticle), ("drift-of-edges", PairKind::ParticleEdge)]
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

    /// What a student's program writes; none where it would never end.
    fn trace(scene: &Scene, row: Option<&Row>) -> Option<Vec<u8>> {
        student::trace(scene, Student::new(row.map(|row| row.mistake))).ok()
    }

    fn judged(scene: &Scene, trace: &[u8]) -> Judgement {
        let options = Options { threads: 1, fair: true, ..Options::default() };
        *judge(scene, trace, &options, &mut ()).fair.expect("the fair rules were asked")
    }

    fn is_accepted(scene: &Scene, trace: &[u8]) -> bool {
        judged(scene, trace).verdict == Verdict::Accepted
    }

    /// Whether nothing is found but decisions that hang on coefficients which the course's library dropped.
    fn loses(scene: &Scene, trace: &[u8]) -> bool {
        let counts = judged(scene, trace).counts;
        counts.total() > 0 && counts.get(judging::Kind::TrimmedDecision) == counts.total()
    }

    /// Mistakes that show in the last bits only, which the fair rules rightly pass over: at the time of impact alpha is in [0, 1]
    /// but for round-off, unless the root finder dropped a coefficient.
    const HARMLESS: [&str; 1] = ["pe-contact-clamped"];

    #[test]
    fn every_mistake_of_the_simulation_is_found_in_a_probe_scene() {
        let scenes: Vec<(String, Scene)> = probe_scenes();
        let missed: Vec<&str> = CATALOGUE
            .iter()
            .filter(|row| row.kind == Kind::Wrong && !matches!(row.area, Area::Trace | Area::Process))
            .filter(|row| {
                // Where the mistake makes the program go on for ever, there is no whole trace to accept.
                scenes.iter().all(|(_, scene)| trace(scene, Some(row)).is_some_and(|trace| is_accepted(scene, &trace)))
            })
            .map(|row| row.id)
            .collect();
        assert_eq!(missed, HARMLESS);
        for row in missed.into_iter().map(student::find) {
            assert!(probe_scenes().iter().any(|(_, scene)| trace(scene, row) != trace(scene, None)));
        }
    }

    /// Nothing in the probe scenes depends on round-off, nor on which correct formula is used; save where the judge is known to be
    /// at fault, and where a small factor makes the course's library drop what a decision hangs on.
    #[test]
    fn correct_programs_are_accepted_in_every_probe_scene() {
        let rows = CATALOGUE.iter().filter(|row| row.kind == Kind::Variant).map(Some);
        let refused: Vec<String> = rows
            .chain([None])
            .flat_map(|row| probe_scenes().into_iter().map(move |(name, scene)| (row, name, scene)))
            .filter(|(row, name, scene)| {
                let is_known = KNOWN_REFUSED.iter().any(|(id, scene)| {
                    row.is_some_and(|row| row.id == *id) && scene.strip_prefix("probe/") == Some(name)
                });
                let is_small = row.is_some_and(|row| row.mistake == Mistake::ScaleMillionth);
                let trace = trace(scene, *row).expect("it comes to an end");
                (is_accepted(scene, &trace) || is_small && loses(scene, &trace)) == is_known
            })
            .map(|(row, name, _)| format!("{:?} on {name}", row.map(|row| row.id)))
            .collect();
        assert!(refused.is_empty(), "{refused:?}");
    }
}
