//! The simulation: a state and the step that advances it.
use super::{
    bodies::Bodies,
    collision::Handler,
    forces::Forces,
    integrators::{DoesNotConverge, Stepper},
    observer::{Observer, Pair},
};
use crate::scene::Scene;

/// Positions and velocities in trace order (`x0, y0, x1, y1, ...`), 2N each.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct State {
    /// Positions.
    pub positions: Vec<f64>,
    /// Velocities.
    pub velocities: Vec<f64>,
}

/// Whether a certificate may stand in for a root search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RootSearch {
    /// Search only where no certificate excludes an impact. The traces are the same.
    #[default]
    WhereNeeded,
    /// Always search.
    Always,
    /// Search always, ask the certificate too, and count where they disagree.
    Audit,
}

/// Counts of the root searches so far.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct SearchCounts {
    /// Detection calls.
    pub calls: u64,
    /// Calls whose roots were searched.
    pub searched: u64,
    /// Calls excluded by a certificate.
    pub excluded: u64,
    /// Audit only: a certificate excluded an impact that the root finder found. Must stay zero.
    pub disagreements: u64,
}

/// Why a step has no result. The original hangs or goes on with garbage here.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum StepError {
    /// The root search of a pair would never end: its polynomials hold values that are not finite.
    #[error("step {step}: the root search of this pair does not terminate")]
    RootSearch {
        /// The step, from 1.
        step: u32,
        /// The pair.
        pair: Pair,
    },
    /// Newton's method of implicit-euler does not converge (or cycles).
    #[error("step {step}: Newton's method does not converge")]
    Newton {
        /// The step, from 1.
        step: u32,
    },
    /// A vortex force has no Hessian, which implicit integrators need (scene-format.md 6).
    #[error("step {step}: vortexforce has no Hessian, so it can't be used with an implicit integrator")]
    VortexHessian {
        /// The step, from 1.
        step: u32,
    },
}

/// The reference simulator of one scene.
#[derive(Debug, Clone)]
pub struct Simulation {
    bodies: Bodies,
    forces: Forces,
    stepper: Stepper,
    handler: Handler,
    q_start: Vec<f64>,
    state: State,
    steps_done: u32,
}

impl Simulation {
    /// Sets the scene up at its initial state.
    ///
    /// # Panics
    /// When an edge names a particle that does not exist; the strict reader refuses such scenes.
    #[must_use]
    pub fn new(scene: &Scene, root_search: RootSearch) -> Self {
        let mut state = State::default();
        for particle in &scene.particles {
            state.positions.extend([particle.position.x, particle.position.y]);
            state.velocities.extend([particle.velocity.x, particle.velocity.y]);
        }
        Self {
            bodies: Bodies::new(scene),
            forces: Forces::new(scene),
            stepper: Stepper::new(scene),
            handler: Handler::new(scene, root_search),
            q_start: Vec::with_capacity(state.positions.len()),
            state,
            steps_done: 0,
        }
    }

    /// The current state.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The current state, to be replaced from outside (a submission's own, before a step is judged). Both arrays must
    /// keep their length 2N.
    pub fn state_mut(&mut self) -> &mut State {
        &mut self.state
    }

    /// Number of steps done; the next one is this plus 1.
    #[must_use]
    pub fn steps_done(&self) -> u32 {
        self.steps_done
    }

    /// Declares that `steps` steps lie behind (for judging steps out of order).
    pub fn set_steps_done(&mut self, steps: u32) {
        self.steps_done = steps;
    }

    /// Advances the state by one time step and tells `observer` everything (simulation.md 1).
    ///
    /// # Errors
    /// [`StepError`], naming the step. The state is unspecified afterwards, and the step does not count as done.
    ///
    /// # Panics
    /// When the state has other lengths than 2N, or a force names something that the scene does not have.
    pub fn step<O: Observer>(&mut self, observer: &mut O) -> Result<(), StepError> {
        let step = self.steps_done + 1;
        observer.begin_step(step);
        if self.stepper.is_implicit() && !self.forces.have_hessians() {
            return Err(StepError::VortexHessian { step });
        }
        self.q_start.clone_from(&self.state.positions);
        self.stepper
            .advance(&self.bodies, &self.forces, &mut self.state)
            .map_err(|DoesNotConverge| StepError::Newton { step })?;
        self.handler.handle(&self.bodies, step, &self.q_start, &mut self.state, observer)?;
        self.steps_done = step;
        observer.end_step(step, &self.state);
        Ok(())
    }

    /// Counts of root searches, over all steps so far.
    #[must_use]
    pub fn search_counts(&self) -> SearchCounts {
        self.handler.counts()
    }
}
