//! Follows the order in which the reference checks the bodies of a contest. It depends on all previous steps, so it is
//! followed while steps are read.
use fosssim_model::{
    scene::Scene,
    sim::{RootSearch, Simulation, State, SweepOrder},
};

/// The order of bodies, which is followed from step to step. For scenes that are no contests, it stays empty.
pub(super) struct ContestOrder {
    simulation: Simulation,
    order: SweepOrder,
}

impl ContestOrder {
    /// Creates the order before the first step.
    pub(super) fn new(scene: &Scene) -> Self {
        Self { simulation: Simulation::new(scene, RootSearch::OnDemand), order: SweepOrder::default() }
    }

    /// Runs a step from `before`, with at most `most_work` work. Returns the order with which the reference begins this
    /// step; it is empty outside a contest.
    pub(super) fn follow(&mut self, step: u32, before: &State, most_work: u64) -> &SweepOrder {
        if self.simulation.penalty_pairs().is_some_and(|pairs| pairs.copy_order(&mut self.order)) {
            self.simulation.state_mut().clone_from(before);
            self.simulation.set_steps_done(step - 1);
            self.simulation.limit_work(self.simulation.work().saturating_add(most_work));
            // The error is reported when the step is judged.
            let _ = self.simulation.step(&mut ());
        }
        &self.order
    }
}
