//! Finds the states of a trace that have no meaningful continuation, by comparison with the reference's own run.
//!
//! Steps are judged from the trace's own states. A single wrong step can therefore lead to a state in which no mistake
//! can show. Numbers of such a state are not finite, are so large that everything else is round-off, or are all equal.
//! Such steps are never right, unless the reference itself reaches such a state from the scene's start.
use super::{
    context::{Context, Records},
    ordinary_range::OrdinaryRange,
    step::judge_records,
    step_judgment::StepJudgment,
};
use crate::finding::FindingDetail;
use fosssim_model::{
    scene::Scene,
    sim::{RootSearch, Simulation},
};
use fosssim_num::vector::vector_at;

/// Compares states with the reference's own run, which is simulated only up to the needed step, and not at all for
/// ordinary states.
#[derive(Debug)]
pub(crate) struct ExtraordinarySteps<'a> {
    scene: &'a Scene,
    range: OrdinaryRange,
    run: Option<ReferenceRun>,
    /// The simulation for judging steps that are extraordinary in the reference's own run, too.
    second_simulation: Option<Simulation>,
}

/// The reference's own run so far.
#[derive(Debug)]
struct ReferenceRun {
    simulation: Simulation,
    steps: u32,
    /// Whether the run has reached a state that is not finite, or an error.
    is_lost: bool,
}

impl<'a> ExtraordinarySteps<'a> {
    /// Creates the comparison for traces of a scene.
    pub fn new(scene: &'a Scene) -> Self {
        Self { scene, range: OrdinaryRange::for_scene(scene), run: None, second_simulation: None }
    }

    /// Judges a step with an extraordinary state. `known_judgment` is the judgment of a step that starts from
    /// ordinary states. A step that starts from an extraordinary state is judged only if the reference reaches such
    /// states too. Steps must be passed in order. Also returns the work. The simulation stops soon after it exceeds
    /// `max_work`.
    pub fn judge(
        &mut self,
        context: &Context<'_>,
        records: Records<'_>,
        identical: bool,
        known_judgment: Option<StepJudgment>,
        max_work: u64,
    ) -> (StepJudgment, u64) {
        self.run_to(records.step);
        let is_lost = self.run.as_ref().is_some_and(|run| run.is_lost);
        let found = (!is_lost).then(|| self.find_unreachable(&records)).flatten();
        match (known_judgment, found) {
            (Some(step_judgment), Some(detail)) if step_judgment.total() == 0 => {
                (step_judgment.with_finding(records, detail), 0)
            }
            (Some(step_judgment), _) => (step_judgment, 0),
            (None, Some(detail)) => (StepJudgment::default().with_finding(records, detail), 0),
            (None, None) => {
                let simulation =
                    self.second_simulation.get_or_insert_with(|| Simulation::new(self.scene, RootSearch::OnDemand));
                let begin = simulation.work();
                simulation.limit_work(begin.saturating_add(max_work));
                let step_judgment = judge_records(context, simulation, records, identical);
                (step_judgment, simulation.work() - begin)
            }
        }
    }

    /// Returns whether the reference's own run has a result for `step`.
    pub fn advance_to(&mut self, step: u32) -> bool {
        self.run_to(step);
        self.run.as_ref().is_some_and(|run| !run.is_lost)
    }

    /// Returns the finding about the first state that the reference never approaches, if there is one.
    fn find_unreachable(&self, records: &Records<'_>) -> Option<FindingDetail> {
        records.states().find_map(|state| {
            let particle = self.range.find_outside(state)?;
            let (position, velocity) = (vector_at(&state.positions, particle), vector_at(&state.velocities, particle));
            Some(FindingDetail::BeyondReach { particle, position: position.into(), velocity: velocity.into() })
        })
    }

    /// Simulates the reference's own run up to the end of a step.
    fn run_to(&mut self, step: u32) {
        let run = self.run.get_or_insert_with(|| ReferenceRun {
            simulation: Simulation::new(self.scene, RootSearch::OnDemand),
            steps: 0,
            is_lost: false,
        });
        while run.steps < step && !run.is_lost {
            run.steps += 1;
            let has_result = run.simulation.step(&mut ()).is_ok();
            run.is_lost = !has_result || !run.simulation.state().is_finite();
            self.range.widen(run.simulation.state());
        }
    }
}
