//! Inspects one pair in one step from a given state: the reference's computation, and the trace's log.
use crate::inspected_step::{InspectedStep, Inspector, WantedCalls};
use fosssim_model::{
    scene::{Collision, Scene},
    sim::{Pair, RootSearch, Simulation, State, StepError},
    trace::PolynomialLog,
};

/// A pair in a step.
#[derive(Debug, Clone, PartialEq)]
pub struct InspectedPair {
    /// The step, with only the pair's calls, pass by pass.
    pub step: InspectedStep,
    /// The end state of the step.
    pub end: State,
    /// The error, if the step has no result.
    pub error: Option<StepError>,
}

/// Inspects all detection calls of a pair in a step that starts from `before`. The step continues with the trace's
/// `records`, which are the state of its mid record (used in `hybrid`) and the polynomials of its end record. Without
/// records, it continues like the reference.
pub fn inspect(
    scene: &Scene,
    step: u32,
    before: &State,
    records: Option<(&State, &PolynomialLog)>,
    pair: Pair,
) -> InspectedPair {
    let none = PolynomialLog::default();
    let mid = records.map(|(mid, _)| mid).filter(|_| matches!(scene.collision, Collision::Hybrid { .. }));
    let log = records.map_or(&none, |(_, polynomials)| polynomials);
    let wanted_calls = [(WantedCalls::Every, pair)];
    let mut watch = Inspector::new(scene, step, mid, (log, log.len()), &wanted_calls);
    let mut simulation = Simulation::new(scene, RootSearch::OnDemand);
    simulation.state_mut().clone_from(before);
    simulation.set_steps_done(step - 1);
    let failed = simulation.step(&mut watch).err();
    let mut step = watch.finish();
    // The inspector also adds wrong calls of other pairs.
    step.calls.retain(|call| call.pair == pair);
    InspectedPair { step, end: simulation.state().clone(), error: failed }
}
