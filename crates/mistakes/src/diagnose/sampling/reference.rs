//! The reference, which makes steps from a submission's own states.
use fosssim_judge::budget::Budget;
use fosssim_model::{
    scene::Scene,
    sim::{Observer, RootSearch, Simulation, State, StepError},
};

/// Makes steps for all parts of an explanation, within one budget.
pub struct Reference<'a> {
    simulation: Simulation,
    budget: Budget<'a>,
    given_up: Option<u32>,
}

impl<'a> Reference<'a> {
    /// For a trace of this scene.
    pub fn new(scene: &'a Scene) -> Self {
        let simulation = Simulation::new(scene, RootSearch::WhereNeeded);
        Self { simulation, budget: Budget::new(scene, false), given_up: None }
    }

    /// Where a step from this state ends; `None` where it has no result, or nothing is left of the budget.
    pub fn step(&mut self, step: u32, before: &State, observer: &mut dyn Observer) -> Option<&State> {
        self.simulation.state_mut().clone_from(before);
        self.simulation.set_steps_done(step - 1);
        let result = self.budget.step(&mut self.simulation, observer);
        if matches!(result, Err(StepError::Work { .. })) {
            self.given_up.get_or_insert(step);
        }
        result.is_ok().then(|| self.simulation.state())
    }
}
