//! The reference simulator, run from a submission's own states.
use fosssim_judge::budget::Budget;
use fosssim_model::{
    scene::Scene,
    sim::{Observer, RootSearch, Simulation, State},
};
use std::cell::Cell;

/// The simulator that all parts of an explanation use, within one budget.
pub struct Reference<'a> {
    simulation: Simulation,
    budget: Budget<'a>,
    /// The number of polynomials that programs with mistakes may still compute for this explanation.
    pub trial_work: Cell<u64>,
}

/// The maximum number of polynomials that programs with mistakes may compute for one explanation. Unusual steps of root
/// searches count as well. Explanations of sample programs need up to four million. With a lower limit, combinations of
/// mistakes are no longer found; with a higher limit, a hostile trace takes longer to explain.
const MAX_TRIAL_WORK: u64 = 5_000_000;

impl<'a> Reference<'a> {
    /// Creates the reference for a trace of a scene.
    pub fn new(scene: &'a Scene) -> Self {
        let simulation = Simulation::new(scene, RootSearch::OnDemand);
        Self { simulation, budget: Budget::new(scene, false), trial_work: Cell::new(MAX_TRIAL_WORK) }
    }

    /// Returns the end state of a step from `before`, or `None` if it has no result, or the budget is used up.
    pub fn step(&mut self, step: u32, before: &State, observer: &mut dyn Observer) -> Option<&State> {
        self.simulation.state_mut().clone_from(before);
        self.simulation.set_steps_done(step - 1);
        self.budget.step(&mut self.simulation, observer).ok()?;
        Some(self.simulation.state())
    }
}
