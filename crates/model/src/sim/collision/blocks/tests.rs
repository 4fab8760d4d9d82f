//! Compares computation in lanes with single pairs.
use crate::{
    scene::{Collision, Scene},
    sim::{
        Impulse, Observer, PolynomialBytes, RootSearch, Simulation, State, WantedPairs,
        samples::{NumberSource, edge, fixed_copy, half_plane, particle, scene},
    },
};

/// Keeps all values that a step logs.
#[derive(Default)]
struct Log {
    polynomials: PolynomialBytes,
    impulses: Vec<Impulse>,
    states: Vec<u64>,
}

impl Observer for Log {
    fn begin_step(&mut self, _step: u32) {
        self.polynomials.clear();
        self.impulses.clear();
        self.states.clear();
    }
    fn wanted_pairs(&mut self) -> WantedPairs<'_> {
        WantedPairs::Bytes(&mut self.polynomials)
    }
    fn observe_impulse(&mut self, impulse: &Impulse) {
        self.impulses.push(*impulse);
    }
    fn observe_synchronization(&mut self, state: &State) {
        self.end_step(0, state);
    }
    fn end_step(&mut self, _step: u32, state: &State) {
        self.states.extend(state.positions.iter().chain(&state.velocities).map(|number| number.to_bits()));
    }
}

/// Simulates a scene both ways and compares all results. Returns the number of pairs.
fn compare(scene: &Scene) -> u64 {
    let [mut lanes, mut single] = [(); 2].map(|()| Simulation::new(scene, RootSearch::OnDemand));
    single.disable_lanes();
    let [mut quick, mut slow] = [(); 2].map(|()| Log::default());
    for _ in 0..scene.step_count() {
        let results = [lanes.step(&mut quick), single.step(&mut slow)];
        assert_eq!(results[0], results[1]);
        assert_eq!(lanes.search_counts(), single.search_counts());
        if results[0].is_err() {
            break;
        }
        assert_eq!(quick.polynomials.count(), slow.polynomials.count());
        assert!(quick.polynomials.bytes() == slow.polynomials.bytes(), "{scene:?}");
        assert!(quick.states == slow.states, "{scene:?}");
        assert_eq!(format!("{:?}", quick.impulses), format!("{:?}", slow.impulses));
    }
    lanes.search_counts().calls
}

/// Returns particles, edges and half-planes; some particles rest, some are fixed and some move together.
fn crowd(numbers: &mut NumberSource, size: f64, collision: Collision) -> Scene {
    let mut drawn = |bound: f64| ((numbers.next() + 1.0) * 0.5 * bound) as usize;
    let count = 1 + drawn(13.0);
    let edges: Vec<_> = (0..drawn(5.0)).map(|_| edge(drawn(count as f64), drawn(count as f64), 0.05 * size)).collect();
    let kinds: Vec<usize> = (0..count).map(|_| drawn(4.0)).collect();
    let planes = drawn(3.0);
    let mut vector = |size: f64| {
        let (x, y) = numbers.next_pair();
        (size * x, size * y)
    };
    let common = vector(size);
    let particles = kinds.iter().map(|kind| match kind {
        0 => fixed_copy(particle(vector(size), (0.0, 0.0), 1.0, 0.1 * size)),
        1 => particle(vector(size), (0.0, 0.0), 1.0, 0.1 * size),
        2 => particle(vector(size), common, 2.0, 0.2 * size),
        _ => particle(vector(size), vector(size), 1.0, 0.1 * size),
    });
    let mut scene = scene(particles.collect());
    scene.edges = edges;
    scene.half_planes = (0..planes).map(|_| half_plane(vector(size), vector(1.0))).collect();
    (scene.collision, scene.duration) = (collision, 2.0);
    scene
}

#[test]
fn lanes_change_no_bit_and_no_count() {
    let mut numbers = NumberSource(11);
    let hybrid =
        |max_iterations| Collision::Hybrid { restitution: 0.5, max_iterations, stiffness: 0.0, thickness: 0.0 };
    let mut pairs = 0;
    for round in 0..400 {
        for collision in [Collision::ContinuousTime { restitution: 0.7 }, hybrid(0), hybrid(3)] {
            let size = [1.0, 1.0, 1e-3, 1e5][round % 4];
            pairs += compare(&crowd(&mut numbers, size, collision));
        }
    }
    assert!(pairs > 100_000, "{pairs}");
}

/// Pairs with numbers that are too large for lanes or not finite are computed one by one. A response may lead to such
/// numbers.
#[test]
fn values_too_large_for_lanes_give_the_same_result() {
    let mut numbers = NumberSource(13);
    for size in [1e47, 1e49, 1e160, f64::NAN] {
        for _ in 0..20 {
            let mut scene = crowd(&mut numbers, 1.0, Collision::ContinuousTime { restitution: 1.0 });
            scene.particles[0].velocity.x = size;
            compare(&scene);
            scene.half_planes.push(half_plane((size, 0.0), (0.0, 1.0)));
            compare(&scene);
        }
    }
}
