//! Checks that a scene has a margin: nothing in its steps depends on round-off.
use fosssim_model::{
    scene::Scene,
    sim::{Detection, Observer, Pair, RootSearch, Simulation},
};

/// The relative and absolute change of positions and velocities that must not matter.
const SHIFT: f64 = 1e-9;
/// The greatest factor by which such a change may grow.
const GROWTH: f64 = 1e4;
/// The number of tries with another change.
const TRIES: u64 = 2;

/// The reference's decision about each pair, in the order of its detections.
type PairDecisions = Vec<(Pair, bool)>;

/// Returns the reference's decisions on a scene; `None` if it has no result, or if other round-off may lead to another
/// result.
pub(crate) fn clear_decisions(scene: &Scene) -> Option<PairDecisions> {
    let (decisions, end) = run(scene)?;
    let is_same = |seed: u64| {
        let (others, other_end) = run(&shift(scene, seed))?;
        let is_near = |(one, other): (&f64, &f64)| (one - other).abs() <= SHIFT * GROWTH * (1.0 + one.abs());
        (others == decisions && end.iter().zip(&other_end).all(is_near)).then_some(())
    };
    (1..=TRIES).try_for_each(is_same)?;
    Some(decisions)
}

/// Runs the reference; returns its decisions and all numbers of its last state.
pub(crate) fn run(scene: &Scene) -> Option<(PairDecisions, Vec<f64>)> {
    let mut heard = DecisionObserver::default();
    let mut simulation = Simulation::new(scene, RootSearch::WhereNeeded);
    for _ in 0..scene.steps() {
        simulation.step(&mut heard).ok()?;
    }
    let state = simulation.state();
    state.is_finite().then(|| (heard.0, [&state.positions[..], &state.velocities].concat()))
}

#[derive(Default)]
struct DecisionObserver(PairDecisions);

impl Observer for DecisionObserver {
    fn detection(&mut self, detection: &Detection<'_>) {
        self.0.push((detection.pair, detection.decision.collides()));
    }
}

/// Returns the scene with each position and velocity changed a little, up or down.
fn shift(scene: &Scene, seed: u64) -> Scene {
    let mut scene = scene.clone();
    let mut bits = seed;
    for particle in &mut scene.particles {
        for value in particle.position.iter_mut().chain(particle.velocity.iter_mut()) {
            bits = next(bits);
            let sign = if bits >> 63 == 0 { SHIFT } else { -SHIFT };
            *value += sign * (1.0 + value.abs());
        }
    }
    scene
}

/// Returns the next of a fixed sequence of numbers that look random (Steele and Vigna's constants).
pub(crate) const fn next(bits: u64) -> u64 {
    let mixed = (bits ^ (bits >> 31)).wrapping_mul(0xd134_2543_de82_ef95).wrapping_add(0x9e37_79b9_7f4a_7c15);
    mixed ^ (mixed >> 29)
}
