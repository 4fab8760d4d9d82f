//! The simulation: a state, and the step that advances it.
use super::{
    bodies::Bodies,
    collision::Handler,
    forces::{Forces, PenaltyPairs},
    integrators::Stepper,
    observer::Observer,
    search::{RootSearch, SearchCounts},
    state::State,
    step_error::StepError,
};
use crate::scene::Scene;

/// The reference simulator of one scene.
#[derive(Debug, Clone)]
pub struct Simulation {
    bodies: Bodies,
    forces: Forces,
    stepper: Stepper,
    handler: Handler,
    q_start: Vec<f64>,
    state: State,
    /// The number of completed steps; the next step is this plus 1.
    steps_done: u32,
    max_work: u64,
}

impl Simulation {
    /// Creates the simulation of a scene at its initial state.
    ///
    /// # Panics
    /// Panics if an edge names a particle that does not exist; the strict reader rejects such scenes.
    pub fn new(scene: &Scene, root_search: RootSearch) -> Self {
        let state = State::for_scene(scene);
        Self {
            bodies: Bodies::new(scene),
            forces: Forces::new(scene),
            stepper: Stepper::new(scene),
            handler: Handler::new(scene, root_search),
            q_start: Vec::with_capacity(state.positions.len()),
            state,
            steps_done: 0,
            max_work: u64::MAX,
        }
    }

    /// Returns the current state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Returns the current state for replacement (by a submission's state, before a step is judged). Both arrays must
    /// keep their length 2N.
    pub fn state_mut(&mut self) -> &mut State {
        &mut self.state
    }

    /// Returns the pairs of the penalty force; `None` if the scene has no penalty force. With contest detection, the
    /// order of the pairs depends on earlier steps.
    pub fn penalty_pairs(&mut self) -> Option<&mut PenaltyPairs> {
        self.forces.pairs()
    }

    /// Sets the number of completed steps, for judging steps out of order.
    pub fn set_steps_done(&mut self, steps: u32) {
        self.steps_done = steps;
    }

    /// Advances the state by one time step and sends `observer` all events (simulation.md 1).
    ///
    /// # Errors
    /// Fails with a [`StepError`] that names the step. The state is unspecified afterwards, and the step does not count
    /// as done.
    ///
    /// # Panics
    /// Panics if the lengths of the state are not 2N, or a force names an object that the scene does not have.
    pub fn step(&mut self, mut observer: &mut dyn Observer) -> Result<(), StepError> {
        // One compiled copy of the step serves all observers: their calls per pair and pass cost less than compiling
        // more copies.
        let observer = &mut observer;
        let step = self.steps_done + 1;
        observer.begin_step(step);
        if self.stepper.is_implicit() && !self.forces.have_hessians() {
            return Err(StepError::VortexHessian { step });
        }
        self.q_start.clone_from(&self.state.positions);
        self.stepper.limit_work(self.max_work.saturating_sub(self.handler.counts().work()));
        self.stepper.advance(step, &self.bodies, &mut self.forces, &mut self.state, observer.as_controller())?;
        self.handler.limit_work(self.max_work.saturating_sub(self.stepper.work()));
        self.handler.handle(&self.bodies, step, &self.q_start, &mut self.state, observer)?;
        self.steps_done = step;
        observer.end_step(step, &self.state);
        Ok(())
    }

    /// Returns the counts of root searches over all steps so far.
    pub fn search_counts(&self) -> SearchCounts {
        self.handler.counts()
    }

    /// Returns the work of all steps so far: detection ([`SearchCounts::work`]) and Newton's method.
    pub fn work(&self) -> u64 {
        self.handler.counts().work() + self.stepper.work()
    }

    /// Computes the following pairs individually, even for observers that only need bytes. The results are the same.
    pub fn disable_lanes(&mut self) {
        self.handler.disable_lanes();
    }

    /// Sets the maximum [`Simulation::work`]. The detection pass or iteration that exceeds it ends its step with
    /// [`StepError::Work`].
    pub fn limit_work(&mut self, max_work: u64) {
        self.max_work = max_work;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        scene::{Collision, CollisionDetection, Force, Integrator, Particle},
        sim::{
            Decision, Detection, ImpactTime, Impulse, Pair, PairKind, Pass, ResumeState, StepController, Zone,
            samples::{edge, fixed_copy, half_plane, particle, scene},
        },
    };
    use fosssim_num::vector::Vec2;

    /// Logs the events that it receives, and may replace the state at the synchronization point.
    #[derive(Default)]
    struct Log {
        lines: Vec<String>,
        polynomials: usize,
        replacement: Option<State>,
    }

    impl Observer for Log {
        fn begin_step(&mut self, step: u32) {
            self.lines.push(format!("step {step}"));
        }
        fn begin_pass(&mut self, pass: Pass) {
            self.lines.push(format!("pass {} {:?}", pass.index, pass.stage));
        }
        fn observe_detection(&mut self, detection: &Detection<'_>) {
            self.polynomials += detection.polynomials.len();
            self.lines.push(match detection.decision {
                Decision::Hit { time, .. } => format!("hit at {time}"),
                Decision::Miss { time: ImpactTime::None } => "no overlap".to_owned(),
                Decision::Miss { .. } => "miss".to_owned(),
            });
        }
        fn end_pass(&mut self, _pass: Pass, hits: usize) {
            self.lines.push(format!("{hits} hits"));
        }
        fn observe_impulse(&mut self, impulse: &Impulse) {
            self.lines.push(format!("impulse {} {}", impulse.normal.x, impulse.normal.y));
        }
        fn as_controller(&mut self) -> Option<&mut dyn StepController> {
            Some(self)
        }
        fn observe_synchronization(&mut self, _state: &State) {
            self.lines.push("synchronize".to_owned());
        }
        fn observe_zones(&mut self, round: u32, zones: &[Zone<'_>]) {
            self.lines.push(format!("zones {round} {:?}", zones.iter().map(|z| z.particles).collect::<Vec<_>>()));
        }
        fn observe_failsafe(&mut self, round: u32, zone: &Zone<'_>) {
            self.lines.push(format!("failsafe {round} {:?}", zone.particles));
        }
        fn end_step(&mut self, step: u32, _state: &State) {
            self.lines.push(format!("end {step}"));
        }
    }

    impl StepController for Log {
        fn choose_resume_state(&mut self, state: &mut State) -> ResumeState {
            if let Some(replacement) = &self.replacement {
                state.clone_from(replacement);
            }
            ResumeState::Own
        }
    }

    /// Returns the scene of trace-format.md 3, in which a particle falls on a half-plane.
    fn falling(collision: Collision) -> Scene {
        let mut scene = scene(vec![particle((0.0, 0.5), (0.0, -1.0), 1.0, 0.25)]);
        scene.half_planes.push(half_plane((0.0, 0.0), (0.0, 1.0)));
        scene.collision = collision;
        scene
    }

    fn hybrid(max_iterations: i32) -> Collision {
        Collision::Hybrid { restitution: 1.0, max_iterations, stiffness: 0.0, thickness: 0.0 }
    }

    fn stepped(scene: &Scene, log: &mut Log) -> Simulation {
        let mut simulation = Simulation::new(scene, RootSearch::default());
        simulation.step(log).expect("an ordinary step");
        simulation
    }

    #[test]
    fn continuous_time_answers_a_hit_at_once() {
        let mut log = Log::default();
        let simulation = stepped(&falling(Collision::ContinuousTime { restitution: 1.0 }), &mut log);
        assert_eq!(simulation.state().positions, [0.0, 1.0]);
        assert_eq!(simulation.state().velocities, [0.0, 1.0]);
        let expected =
            ["step 1", "pass 0 ContinuousTime", "hit at 0.5", "impulse -0 -0.25", "1 hits", "synchronize", "end 1"];
        assert_eq!(log.lines, expected);
        assert_eq!(simulation.steps_done, 1);
    }

    #[test]
    fn passes_over_subnormal_numbers_count_as_long_as_they_take() {
        let pass = |place, speed| {
            let mut scene = falling(Collision::ContinuousTime { restitution: 1.0 });
            scene.particles.push(particle((place, 9.0), (speed, 0.0), 1.0, 0.25));
            let simulation = stepped(&scene, &mut Log::default());
            (simulation.search_counts().calls, simulation.work())
        };
        let (calls, ordinary) = pass(1.0, 0.5);
        assert!(calls > 0 && ordinary < 100 * calls, "{calls} calls, {ordinary} units");
        for (place, speed) in [(1e-155, 0.5), (0.0, -1e-155)] {
            let (same_calls, slow) = pass(place, speed);
            assert_eq!(same_calls, calls);
            assert!(slow >= 32 * calls, "{calls} calls, {slow} units");
        }
        assert_eq!(pass(0.0, 0.5).1, pass(-0.0, 0.5).1, "zeros are no subnormal numbers");
    }

    #[test]
    fn simple_handling_sees_only_the_end_of_the_step() {
        let mut log = Log::default();
        let simulation = stepped(&falling(Collision::Simple { restitution: 1.0 }), &mut log);
        assert_eq!(simulation.state().velocities, [0.0, -1.0], "exactly on the plane the normal is zero");
        assert_eq!(log.lines, ["step 1", "pass 0 Simple", "no overlap", "0 hits", "end 1"]);
    }

    #[test]
    fn hybrid_handling_repeats_until_a_pass_finds_nothing() {
        let mut log = Log::default();
        stepped(&falling(hybrid(10)), &mut log);
        let expected = [
            "step 1",
            "pass 0 Impulses { round: 0 }",
            "hit at 0.5",
            "1 hits",
            "impulse -0 -0.25",
            "pass 1 Impulses { round: 1 }",
            "miss",
            "0 hits",
            "synchronize",
            "end 1",
        ];
        assert_eq!(log.lines, expected);
        assert_eq!(log.polynomials, 4);
    }

    #[test]
    fn without_iterations_hybrid_goes_straight_to_the_zones() {
        let mut log = Log::default();
        let simulation = stepped(&falling(hybrid(-3)), &mut log);
        let expected = [
            "step 1",
            "synchronize",
            "pass 0 Geometric { round: 0 }",
            "hit at 0.5",
            "1 hits",
            "zones 0 [[0]]",
            "failsafe 1 [0]",
            "pass 1 Geometric { round: 1 }",
            "miss",
            "0 hits",
            "zones 1 [[0]]",
            "end 1",
        ];
        assert_eq!(log.lines, expected);
        assert_eq!(simulation.state().positions, [0.0, 0.5], "back where the step began");
    }

    #[test]
    fn the_last_responses_are_not_checked_if_impulses_run_out() {
        let mut log = Log::default();
        stepped(&falling(hybrid(1)), &mut log);
        let passes: Vec<_> = log.lines.iter().filter(|line| line.starts_with("pass")).collect();
        assert_eq!(
            passes,
            ["pass 0 Impulses { round: 0 }", "pass 1 Geometric { round: 0 }", "pass 2 Geometric { round: 1 }"]
        );
    }

    /// The step ends with the state that the observer writes at the synchronization point, except for the geometric
    /// part.
    #[test]
    fn the_synchronised_state_counts_unless_zones_are_moved() {
        let replacement = State { positions: vec![7.0, 8.0], velocities: vec![9.0, 10.0] };
        for (collision, kept) in
            [(Collision::ContinuousTime { restitution: 1.0 }, true), (hybrid(10), true), (hybrid(0), false)]
        {
            let mut log = Log { replacement: Some(replacement.clone()), ..Log::default() };
            let simulation = stepped(&falling(collision), &mut log);
            assert_eq!(*simulation.state() == replacement, kept, "{collision:?}");
        }
    }

    #[test]
    fn without_handling_no_pair_is_tested() {
        let penalty = Collision::Penalty { stiffness: 1.0, thickness: 0.1, detection: CollisionDetection::AllPairs };
        for collision in [Collision::None, penalty] {
            let mut log = Log::default();
            let simulation = stepped(&falling(collision), &mut log);
            assert_eq!(log.lines, ["step 1", "end 1"]);
            assert_eq!(simulation.search_counts(), SearchCounts::default());
        }
    }

    #[test]
    fn two_fixed_particles_are_tested_too() {
        let mut scene = scene(vec![
            fixed_copy(particle((0.0, 0.0), (0.0, 0.0), 1.0, 0.1)),
            fixed_copy(particle((1.0, 0.0), (0.0, 0.0), 1.0, 0.1)),
        ]);
        scene.collision = Collision::ContinuousTime { restitution: 1.0 };
        let mut log = Log::default();
        stepped(&scene, &mut log);
        assert!(log.lines.contains(&"miss".to_owned()));
    }

    /// Both hits of one particle are in the same pass: the second is computed from the position after the first
    /// response.
    #[test]
    fn later_pairs_of_a_pass_see_earlier_responses() {
        let mut scene = scene(vec![
            particle((0.0, 0.0), (2.0, 0.0), 1.0, 0.1),
            fixed_copy(particle((0.5, 0.0), (0.0, 0.0), 1.0, 0.1)),
            fixed_copy(particle((0.75, 0.0), (0.0, 0.0), 1.0, 0.1)),
        ]);
        scene.collision = Collision::ContinuousTime { restitution: 0.0 };
        let mut log = Log::default();
        let simulation = stepped(&scene, &mut log);
        // Restitution 0 removes the whole displacement, so the third particle is no longer reached.
        assert_eq!(simulation.state().positions[..2], [0.0, 0.0]);
        assert_eq!(log.lines.iter().filter(|line| line.starts_with("hit")).count(), 1);
    }

    /// The root search of degree three or more would never end; without edges, particles simply never meet.
    #[test]
    fn a_position_that_is_no_number_is_an_error_where_an_edge_meets_it() {
        let places = [(0.0, 1.0), (-1.0, 0.0), (1.0, 0.0)];
        let mut scene = scene(places.map(|place| particle(place, (0.0, 0.0), 1.0, 0.1)).to_vec());
        scene.collision = Collision::ContinuousTime { restitution: 1.0 };
        for search in [RootSearch::OnDemand, RootSearch::Always, RootSearch::Audit] {
            for (edges, expected) in [
                (vec![], Ok(())),
                (
                    vec![edge(1, 2, 0.1)],
                    Err(StepError::RootSearch {
                        step: 42,
                        pair: Pair { kind: PairKind::ParticleEdge, first: 0, second: 0 },
                    }),
                ),
            ] {
                scene.edges = edges;
                let mut simulation = Simulation::new(&scene, search);
                simulation.set_steps_done(41);
                simulation.state_mut().positions[0] = f64::NAN;
                assert_eq!(simulation.step(&mut ()), expected);
            }
        }
    }

    #[test]
    fn only_implicit_integrators_reject_a_vortex_force() {
        let particles: Vec<Particle> = (0..2).map(|i| particle((f64::from(i), 0.0), (0.0, 0.0), 1.0, 0.1)).collect();
        let mut scene = scene(particles);
        scene.forces.push(Force::Vortex { first: 0, second: 1, strength: 1.0, coupling: 1.0 });
        assert_eq!(Simulation::new(&scene, RootSearch::default()).step(&mut ()), Ok(()));
        for integrator in [Integrator::ImplicitEuler, Integrator::LinearizedImplicitEuler] {
            scene.integrator = integrator;
            let error = Simulation::new(&scene, RootSearch::default()).step(&mut ());
            assert_eq!(error, Err(StepError::VortexHessian { step: 1 }));
        }
    }

    #[test]
    fn gravity_accelerates() {
        let mut scene = scene(vec![particle((0.0, 0.0), (0.0, 0.0), 3.0, 0.1)]);
        scene.forces.push(Force::SimpleGravity { acceleration: Vec2::new(0.0, -10.0) });
        scene.integrator = Integrator::SymplecticEuler;
        let simulation = stepped(&scene, &mut Log::default());
        assert_eq!(simulation.state().velocities, [0.0, -5.0]);
        assert_eq!(simulation.state().positions, [0.0, -2.5]);
    }
}
