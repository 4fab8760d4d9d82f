//! Finds the detection call that logs each polynomial of a step.
//!
//! A trace does not contain the calls. The step is simulated again from its start state, and the calls are counted.
use crate::{
    scene::Scene,
    sim::{Detection, Observer, Pair, Pass, RootSearch, Simulation, State},
};

/// The origin of a polynomial of a step's end record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PolynomialLabel {
    /// The detection pass of the call.
    pub pass: Pass,
    /// The pair of the call.
    pub pair: Pair,
    /// The number of the polynomial within its call, from 0.
    pub number: usize,
}

/// Returns the labels of the polynomials that the reference logs in the step after `before`, in the order of the trace.
/// A submission's list has the same labels as long as it has the same length. Empty if the step has no result, or if
/// the number of particles in `before` differs from the scene's.
pub fn collect_labels(scene: &Scene, before: &State) -> Vec<PolynomialLabel> {
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    let state = simulation.state_mut();
    if state.positions.len() != before.positions.len() || state.velocities.len() != before.velocities.len() {
        return Vec::new();
    }
    state.clone_from(before);
    let mut labels = LabelCollector(Vec::new());
    match simulation.step(&mut labels) {
        Ok(()) => labels.0,
        Err(_) => Vec::new(),
    }
}

struct LabelCollector(Vec<PolynomialLabel>);

impl Observer for LabelCollector {
    fn observe_detection(&mut self, detection: &Detection<'_>) {
        let &Detection { pass, pair, .. } = detection;
        self.0.extend((0..detection.polynomials.len()).map(|number| PolynomialLabel { pass, pair, number }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{scene::original, sim::PairKind};

    #[test]
    fn each_call_labels_its_polynomials() {
        let xml = br#"<scene><duration time="0.1"/><integrator type="explicit-euler" dt="0.1"/>
            <collision type="continuous-time"/><particle m="1" px="0" py="0" vx="0" vy="0" fixed="0"/>
            <particle m="1" px="5" py="0" vx="0" vy="0" fixed="0"/>
            <particle m="1" px="9" py="0" vx="0" vy="0" fixed="0"/>
            <edge i="0" j="1"/></scene>"#;
        let scene = original::read(xml).unwrap().scene;
        let before = Simulation::new(&scene, RootSearch::OnDemand).state().clone();
        let labels = collect_labels(&scene, &before);
        // There are three pairs of particles with two polynomials each, and one particle near the edge with four.
        assert_eq!(labels.len(), 10);
        let edge: Vec<_> = labels.iter().filter(|label| label.pair.kind == PairKind::ParticleEdge).collect();
        assert_eq!(edge.iter().map(|label| label.number).collect::<Vec<_>>(), [0, 1, 2, 3]);
        assert_eq!(super::collect_labels(&scene, &State::default()), []);
    }
}
