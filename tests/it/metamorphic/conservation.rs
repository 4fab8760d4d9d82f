//! The quantities that impulses and the rigid failsafe conserve.
use super::{
    crowd::{TIME_STEP, Wanted, crowd, hybrid, scene},
    search,
};
use fosssim_oracle::{
    num::vector::{Vec2, divide, length, vector_at},
    scene::{Collision, Edge, HalfPlane, Particle, Scene},
    sim::{Detection, Impulse, Observer, Pass, RootSearch, Simulation, Stage, State, Zone},
};
use proptest::prelude::*;
use std::cell::Cell;

/// Returns the sum of mass times vector, and the sum of the absolute values, which determines the rounding errors.
fn weighted(scene: &Scene, vector: impl Fn(usize) -> Vec2) -> (Vec2, f64) {
    let mut sum = (Vec2::zeros(), 0.0);
    for (index, particle) in scene.particles.iter().enumerate() {
        sum.0 += particle.mass * vector(index);
        sum.1 += particle.mass * length(vector(index));
    }
    sum
}

/// The state after the impulses, and the number of impulses.
#[derive(Default)]
struct AfterImpulses {
    state: State,
    impulses: u32,
}

impl Observer for AfterImpulses {
    fn observe_impulse(&mut self, _impulse: &Impulse) {
        self.impulses += 1;
    }
    fn observe_synchronization(&mut self, state: &State) {
        self.state = state.clone();
    }
}

#[test]
fn impulses_conserve_momentum() {
    for collision in [hybrid(0.6, 1), hybrid(1.0, 4), Collision::ContinuousTime { restitution: 0.6 }] {
        let impulses = Cell::new(0);
        search(1500, &crowd(Wanted { collision, fixed: false, half_planes: false, steps: 1 }), |scene| {
            let mut seen = AfterImpulses::default();
            let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
            let before = simulation.state().clone();
            simulation.step(&mut seen).expect("an ordinary step");
            impulses.set(impulses.get() + seen.impulses);
            let (start, old_size) = weighted(&scene, |index| vector_at(&before.velocities, index));
            let (end, size) = weighted(&scene, |index| vector_at(&seen.state.velocities, index));
            let room = 1e-14 * (size + old_size) * f64::from(seen.impulses + 1);
            prop_assert!(length(end - start) <= room, "{start:?} {end:?}");
            // Positions change by the step size times the change of velocity, so the center of mass continues in a
            // straight line.
            let way = |index| vector_at(&seen.state.positions, index) - vector_at(&before.positions, index);
            let (moved, _) = weighted(&scene, way);
            prop_assert!(length(moved - start * TIME_STEP) <= room * 100.0, "{moved:?}");
            Ok(())
        });
        assert!(impulses.get() > 300, "{} impulses", impulses.get());
    }
}

/// Returns scenes with one disc and one other body, which usually meet. Fixed bodies do not move, because they would do
/// work.
fn one_contact() -> impl Strategy<Value = Scene> {
    let place = || (-1.0..1.0, -1.0..1.0);
    let mass = || 0.25..4.0_f64;
    ((place(), place(), place(), place(), place()), (mass(), mass(), mass()), 0.0..=1.0_f64, 0..3, any::<bool>())
        .prop_map(|((one, to, two, three, drift), masses, restitution, kind, fixed)| {
            let body = |(x, y): (f64, f64), velocity: Vec2, mass, fixed, radius| Particle {
                position: Vec2::new(x, y),
                velocity,
                mass,
                fixed,
                radius,
                tag: None,
            };
            let collision = Collision::ContinuousTime { restitution };
            let drift = if fixed { Vec2::zeros() } else { Vec2::new(drift.0, drift.1) };
            let flight = divide(Vec2::new(to.0 - one.0, 6.0 * to.1), TIME_STEP);
            let disc = body((one.0, one.1 + 3.0), flight - Vec2::new(0.0, 6.0 / TIME_STEP), masses.0, false, 0.4);
            match kind {
                0 => scene(1, collision, vec![disc, body(two, drift, masses.1, fixed, 0.5)]),
                1 => {
                    let left = body((two.0 - 3.0, two.1), drift, masses.1, fixed, 0.01);
                    let right = body((three.0 + 3.0, three.1), -drift * 2.0, masses.2, false, 0.01);
                    let edges = vec![Edge { first: 1, second: 2, radius: 0.2 }];
                    Scene { edges, ..scene(1, collision, vec![disc, left, right]) }
                }
                _ => {
                    let plane = HalfPlane { point: Vec2::new(two.0, two.1), normal: Vec2::new(three.0, 1.5 + three.1) };
                    Scene { half_planes: vec![plane], ..scene(1, collision, vec![disc]) }
                }
            }
        })
}

/// Returns the kinetic energy.
fn energy(scene: &Scene, state: &State) -> f64 {
    let energy = |(index, particle): (usize, &Particle)| {
        let v = vector_at(&state.velocities, index);
        0.5 * particle.mass * v.dot(&v)
    };
    scene.particles.iter().enumerate().map(energy).sum()
}

#[test]
fn one_impulse_never_adds_energy() {
    let (hits, kept) = (Cell::new([0; 3]), Cell::new(0));
    search(4000, &one_contact(), |scene| {
        let mut seen = AfterImpulses::default();
        let mut simulation = Simulation::new(&scene, RootSearch::OnDemand);
        let before = energy(&scene, simulation.state());
        simulation.step(&mut seen).expect("an ordinary step");
        if seen.impulses != 1 {
            return Ok(());
        }
        let mut counts = hits.get();
        counts[scene.edges.len() + 2 * scene.half_planes.len()] += 1;
        hits.set(counts);
        let after = energy(&scene, simulation.state());
        prop_assert!(after <= before * (1.0 + 1e-13), "{before} {after}");
        if after < before * 0.99 {
            kept.set(kept.get() + 1);
        }
        Ok(())
    });
    assert!(hits.get().iter().all(|&count| count > 100) && kept.get() > 100, "{hits:?} {kept:?}");
}

/// The positions in each pass of the geometric part, and the zones that moved between them.
#[derive(Default)]
struct Geometric {
    start: Vec<f64>,
    ends: Vec<Vec<f64>>,
    fresh: bool,
    moved: Vec<(usize, Vec<u32>, bool)>,
    zones: Vec<Vec<(Vec<u32>, bool)>>,
}

impl Observer for Geometric {
    fn begin_pass(&mut self, pass: Pass) {
        self.fresh = matches!(pass.stage, Stage::Geometric { .. });
    }
    fn observe_detection(&mut self, detection: &Detection<'_>) {
        if std::mem::take(&mut self.fresh) {
            self.start = detection.q_start.to_vec();
            self.ends.push(detection.q_end.to_vec());
        }
    }
    fn observe_failsafe(&mut self, _round: u32, zone: &Zone<'_>) {
        self.moved.push((self.ends.len(), zone.particles.to_vec(), zone.half_plane));
    }
    fn observe_zones(&mut self, _round: u32, zones: &[Zone<'_>]) {
        self.zones.push(zones.iter().map(|zone| (zone.particles.to_vec(), zone.half_plane)).collect());
    }
}

fn geometric(scene: &Scene) -> Geometric {
    let mut seen = Geometric::default();
    Simulation::new(scene, RootSearch::OnDemand).step(&mut seen).expect("an ordinary step");
    seen
}

fn crowds_without_impulses() -> impl Strategy<Value = Scene> {
    crowd(Wanted { collision: hybrid(1.0, 0), fixed: true, half_planes: true, steps: 1 })
}

#[test]
fn the_failsafe_moves_rigidly_and_conserves_momentum() {
    let (moved, stopped) = (Cell::new(0), Cell::new(0));
    search(2000, &crowds_without_impulses(), |scene| {
        let seen = geometric(&scene);
        for (pass, particles, half_plane) in &seen.moved {
            let (before, after) = (&seen.ends[pass - 1], &seen.ends[*pass]);
            let members = || particles.iter().map(|&particle| particle as usize);
            if *half_plane || members().any(|particle| scene.particles[particle].fixed) {
                stopped.set(stopped.get() + 1);
                for particle in members() {
                    prop_assert_eq!(vector_at(after, particle), vector_at(&seen.start, particle));
                }
                continue;
            }
            moved.set(moved.get() + 1);
            let sum = |end: &[f64]| {
                let way = |particle: usize| {
                    scene.particles[particle].mass * (vector_at(end, particle) - vector_at(&seen.start, particle))
                };
                members().map(way).sum::<Vec2>()
            };
            prop_assert!(
                length(sum(after) - sum(before)) < 1e-13 * f64::from(u32::try_from(particles.len()).unwrap()) * 40.0
            );
            for (one, two) in members().flat_map(|one| members().map(move |two| (one, two))) {
                let distance = |q: &[f64]| length(vector_at(q, one) - vector_at(q, two));
                prop_assert!((distance(after) - distance(&seen.start)).abs() < 1e-14, "{one} {two}");
            }
        }
        Ok(())
    });
    assert!(moved.get() > 200 && stopped.get() > 50, "{moved:?} {stopped:?}");
}

#[test]
fn zones_only_grow_and_at_most_twice_as_often_as_there_are_particles() {
    let most = Cell::new(0);
    search(3000, &crowds_without_impulses(), |scene| {
        let rounds = geometric(&scene).zones;
        // The first list exists before the loop, and the last one equals the one before it.
        let growths = rounds.len() - 2;
        most.set(most.get().max(growths));
        prop_assert!(growths <= 2 * scene.particles.len());
        for (old, new) in rounds.iter().zip(&rounds[1..]) {
            for (particles, flag) in old {
                let holds = |(others, other): &&(Vec<u32>, bool)| {
                    particles.iter().all(|particle| others.contains(particle)) && other >= flag
                };
                prop_assert_eq!(new.iter().filter(holds).count(), 1);
            }
        }
        Ok(())
    });
    assert!(most.get() >= 3, "at most {} growths", most.get());
}
